#pragma once
// Frames of a walk: each is drawn from the points that those before it left, and what they cannot
// answer truthfully is traced.
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/cloud/ageing.h"
#include "core/cloud/audit.h"
#include "core/cloud/resting.h"
#include "core/cloud/reuse.h"
#include "core/cloud/sight.h"
#include "core/math/random.h"
#include "parallel/executor.h"
#include "parallel/stop_flag.h"

namespace lightwalk {

/// Of which pixels a ray verifies what the points say.
enum class CloudCheck {
    none,   ///< of none: only the points' own depths tell what is hidden
    edges,  ///< where new things may come into view
    all,
};

struct CloudOptions {
    bool supersaturated = true;  ///< keep points that a frame does not use
    CloudCheck check = CloudCheck::all;
    ReuseRules rules{};
    int age = 25;            ///< frames that a point outlives without use
    double limit = 4;        ///< most points, as a multiple of the pixels
    double tolerance = 0.2;  ///< how far a view-dependent colour may be off, as a share
    double audit = 0;        ///< share of the reused pixels that are traced all the same
    double audit_limit = 0;  ///< see AuditGuard
    double budget = 0;       ///< of a frame: what does not fit is filled from around; 0: none [s]
    double refine = 0;       ///< share of the pixels that are refined in a frame whose view is
                             ///< that of the frame before
    std::uint64_t seed = 0;  ///< of the audit's choice
};

/// What a frame took.
struct CloudReport {
    std::size_t pixels = 0;  ///< all of the picture
    std::size_t reused = 0;  ///< answered by points, audited and refined ones included
    std::size_t filled = 0;  ///< from their neighbours: there was no time for them
    std::array<std::size_t, kHoleCauses> holes{};  ///< traced pixels, by cause (HoleCause)
    std::size_t points = 0;                        ///< in the cloud after the frame
    double project_seconds = 0, check_seconds = 0, trace_seconds = 0, keep_seconds = 0;
    double tightness = 1;             ///< of reuse (AuditGuard)
    std::vector<float> audit_errors;  ///< of audited pixels: relative error of their luminance
    std::vector<float> audit_floors;  ///< of some of these: difference of two rays of the pixel
};

/// A drawn frame, row by row from the bottom.
struct CloudFrame {
    std::vector<Rgb> radiance;      ///< [W/(m² sr)]
    std::vector<float> distance;    ///< along the pixels' rays; 0 where there is no ray [m]
    std::vector<HoleCause> causes;  ///< why each pixel was traced or filled; none: it was not
    CloudReport report;
    bool complete = false;  ///< false: stopped early
};

/// The cloud and its frames. Without a budget a frame is a function of the views so far: the same
/// bytes with any executor. It knows nothing of scenes: whoever can say what a pixel's ray meets
/// can use it.
class CloudFrames {
  public:
    CloudFrames(int width, int height, const CloudOptions& options);

    /// The next frame. Throws what the caster throws; then, and when stopped, the cloud is as it
    /// was before.
    [[nodiscard]] CloudFrame draw(const Camera& camera, const PixelCaster& caster,
                                  Executor& executor, const StopFlag& stop);

    /// Those that are gone leave their places (PointKind).
    [[nodiscard]] std::span<const CloudPoint> points() const { return points_; }

  private:
    struct Hole;
    struct Step;
    void project(Step& step);
    void answer(Step& step);
    void answer_block(Step& step, std::size_t block, int worker);
    void settle(Step& step, const PixelPlace& place, const PointFinder& finder,
                const PixelAnswer& answer, std::vector<Hole>& holes);
    void order_holes(Step& step);
    void plan_refinement(Step& step);
    void trace(Step& step);
    void trace_all(Step& step, std::span<const Hole> holes, int sample,
                   std::span<TracedPixel> traced, std::span<std::uint8_t> done);
    void show(Step& step);
    void fill(Step& step);
    void refine(Step& step);
    void remember(Step& step);
    [[nodiscard]] AgeCounts age(Step& step);
    void keep(Step& step);
    [[nodiscard]] RandomStream audit_stream(const PixelPlace& place) const;
    [[nodiscard]] std::size_t pixel(const PixelPlace& place) const {
        return static_cast<std::size_t>(place.y) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(place.x);
    }

    int width_, height_;
    CloudOptions options_;
    CloudGrids grids_;
    AuditGuard guard_;
    std::vector<CloudPoint> points_;
    std::vector<ImagePlace> places_;         ///< of the points in this frame
    std::vector<std::uint8_t> used_, kept_;  ///< by point
    std::uint64_t frame_ = 0;
    double last_keep_seconds_ = 0;  ///< of the frame before
    // With `refine`: the last frame.
    std::optional<View> view_;
    RestingPicture resting_;
    std::vector<float> distance_;
};

}  // namespace lightwalk
