#pragma once
// What a walk tells of the light where somebody points.
#include "core/trace/tracer.h"
#include "core/view/view.h"
#include "io/net/walk_reply.h"
#include "io/net/walk_request.h"
#include "parallel/walk/live_walk.h"

namespace lightwalk {

/// Asks rays of the same light as the pictures.
class WalkAnswers {
  public:
    /// All must outlive this.
    WalkAnswers(const Tracer& tracer, WarningSink& warnings)
        : tracer_(tracer), context_(tracer, warnings) {}

    /// What is seen at a place of a view, and how much light falls on it, from the side that is
    /// seen.
    /// @param pixel  width and height of one, of the picture's [0 ... 1]: the luminance is its mean
    [[nodiscard]] PickedReply pick(const PickRequest& request, const Camera& camera,
                                   const std::pair<double, double>& pixel);
    /// Mean luminance in a rectangle of a picture; pixels that it touches at their middle.
    [[nodiscard]] static MeanReply mean(const MeanRequest& request, const LivePicture& picture);
    /// Light at a pin; its luminance as seen from the eye.
    [[nodiscard]] ProbeValue measure(const ProbePlace& probe, const Vec3& eye);

  private:
    [[nodiscard]] Ray look(const Vec3& origin, const Vec3& direction, double limit, int sample);
    /// [lx]
    [[nodiscard]] double illuminance(const Vec3& point, const Vec3& normal);

    const Tracer& tracer_;
    TraceContext context_;
};

/// Height of the eye above what is below it; nothing where nothing is below [m].
[[nodiscard]] std::optional<double> height_above_ground(const Geometry& geometry, const Vec3& eye,
                                                        const Vec3& up);

}  // namespace lightwalk
