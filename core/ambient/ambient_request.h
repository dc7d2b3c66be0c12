#pragma once
// A surface's question for ambient light, and what remains of it at a point that stands alone.
#include <utility>

#include "core/ambient/ambient_point.h"
#include "core/transport/trace_context.h"

namespace lightwalk {

/// What cached values assume of the reflectance that lies between them and the eye.
inline constexpr double kAssumedReflectance = 0.5;

/// One ambient value that a surface asks for.
struct AmbientRequest {
    Ray& ray;
    const Rgb& coef;
    AmbientQuery query;
    bool far_side = false;  ///< not the viewer's
    TraceContext& context;

    [[nodiscard]] RayKind kind() const { return far_side ? kAmbientThrough : kAmbientSame; }
};

/// Random numbers of the hemisphere at a place: they do not depend on who asks first.
[[nodiscard]] RandomStream stream_of(const AmbientQuery& query, std::uint64_t seed);

/// Whether all that its hemisphere's rays inherit fits an AmbientPoint.
[[nodiscard]] bool can_stand_alone(const Ray& ray);

[[nodiscard]] AmbientPoint point_of(const AmbientRequest& request);

/// The ray that asked at a point, as far as its hemisphere's rays inherit from it.
[[nodiscard]] Ray ray_to(const AmbientPoint& point);

/// The level at which a point asks, while this lives.
class AtLevel {
  public:
    AtLevel(TraceContext& context, int level)
        : context_(context), before_(std::exchange(context.path.ambient_level, level)) {}
    ~AtLevel() { context_.path.ambient_level = before_; }
    AtLevel(const AtLevel&) = delete;
    AtLevel& operator=(const AtLevel&) = delete;

  private:
    TraceContext& context_;
    int before_;
};

}  // namespace lightwalk
