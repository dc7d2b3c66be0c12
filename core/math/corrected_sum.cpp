#include "core/math/corrected_sum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace lightwalk {

MeanInterval corrected_sum(std::span<const KnownTerm> terms, RandomStream random,
                           FunctionRef<double(std::size_t term)> sample) {
    double sum = 0, size = 0, weights = 0;
    for (const KnownTerm& term : terms) {
        sum += term.weight * term.value;
        size += std::abs(term.weight * term.value);
        weights += std::abs(term.weight);
    }
    if (!(weights > 0)) return {sum, 0};
    // What is known as dark may be so wrongly, and is chosen, too.
    const double typical = size > 0 ? size / weights : 1;
    std::vector<double> ends;
    ends.reserve(terms.size());
    double end = 0;
    for (const KnownTerm& term : terms)
        ends.push_back(end += std::abs(term.weight) * (std::abs(term.value) + typical));
    std::array<double, kCorrectionRounds> sums;
    for (double& corrected : sums) {
        corrected = sum;
        const double step = end / kCorrectionDraws, offset = random.next();
        for (int k = 0; k < kCorrectionDraws; ++k) {
            const auto found = std::upper_bound(ends.begin(), ends.end(), (k + offset) * step);
            const auto i = static_cast<std::size_t>(std::min(found, ends.end() - 1) - ends.begin());
            const KnownTerm& term = terms[i];
            const double size_of_term = std::abs(term.weight) * (std::abs(term.value) + typical);
            if (size_of_term > 0)
                corrected += term.weight * (sample(i) - term.value) * step / size_of_term;
        }
    }
    return mean_interval(sums);
}

}  // namespace lightwalk
