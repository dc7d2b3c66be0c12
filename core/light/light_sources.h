#pragma once
// The list of light sources, real and virtual, and the direct calculation.
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/light/light_source.h"
#include "core/light/source_samples.h"
#include "core/scene/scene.h"
#include "core/transport/light_transport.h"
#include "core/transport/options.h"
#include "core/transport/ray.h"

namespace lightwalk {

/// Of more lights than this times the wanted ones some are chosen for the samples of a pixel: with
/// fewer the noise costs more than the shadow rays that are spared.
inline constexpr std::size_t kManyLights = 2;

/// What rays are traced for to know of light sources; each list has one number a source, or none:
/// it was not measured.
struct LightMeasures {
    std::vector<float> hit_rates;  ///< LightSource::hit_rate
    std::vector<float> emissions;  ///< brightness of the radiance, about [W/(m² sr)]
};

class LightSources {
  public:
    /// The real sources. Throws InputError (see collect_sources).
    LightSources(const Scene& scene, const RenderOptions& options, WarningSink& warnings);

    [[nodiscard]] std::span<const LightSource> all() const { return sources_; }
    [[nodiscard]] const LightSource& operator[](std::int32_t i) const {
        return sources_[static_cast<std::size_t>(i)];
    }
    /// The shape of a source's surface; of a virtual source, the redirecting surface's.
    [[nodiscard]] const Shape& shape(std::int32_t source) const {
        return shapes_[static_cast<std::size_t>(source)];
    }
    [[nodiscard]] std::size_t virtual_count() const { return virtual_count_; }
    /// Whether anything in the scene shines on surfaces: a source that is sampled, or, when there
    /// are ambient bounces, a glow. Surfaces inside instances do not count, as in Radiance.
    [[nodiscard]] bool shine() const;
    /// Indices of the sources that the direct calculation samples, ascending.
    [[nodiscard]] std::span<const std::int32_t> sampled() const { return sampled_; }
    /// 0, 1, ... for each of sampled().
    [[nodiscard]] std::span<const std::uint32_t> each() const { return each_; }
    /// The boxes of the sampled sources, in the order of sampled().
    [[nodiscard]] const SourceBoxes& boxes() const { return boxes_; }
    /// Whether there are so many sources that some are chosen for the samples of a pixel. Not
    /// before what each may bring is known.
    [[nodiscard]] bool many_for_samples() const { return many_for_samples_; }

    /// Add a virtual source; sampled() does not hold it before finalize(). While the tracer is set
    /// up only.
    void add(const LightSource& source) {
        sources_.push_back(source);
        shapes_.push_back(scene_.surface(source.object).shape());
    }
    /// The list is complete: find what mists name in it, measure and freeze hit rates (-dt > 0).
    /// Called once by LightTransport's constructor, with that tracer, before any rendering.
    /// @param known  what was measured of the same sources, for a tracer with the same options but
    ///               for those of indirect light: it would come out the same. Null: nothing is
    void finalize(const LightTransport& tracer, WarningSink& warnings,
                  const TaskRunner& task_runner, const LightMeasures* known = nullptr);
    /// What finalize() measured, or knew.
    [[nodiscard]] const LightMeasures& measures() const { return measures_; }

    /// The distant source that a ray leaving the scene sees: its surface, or nothing (black).
    [[nodiscard]] std::optional<SurfaceId> background(const Ray& ray) const;

    /// Nearest hit of an aimed ray with its target's own object; false: it misses.
    [[nodiscard]] bool intersect_target(Ray& ray, const LightTransport& tracer) const;

    /// Whether the source sends light to `origin` from `direction` as far as its spotlight cone or
    /// redirected beam goes.
    [[nodiscard]] bool inside_spot(const LightSource& source, const Vec3& origin,
                                   const Vec3& direction) const;

    /// Add direct light to the values of rays. What one gets does not depend on the others; many
    /// whose points lie near each other are faster together.
    void add_direct(std::span<const DirectRequest> requests, TraceContext& context) const;

    /// In-scattered light of the ray's scatter list along its segment (participating media).
    void add_in_scatter(Ray& ray, TraceContext& context) const;

    /// Index for a source identifier of a mist ("name" or "surface>source"): the last
    /// match; nothing when unknown.
    [[nodiscard]] std::optional<std::int32_t> find(std::string_view identifier) const;
    /// The sources that a mist scatters, as its arguments name them; null when it names none that
    /// exists.
    [[nodiscard]] const ScatterList* scattered_by(ModifierId mist) const;

  private:
    void index_sources();
    void find_scattered(WarningSink& warnings);
    [[nodiscard]] bool answers_to(const LightSource& source, std::string_view identifier) const;

    const Scene& scene_;
    RenderOptions options_;
    std::vector<LightSource> sources_;
    std::vector<Shape> shapes_;  ///< one a source
    std::vector<std::int32_t> sampled_;
    std::vector<std::uint32_t> each_;
    SourceBoxes boxes_;
    std::size_t virtual_count_ = 0;
    bool many_for_samples_ = false;
    LightMeasures measures_;
    std::vector<std::int32_t> distant_;                        ///< real sources at infinity
    std::unordered_map<std::int32_t, ScatterList> scattered_;  ///< by the mist's modifier
};

}  // namespace lightwalk
