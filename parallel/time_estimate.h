#pragma once
// Estimate of the remaining time of a picture from its progress so far.
#include <cstddef>
#include <optional>
#include <vector>

#include "parallel/cache_prepass.h"
#include "parallel/frame_options.h"
#include "parallel/progress.h"

namespace lightwalk {

/// A phase of the rendering of a picture, as planned.
struct WorkPhase {
    enum class Kind {
        prepass,  ///< coarse pictures that fill the ambient cache
        picture,
    };
    Kind kind = Kind::picture;
    double pixels = 0;   ///< number of pixels that the phase will report
    double rays = 1;     ///< approximate number of primary rays for each pixel
    double workers = 1;  ///< number of workers that share the work
    /// Number of ambient values that the phase computes for each value of its prepass, if each
    /// pixel has a ray; measured, as are the constants of the model.
    double late_values = 2.5;
};

/// The phases of a picture: its prepass, if any, and the picture itself.
[[nodiscard]] std::vector<WorkPhase> plan_picture(const FrameOptions& options, CachePrepass prepass,
                                                  int workers);

struct TimeEstimate {
    double done = 0;                     ///< share of the whole time, 0 ... 1; never falls
    std::optional<double> seconds_left;  ///< nothing: not known yet
};

/// A cost model of the phases of a picture, fitted to their progress. The pixels of a picture have
/// the same cost throughout, as its blocks are handed out in stride order. Those of a prepass
/// become cheaper, because later ones find ambient values of earlier ones: its work grows as a
/// power of the share done, with a fitted exponent. The cost of the picture that follows is
/// predicted from the prepass: a number of rays for each pixel, and for each ambient value, of
/// which a share remains to be computed. Pure: it reads no clock.
class TimeEstimator {
  public:
    /// The phases follow each other in this order; at least one.
    explicit TimeEstimator(std::vector<WorkPhase> phases);

    /// Record the progress of a phase, `seconds` after the first phase began. Phases, shares and
    /// times must not decrease.
    void add(std::size_t phase, double seconds, const FrameProgress& progress);

    [[nodiscard]] TimeEstimate estimate() const { return estimate_; }

  private:
    struct Point {
        double share = 0, rays = 0;
    };
    void enter(std::size_t phase, double seconds);
    void fit_block(const FrameProgress& now);
    [[nodiscard]] double exponent() const;
    [[nodiscard]] double present_left() const;
    [[nodiscard]] double expected_total(const WorkPhase& phase) const;
    [[nodiscard]] double rays_a_pixel() const;

    std::vector<WorkPhase> phases_;
    std::size_t phase_ = 0;
    double began_ = 0;                ///< the present phase [s]
    double elapsed_ = 0;              ///< in the present phase [s]
    std::optional<double> expected_;  ///< time of the present phase, as it was expected before [s]
    FrameProgress now_;               ///< of the present phase
    std::vector<Point> points_;       ///< of the present phase, ever farther apart
    /// Sums over the reports of a prepass, to split its rays into those of pixels (p) and of values
    /// (v).
    double pp_ = 0, pv_ = 0, vv_ = 0, pr_ = 0, vr_ = 0;
    TimeEstimate estimate_;
};

}  // namespace lightwalk
