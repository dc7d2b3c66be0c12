#pragma once
// The tracer: what materials ask of LightTransport, and what those who render pictures ask.
#include <memory>
#include <span>

#include "core/math/task_runner.h"
#include "core/transport/light_transport.h"

namespace lightwalk {

class AmbientCache;
class AmbientCalculation;
class CoefficientCache;

struct LightMeasures;

/// Radiance along rays in one scene. Holds the light sources, virtual ones included, and the
/// ambient calculation.
class Tracer final : public LightTransport {
  public:
    /// Prepares the light sources and their frozen visibility statistics, by a bounded number of
    /// rays. Throws InputError for illegal light sources and options that exclude each other.
    /// @param scene  must outlive this
    /// @param known  lights().measures() of one of the same scene, with the same options but for
    ///               those of indirect light: it would come out the same. Null: nothing is known
    Tracer(const Scene& scene, const RenderOptions& options, WarningSink& warnings,
           const TaskRunner& task_runner = SerialTaskRunner(),
           const LightMeasures* known = nullptr);
    ~Tracer() override;

    [[nodiscard]] const LightSources& lights() const override { return *lights_; }

    void trace(Ray& ray, TraceContext& context) const override;
    /// Evaluate a ray whose nearest hit is known, as trace() would.
    void shade_hit(Ray& ray, const Hit& hit, TraceContext& context) const;
    void shade_hits(std::span<Ray> rays, std::span<const Hit> hits,
                    TraceContext& context) const override;
    void shade_hits(std::span<Ray> rays, std::span<const Hit> hits, TraceContext& context,
                    FunctionRef<void(std::size_t)> shaded) const override;
    void enter_mixture(TraceContext& context, FunctionRef<void()> branch) const override;

    /// Irradiance at a sensor point (rtrace -I): the radiance of an ideal white surface there
    /// [W/m²].
    /// @param normal  where the sensor faces, of any length
    [[nodiscard]] Ray irradiance(const Vec3& point, const Vec3& normal, RandomStream random,
                                 TraceContext& context) const;

    /// Where -ab > 0 and -aa > 0 keep their values; it must outlive the tracer's use. Null: every
    /// value is computed anew, as with -aa 0. Not while rays are traced.
    void use_ambient_cache(AmbientCache* cache);
    /// Where the terms of indirect light come from that hemispheres see; it must outlive the
    /// tracer's use. Null: all are traced. Not while rays are traced.
    void use_coefficients(const CoefficientCache* cache);
    [[nodiscard]] const CoefficientCache* coefficients() const { return coefficients_; }
    [[nodiscard]] Rgb ambient(Ray& ray, const Rgb& coef, const Vec3& normal,
                              TraceContext& context) const override;
    void add_direct(Ray& ray, DirectCoefficient coefficient, TraceContext& context,
                    const Vec3* front = nullptr) const override;

  private:
    void shade_all(std::size_t count, FunctionRef<void(std::size_t)> shade,
                   TraceContext& context) const;
    void trace_apart(Ray& ray, GroupSums& groups, TraceContext& context) const;
    void shade_target(Ray& ray, TraceContext& context) const;
    void shade_background(Ray& ray, TraceContext& context) const;
    void apply_medium(Ray& ray, TraceContext& context) const;

    std::unique_ptr<LightSources> lights_;
    std::unique_ptr<AmbientCalculation> ambient_;
    const CoefficientCache* coefficients_ = nullptr;
};

}  // namespace lightwalk
