#pragma once
// How long a picture will take, from how it went so far.
#include <cstddef>
#include <optional>
#include <vector>

#include "parallel/cache_prepass.h"
#include "parallel/frame_options.h"
#include "parallel/progress.h"

namespace lightwalk {

/// A part of the making of a picture, as it is planned.
struct WorkPhase {
    enum class Kind {
        prepass,  ///< coarse pictures that fill the ambient cache
        picture,
    };
    Kind kind = Kind::picture;
    double pixels = 0;   ///< that will be reported done
    double rays = 1;     ///< primary ones a pixel, about: samples, or a share of the pixels
    double workers = 1;  ///< that share the work
    /// That it computes, where each pixel has a ray, per value of its prepass; measured as the
    /// constants of the model are.
    double late_values = 2.5;
};

/// The phases of a picture: its prepass, when it has one, and itself.
[[nodiscard]] std::vector<WorkPhase> plan_picture(const FrameOptions& options, CachePrepass prepass,
                                                  int workers);

struct TimeEstimate {
    double done = 0;                     ///< share of the whole time, 0 ... 1; never falls
    std::optional<double> seconds_left;  ///< nothing: not known yet
};

/// A model of what the phases of a picture cost, fitted to what they did cost. A picture costs so
/// much a pixel, throughout: its blocks lie scattered. An prepass's pixels cost less and less,
/// because later ones find ambient values of earlier ones: its work grows as a power of the share
/// done, whose exponent is fitted. What the picture after it will cost is told by the prepass: so
/// many rays a pixel, and so many for each value, of which a share is still to be computed. Pure:
/// it knows no clock.
class TimeEstimator {
  public:
    /// The phases follow each other in this order; at least one.
    explicit TimeEstimator(std::vector<WorkPhase> phases);

    /// Take what a phase reports, `seconds` after the first phase began. Shares and times do not
    /// fall, nor does the phase.
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
    /// Sums over an prepass's reports, to split its rays into those of pixels (p) and values (v).
    double pp_ = 0, pv_ = 0, vv_ = 0, pr_ = 0, vr_ = 0;
    TimeEstimate estimate_;
};

}  // namespace lightwalk
