#include "io/picture/human_tone.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/math/xyz.h"

namespace lightwalk {
namespace {

constexpr double kScreenDark = 1, kScreenWhite = 100;  // [cd/m²]
constexpr int kBins = 100;
constexpr double kTolerance = 0.025;  // share of the pixels that may be cut in the last round
const double kScreenRange = std::log(kScreenWhite / kScreenDark);

}  // namespace

double visible_difference(double L) {
    const double a = std::log10(std::max(L, 1e-10));
    double t = 0;
    if (a < -3.94)
        t = -2.86;
    else if (a < -1.44)
        t = std::pow(0.405 * a + 1.6, 2.18) - 2.86;
    else if (a < -0.0184)
        t = a - 0.395;
    else if (a < 1.9)
        t = std::pow(0.249 * a + 0.65, 2.7) - 0.72;
    else
        t = a - 1.255;
    return std::pow(10.0, t);
}

double colour_sensitivity(double L) {
    constexpr double kRods = 0.00562, kCones = 5.62;
    return std::clamp((L - kRods) / (kCones - kRods), 0.0, 1.0);
}

HumanTone::HumanTone(const BrightnessHistogram& histogram) {
    const double average = double{kEfficacy} * histogram.log_average();
    // A difference that is just visible in the scene is just visible at the middle luminance of the
    // screen.
    const double middle = std::sqrt(kScreenDark * kScreenWhite);
    factor_ = average > 0 ? visible_difference(middle) / visible_difference(average) / kScreenWhite
                          : 1 / kScreenWhite;
    const auto counts = histogram.counts();
    std::size_t first = 0, last = counts.size();
    while (first < last && !(counts[first] > 0)) ++first;
    while (last > first && !(counts[last - 1] > 0)) --last;
    if (first == last) return;
    constexpr double kDarkest = 1e-4;  // nobody sees less [cd/m²]
    const double half = 0.5 / BrightnessHistogram::kStepsPerOctave;
    lowest_ = std::log(std::max(
        double{kEfficacy} * BrightnessHistogram::middle(first) * std::exp2(-half), kDarkest));
    highest_ = std::log(std::max(
        double{kEfficacy} * BrightnessHistogram::middle(last - 1) * std::exp2(half), 2 * kDarkest));
    std::vector<double> bins(kBins, 0.0);
    for (std::size_t step = first; step < last; ++step) {
        const double at =
            (std::log(double{kEfficacy} * BrightnessHistogram::middle(step)) - lowest_) /
            (highest_ - lowest_) * kBins;
        bins[static_cast<std::size_t>(std::clamp(at, 0.0, kBins - 1.0))] += counts[step];
    }
    adjust(bins);
    const double total = std::accumulate(bins.begin(), bins.end(), 0.0);
    if (!(total > 0)) return;
    linear_ = false;
    shares_.assign(1, 0.0);
    for (const double bin : bins) shares_.push_back(shares_.back() + bin / total);
}

/// Cut the bins whose contrast on the screen would be larger than a person sees it in the scene,
/// until hardly any is; the paper's fig. 10. What is left may be nothing: then the screen has room
/// for all.
void HumanTone::adjust(std::vector<double>& counts) const {
    const double all = std::accumulate(counts.begin(), counts.end(), 0.0);
    const double step = (highest_ - lowest_) / kBins;
    double cut = all;
    while (cut > kTolerance * all) {
        const double total = std::accumulate(counts.begin(), counts.end(), 0.0);
        if (total < kTolerance * all) {
            counts.assign(counts.size(), 0.0);
            return;
        }
        cut = 0;
        double below = 0;
        for (std::size_t i = 0; i < counts.size(); ++i) {
            const double scene = std::exp(lowest_ + (static_cast<double>(i) + 0.5) * step);
            const double shown =
                kScreenDark * std::exp(kScreenRange * (below + 0.5 * counts[i]) / total);
            below += counts[i];
            const double most = visible_difference(shown) / visible_difference(scene) * total *
                                step * scene / (kScreenRange * shown);
            if (counts[i] <= most) continue;
            cut += counts[i] - most;
            counts[i] = most;
        }
    }
}

double HumanTone::operator()(double L) const {
    if (linear_) return std::clamp(factor_ * L, 0.0, 1.0);
    const double last = static_cast<double>(shares_.size() - 1);
    const double at = std::clamp(
        (std::log(std::max(L, 1e-10)) - lowest_) / (highest_ - lowest_) * last, 0.0, last);
    const auto bin = static_cast<std::size_t>(std::min(at, last - 1));
    const double share =
        shares_[bin] + (at - static_cast<double>(bin)) * (shares_[bin + 1] - shares_[bin]);
    const double shown = kScreenDark * std::exp(kScreenRange * share);
    // The screen's darkest is its black.
    return (shown - kScreenDark) / (kScreenWhite - kScreenDark);
}

}  // namespace lightwalk
