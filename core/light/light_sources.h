#pragma once
// The list of light sources, real and virtual, and the direct calculation.
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/scene/scene.h"
#include "core/trace/options.h"
#include "core/trace/ray.h"
#include "core/trace/tracer.h"

namespace lightwalk {

/// A spotlight's cone, or the beam of a virtual distant source.
struct SpotShape {
    Vec3 aim;               ///< unit axis of a cone; a point on the axis of a beam
    float size = 0;         ///< solid angle of the cone [sr]; cross-section of a beam [m²]
    float focal_length = 0; ///< distance of the cone's apex behind the source [m]
};

/// One entry of the source list.
struct LightSource {
    SurfaceId object = kNoSurface;   ///< the emitting surface, or the relay surface of a virtual source
    ModifierId material = kVoid;     ///< light, illum, glow or spotlight of the real source
    PrimitiveType material_type = PrimitiveType::light;
    PrimitiveType shape = PrimitiveType::sphere;  ///< of the real source
    Vec3 center;                     ///< or unit direction of a distant source
    Vec3 u, v, w;                    ///< half axes of the sampling box
    Vec3 normal;                     ///< flat sources
    float radius = 0;                ///< effective size
    float size = 0;                  ///< projected area [m²] or solid angle [sr]
    float proximity = 0;             ///< glow: radius of influence [m]
    std::optional<SpotShape> spot;
    bool distant = false, flat = false, round = false, cylinder = false;
    bool is_virtual = false, follow = false;
    bool unusable = false;           ///< visible, but never sampled
    std::int32_t parent = kNoTarget; ///< virtual: what it relays
    int branch = 0;                  ///< virtual: projection of the relay (prism2)
    float hit_rate = 0.5f;           ///< frozen share of shadow tests that get through
};

class LightSources {
  public:
    LightSources(const Scene& scene, const RenderOptions& options, WarningSink& warnings);
    ~LightSources();

    [[nodiscard]] std::span<const LightSource> all() const { return sources_; }
    [[nodiscard]] const LightSource& operator[](std::int32_t i) const { return sources_[static_cast<std::size_t>(i)]; }
    [[nodiscard]] std::size_t virtual_count() const;

    /// Discard virtual sources that never get through (-dp), and measure and freeze hit rates (-dt > 0).
    /// Needs a tracer that uses this list; called once by Tracer's constructor, before any rendering.
    void prepare(const Tracer& tracer, WarningSink& warnings);

    /// The distant source that a ray leaving the scene sees: its surface, or nothing (black).
    [[nodiscard]] std::optional<SurfaceId> background(const Ray& ray) const;

    /// Nearest hit of an aimed ray with its target's own object; false: it misses.
    [[nodiscard]] bool intersect_target(Ray& ray, const Tracer& tracer) const;

    /// Whether source `i` is distant and its direction cone holds `direction`.
    [[nodiscard]] bool inside_spot(const LightSource& source, const Vec3& origin, const Vec3& direction) const;

    /// Add direct light to ray.value (source loop, candidates, shadow tests).
    void add_direct(Ray& ray, DirectCoefficient coefficient, TraceContext& context) const;

    /// In-scattered light of the ray's scatter list along its segment (participating media).
    void add_in_scatter(Ray& ray, TraceContext& context) const;

    /// Index for a mist's source identifier ("name" or "relay>source"); nothing when unknown.
    [[nodiscard]] std::optional<std::int32_t> find(std::string_view identifier) const;

  private:
    const Scene& scene_;
    RenderOptions options_;
    std::vector<LightSource> sources_;
};

}  // namespace lightwalk
