#pragma once
// The direct calculation for one shaded point, step by step: gather candidates, order them, test
// them.
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "core/light/light_scratch.h"
#include "core/light/light_sources.h"

namespace lightwalk {

/// What the shadow tests of a point have found so far.
struct ShadowTally {
    double hits = 0;       ///< candidates that got through
    double expected = 0;   ///< sum of their sources' hit rates, tested ones only
    float brightness = 0;  ///< of the point's radiance, growing

    /// Visibility of this point relative to what its tested sources usually have.
    [[nodiscard]] double factor() const { return expected > kEpsilon ? hits / expected : 0.5; }
};

inline constexpr std::size_t kFirstBlock = 4;   ///< candidates that are always tested
inline constexpr std::size_t kNextBlocks = 16;  ///< candidates per later block
/// Up to so many candidates are all tested when some have patterns: to sort them all patterns would
/// have to be evaluated, which costs more than a shadow test.
inline constexpr std::size_t kFewPatterned = kFirstBlock + kNextBlocks;

/// Test candidates, brightest first and block by block, until the next ones cannot matter.
/// @param tails      brightness[i] + brightness[i+1] + ... for each candidate, then 0
/// @param certainty  -dc: exponent of the count of candidates that are looked at ahead
/// @param threshold  -dt over the ray's weight: ignore what is less than this share of the radiance
/// so far
/// @param test       test(first, last): tests the candidates [first, last) and brings the tally up
/// to date
/// @return           how many were tested
/// Source: Ward, "Adaptive shadow testing for ray tracing", Eurographics Workshop on Rendering
/// 1991.
template <class Test>
std::size_t test_brightest(std::span<const float> tails, double certainty, double threshold,
                           const ShadowTally& tally, Test&& test) {
    const std::size_t n = tails.size() - 1;
    const auto all = static_cast<double>(n);
    const auto ahead =
        static_cast<std::size_t>(std::min(all, std::floor(std::pow(all, certainty) + 0.5)));
    for (std::size_t i = 0; i < n;) {
        const float rest = i + ahead >= n ? tails[i] : tails[i] - tails[i + ahead];
        if (i > 0 && static_cast<double>(rest) < threshold * static_cast<double>(tally.brightness))
            return i;
        const std::size_t last = std::min(n, i + (i == 0 ? kFirstBlock : kNextBlocks));
        test(i, last);
        i = last;
    }
    return n;
}

/// Whether a candidate of this brightness adds anything.
[[nodiscard]] bool brings_light(float brightness);

/// One use of the context's LightScratch: everything it adds there goes when it is destroyed.
class DirectCalculation {
  public:
    DirectCalculation(const LightSources& lights, Ray& ray, TraceContext& context);
    ~DirectCalculation();
    DirectCalculation(const DirectCalculation&) = delete;
    DirectCalculation& operator=(const DirectCalculation&) = delete;

    /// Sample all sources; keep what can bring light to the surface. What patterned sources bring
    /// is found later: by sort() for all, by test() only where they are seen. `front`: as for
    /// Tracer::add_direct.
    void gather(DirectCoefficient coefficient, const Vec3* front);

    /// Whether what some candidates bring is still to be found.
    [[nodiscard]] bool has_unknown() const;

    /// Brightest candidates first; those that bring nothing go. Fills tails().
    void sort();

    /// Test visibility of the candidates [first, last).
    void test(std::size_t first, std::size_t last);

    [[nodiscard]] std::size_t count() const {
        return scratch_.candidates.size() - first_candidate_;
    }
    /// Valid until the next call of a non-const method.
    [[nodiscard]] std::span<const LightCandidate> candidates() const {
        return std::span(scratch_.candidates).subspan(first_candidate_);
    }
    [[nodiscard]] std::span<const float> tails() const {
        return std::span(scratch_.tails).subspan(first_tail_);
    }

  private:
    struct Emission {
        Rgb radiance;
        double distance = kHuge;  ///< to the source's surface [m]
    };
    void gather(std::int32_t source, DirectCoefficient coefficient);
    void consider(std::int32_t source, const SourceSample& sample, DirectCoefficient coefficient);
    [[nodiscard]] bool meets_relay(const LightSource& source, const Vec3& direction) const;
    [[nodiscard]] bool is_constant(const LightSource& source) const;
    [[nodiscard]] std::optional<double> front_distance(const LightSource& source,
                                                       const Vec3& direction) const;
    void find_radiances(std::size_t first, std::size_t last, CandidateState state);
    void find_radiances(std::span<const std::size_t> group, ModifierId patterns);
    void find_radiance(std::size_t candidate);
    void set_radiance(std::size_t candidate, const Rgb& radiance);
    static void set_seen(LightCandidate& candidate);
    static void set_dark(LightCandidate& candidate);
    [[nodiscard]] std::optional<double> plane_distance(const LightSource& source,
                                                       const Vec3& direction) const;
    void add_candidate(std::int32_t source, const Vec3& direction, const Rgb& coefficient,
                       const Emission& emitted);
    void add_unknown(std::int32_t source, const Vec3& direction, const Rgb& coefficient,
                     double distance);
    [[nodiscard]] bool in_clear_air() const;
    [[nodiscard]] Ray aimed_ray(std::int32_t source, const Vec3& direction) const;
    [[nodiscard]] bool meet(const LightCandidate& candidate, Hit& hit) const;
    [[nodiscard]] Rgb emission(const LightCandidate& candidate) const;
    [[nodiscard]] Emission traced_emission(std::int32_t source, const Vec3& direction) const;
    [[nodiscard]] bool needs_tracing(const LightSource& source) const;
    [[nodiscard]] bool goes_through(const Vec3& direction) const;
    [[nodiscard]] Visibility visibility(const LightCandidate& candidate);
    void trace_shadow(std::size_t candidate);

    const LightSources& lights_;
    const Tracer& tracer_;
    Ray& ray_;
    TraceContext& context_;
    LightScratch& scratch_;
    Ray aimed_;             ///< copied to ask a source for its radiance
    RandomStream random_;   ///< of the samples on the sources
    double part_size_ = 0;  ///< of sources, relative to their distance
    std::size_t first_sample_, first_candidate_, first_tail_;
};

}  // namespace lightwalk
