#include "core/cloud/reuse_error_controller.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace lightwalk {
namespace {

// Least numbers of measurements for a decision.
constexpr std::size_t kLeastErrors = 1024, kLeastFloors = 256;
constexpr float kOff = 0.1f;           ///< larger relative errors count as wrong
constexpr double kStandardErrors = 2;  ///< differences within so many standard errors may be chance

// Tightens quickly and loosens slowly, so that the picture does not oscillate between the two.
constexpr double kTighten = 0.5, kLoosen = 1.1, kTightest = 1.0 / 1024;

/// Share of values that are wrong, and the variance of this estimate.
struct OffShare {
    double share = 0, variance = 0;
};
OffShare off_share(std::span<const float> values) {
    const auto count = static_cast<double>(values.size());
    const auto off = std::count_if(values.begin(), values.end(), [](float v) { return v > kOff; });
    const double share = static_cast<double>(off) / count;
    return {share, share * (1 - share) / count};
}

}  // namespace

double quantile(std::vector<float> values, double share) {
    if (values.empty()) return 0;
    const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + at, values.end());
    return static_cast<double>(values[static_cast<std::size_t>(at)]);
}

ReuseRules tightened(ReuseRules rules, double tightness) {
    const auto share = static_cast<float>(tightness);
    const float near = rules.near * std::sqrt(share);  // so that the area is proportional to share
    rules.reach = near + std::max(rules.reach - rules.near, 0.0f) * share;
    rules.near = near;
    rules.contrast *= share;
    rules.tightness *= tightness;
    return rules;
}

void ReuseErrorController::record(std::span<const float> errors, std::span<const float> floors) {
    if (!(limit_ > 0)) return;
    errors_.insert(errors_.end(), errors.begin(), errors.end());
    floors_.insert(floors_.end(), floors.begin(), floors.end());
    if (errors_.size() < kLeastErrors || floors_.size() < kLeastFloors) return;
    const OffShare wrong = off_share(errors_), floor = off_share(floors_);
    const double beyond = wrong.share - floor.share;
    const double chance = kStandardErrors * std::sqrt(wrong.variance + floor.variance);
    if (beyond - chance > limit_)
        tightness_ = std::max(tightness_ * kTighten, kTightest);
    else if (beyond < limit_ / 2)
        tightness_ = std::min(tightness_ * kLoosen, 1.0);
    errors_.clear();
    floors_.clear();
}

}  // namespace lightwalk
