#pragma once
// Feedback control of reuse: pixels that are traced although points answered them measure the error
// of reuse.
#include <span>
#include <vector>

#include "core/cloud/reuse.h"

namespace lightwalk {

/// The quantile of some values: a `share` (0 ... 1) of them lies below it; 0 for no values.
[[nodiscard]] double quantile(std::vector<float> values, double share);

/// Stricter rules: points must lie nearer and agree better, and view directions may differ less.
/// @param tightness  1: unchanged ... 0: hardly anything is reused
[[nodiscard]] ReuseRules tightened(ReuseRules rules, double tightness);

/// Tightens the rules of reuse while the measured error is above a limit, and loosens them slowly
/// when it is below. Deterministic: depends on the recorded errors only, not on time.
class ReuseErrorController {
  public:
    /// @param limit  largest share of audited pixels whose error may exceed a tenth, in addition to
    /// the share of pixels of which two equally good rays differ by as much (the noise, which with
    /// patterns and edges is up to a quarter of a picture). 0: no limit
    explicit ReuseErrorController(double limit) : limit_(limit) {}

    /// Record the measurements of one frame.
    /// @param errors  relative errors of reused pixels
    /// @param floors  relative differences of two equally good rays of a pixel
    void record(std::span<const float> errors, std::span<const float> floors);

    /// The argument for tightened(), 1/1024 ... 1.
    [[nodiscard]] double tightness() const { return tightness_; }

  private:
    double limit_;
    double tightness_ = 1;
    std::vector<float> errors_, floors_;  ///< since the last decision
};

}  // namespace lightwalk
