#include "core/cloud/error_histogram.h"

#include <algorithm>
#include <cmath>

namespace lightwalk {
namespace {

constexpr double kSmallest = 1e-5;      ///< of an error that counts
constexpr double kBinsADecade = 120.0;  ///< each is 1.9 % wide

}  // namespace

void ErrorHistogram::add(std::span<const float> values) {
    for (const float value : values) {
        const auto size = static_cast<double>(value);
        const double bin = size > kSmallest ? 1 + kBinsADecade * std::log10(size / kSmallest) : 0;
        ++bins_[static_cast<std::size_t>(std::min(bin, static_cast<double>(kBins)))];
    }
    count_ += values.size();
}

double ErrorHistogram::quantile(double share) const {
    const double wanted = share * static_cast<double>(count_);
    double below = 0;
    for (std::size_t i = 0; i < bins_.size(); ++i) {
        below += static_cast<double>(bins_[i]);
        if (below < wanted || below == 0) continue;
        return i == 0 ? 0 : kSmallest * std::pow(10, (static_cast<double>(i) - 0.5) / kBinsADecade);
    }
    return 0;
}

}  // namespace lightwalk
