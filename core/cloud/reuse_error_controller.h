#pragma once
// Reuse under audit: pixels that were traced though points answered them tell how true points are.
#include <span>
#include <vector>

#include "core/cloud/reuse.h"

namespace lightwalk {

/// The value that a share (0 ... 1) of the values lies below; 0 where there are none.
[[nodiscard]] double quantile(std::vector<float> values, double share);

/// Rules that are stricter: points must lie nearer, agree better, and views may turn less.
/// @param tightness  1: as they are ... 0: hardly anything is reused
[[nodiscard]] ReuseRules tightened(ReuseRules rules, double tightness);

/// Tightens reuse while it is found wrong, and loosens it again, slowly, when it is right. A
/// function of what it was told: not of time.
class ReuseErrorController {
  public:
    /// @param limit  most audited pixels that may be off by more than a tenth, as a share of them,
    ///               beyond the share of pixels of which two equally good rays differ by as much:
    ///               with patterns and edges that is a quarter of a picture, and its percentiles
    ///               say little. 0: any
    explicit ReuseErrorController(double limit) : limit_(limit) {}

    /// What one frame's audit found.
    /// @param errors  relative errors of reused pixels
    /// @param floors  relative differences of two equally good rays of a pixel
    void record(std::span<const float> errors, std::span<const float> floors);

    /// For tightened(), 1/1024 ... 1.
    [[nodiscard]] double tightness() const { return tightness_; }

  private:
    double limit_;
    double tightness_ = 1;
    std::vector<float> errors_, floors_;  ///< since the last decision
};

}  // namespace lightwalk
