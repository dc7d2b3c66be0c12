#pragma once
// Samples of light that are independent of each other: what numbers with an interval are made of.
#include <array>
#include <memory>
#include <vector>

#include "core/math/function_ref.h"
#include "core/math/student_t.h"
#include "core/trace/tracer.h"
#include "core/transport/light_groups.h"

namespace lightwalk {

/// A radiance or an irradiance.
struct SampledLight {
    Rgb whole;
    std::vector<Rgb> groups;  ///< what each light group adds; empty: not kept
};

/// Samples of the same light, as the means of batches: light that is mixed anew has its interval
/// without new rays.
class LightBatches {
  public:
    void add(const SampledLight& light);
    void clear() { *this = {}; }
    [[nodiscard]] int count() const { return count_; }
    /// @param shown  a number that is linear in light
    [[nodiscard]] MeanInterval interval(FunctionRef<double(const SampledLight&)> shown) const;

  private:
    static constexpr std::size_t kBatches = 16;
    std::array<SampledLight, kBatches> means_;
    int count_ = 0;
};

/// Traces rays of the light of another tracer, but for what makes its answers depend on each other:
/// indirect light is followed anew for each ray, along few paths, rather than interpolated between
/// values that rays share. So an answer is noisier, and the spread of some tells all that their
/// mean may be off by. For one thread.
class LightSampler {
  public:
    /// @param tracer  of the light; `tracer` and `warnings` must outlive this
    /// @param groups  of emitters that may be dimmed; null: none
    LightSampler(const Tracer& tracer, WarningSink& warnings,
                 std::shared_ptr<const LightGroups> groups = nullptr);

    /// Of the light groups in what follows.
    void mix(LightMixture mixture) { mixture_ = std::move(mixture); }

    /// Random numbers of sample `sample`; questions of different kinds get others.
    [[nodiscard]] RandomStream random(std::uint32_t kind, std::uint32_t sample) const;
    /// Of a ray [W/(m² sr)].
    /// @param limit  see LightTransport::primary
    [[nodiscard]] SampledLight radiance(const Vec3& origin, const Vec3& direction, double limit,
                                        RandomStream random);
    /// At a place, on the side of a normal [W/m²].
    [[nodiscard]] SampledLight irradiance(const Vec3& point, const Vec3& normal,
                                          RandomStream random);
    /// Luminance or illuminance of light in the mixture [cd/m², lx].
    [[nodiscard]] double shown(const SampledLight& light) const;

  private:
    class Silence final : public WarningSink {  // the tracer of pictures says what is to be said
        void warn(const std::string& /*message*/) override {}
    };
    [[nodiscard]] SampledLight light_of(const Rgb& value) const;

    Silence silence_;
    Tracer tracer_;
    TraceContext context_;
    std::unique_ptr<GroupSums> sums_;  ///< null: no light groups
    LightMixture mixture_;
};

}  // namespace lightwalk
