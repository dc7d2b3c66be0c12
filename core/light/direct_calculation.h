#pragma once
// The direct calculation, stage by stage, for one shaded point or many that lie near each other.
// Each stage goes through all points before the next begins; what a point gets is the same as
// alone.
#include <optional>
#include <span>

#include "core/light/light_scratch.h"
#include "core/light/light_sources.h"

namespace lightwalk {

/// Whether a candidate of this brightness adds anything.
[[nodiscard]] bool brings_light(float brightness);

/// One use of the context's LightScratch. Shadow rays may lead to another one inside it.
class DirectCalculation {
  public:
    DirectCalculation(const LightSources& lights, TraceContext& context);
    ~DirectCalculation();
    DirectCalculation(const DirectCalculation&) = delete;
    DirectCalculation& operator=(const DirectCalculation&) = delete;

    /// All stages: adds direct light to the rays of the requests.
    void run(std::span<const DirectRequest> requests);

    // The stages, for a point that is measured:
    /// Find the samples of all sources that can bring light to the points. What patterned sources
    /// bring is found later: by sort() for all, by test() only where they are seen.
    void gather(std::span<const DirectRequest> requests);
    /// Rank the candidates of the points that are adaptive, brightest first; those that bring
    /// nothing go. Fills the remaining sums.
    void sort();
    /// Test the visibility of all candidates from rank `tested` to `block_end`, of all points.
    void test();

    [[nodiscard]] ShadingPoint& point(std::size_t i) { return scratch_.points[i]; }
    [[nodiscard]] const LightCandidate& ranked(const ShadingPoint& point, std::size_t rank) const {
        return scratch_.candidates[scratch_.ranks[point.first + rank]];
    }
    [[nodiscard]] std::span<const float> remaining_sums(const ShadingPoint& point) const;

  private:
    struct Emission {
        Rgb radiance;
        double distance = kHuge;  ///< to the source's surface [m]
    };
    // direct_gather.cpp
    void find_samples(ShadingPoint& point);
    void add_source(ShadingPoint& point, std::size_t k);
    void consider_samples(std::uint32_t point);
    [[nodiscard]] const PolygonShape* polygon_of(std::int32_t source) const;
    void consider(std::uint32_t point, std::int32_t source, const PolygonShape* polygon,
                  const Vec3& direction, const Rgb& k);
    void add_candidate(std::uint32_t point, std::int32_t source, const Vec3& direction,
                       const Rgb& coefficient, const Emission& emitted);
    void add_unknown(std::uint32_t point, std::int32_t source, const Vec3& direction,
                     const Rgb& coefficient, double distance);
    [[nodiscard]] bool meets_redirecting_surface(const LightSource& source, const Vec3& origin,
                                                 const Vec3& direction) const;
    [[nodiscard]] static bool is_constant(const LightSource& source);
    [[nodiscard]] std::optional<double> front_distance(std::int32_t source, const Vec3& origin,
                                                       const Vec3& direction) const;
    [[nodiscard]] static std::optional<double> plane_distance(const PolygonShape& polygon,
                                                              const Vec3& origin,
                                                              const Vec3& direction);

    // direct_choice.cpp
    [[nodiscard]] std::span<const std::uint32_t> choose_sources(ShadingPoint& point);
    void choose_candidates(ShadingPoint& point);
    /// How many lights stand for all; 0: none do.
    [[nodiscard]] std::size_t wanted_lights(const ShadingPoint& point) const {
        const RenderOptions& options = tracer_.options();
        if (point.ray->in(kAmbient)) return static_cast<std::size_t>(options.ambient_lights);
        return lights_.many_for_samples() ? static_cast<std::size_t>(options.sample_lights) : 0;
    }

    // direct_shadows.cpp
    void test_plainly();
    [[nodiscard]] bool mark_needs_shading(LightCandidate& candidate) const;
    void sort_by_source();
    [[nodiscard]] ShadowQuery shadow_query(const LightCandidate& candidate);
    void take(LightCandidate& candidate, Visibility found) const;
    void trace_shadow(LightCandidate& candidate);

    // direct_emission.cpp
    void find_radiances(std::span<const std::uint32_t> candidates, CandidateState state);
    void find_side_by_side(std::span<const std::uint32_t> group, ModifierId patterns);
    void find_radiance(LightCandidate& candidate);
    [[nodiscard]] Rgb emission(const LightCandidate& candidate) const;
    [[nodiscard]] Emission traced_emission(const ShadingPoint& point, std::int32_t source,
                                           const Vec3& direction) const;
    [[nodiscard]] Ray aimed_ray(const ShadingPoint& point, std::int32_t source,
                                const Vec3& direction) const;
    [[nodiscard]] bool meet(const LightCandidate& candidate, Hit& hit) const;
    static void set_radiance(LightCandidate& candidate, const Rgb& radiance);

    // direct.cpp
    void plan(ShadingPoint& point);
    void rank(ShadingPoint& point);
    [[nodiscard]] bool select_tests();
    void sum_tested(ShadingPoint& point);
    void tell_tested(const ShadingPoint& point, ContributionSink& sink) const;
    void add_untested(ShadingPoint& point);
    void tell_guess(const ShadingPoint& point, const LightCandidate& candidate, const Rgb& value,
                    GroupSums& sink) const;
    [[nodiscard]] ModifierId emitter_of(const LightSource& source) const;
    [[nodiscard]] const ShadingPoint& point_of(const LightCandidate& candidate) const {
        return scratch_.points[candidate.point];
    }

    const LightSources& lights_;
    const LightTransport& tracer_;
    TraceContext& context_;
    LightScratch& shared_;
    DirectScratch& scratch_;
};

/// Whether lights of this source have to be followed by a ray, whatever lies between.
[[nodiscard]] inline bool needs_tracing(const LightSource& source, const ShadingPoint& point) {
    return source.follow || point.clipped;
}

}  // namespace lightwalk
