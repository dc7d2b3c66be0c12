#pragma once
// Indirect diffuse light: from the cache, or from a hemisphere of rays, or the constant -av.
// Source: Ward, Rubinstein & Clear, "A Ray Tracing Solution for Diffuse Interreflection", SIGGRAPH
// 1988.
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/ambient/ambient_cache.h"
#include "core/ambient/ambient_point.h"
#include "core/ambient/hemisphere.h"
#include "core/transport/light_transport.h"

namespace lightwalk {

class CoefficientCache;
class CoefficientCalculation;
struct AmbientRequest;

class AmbientCalculation {
  public:
    /// Finds the modifiers that -ae and -ai name.
    explicit AmbientCalculation(const LightTransport& tracer);
    ~AmbientCalculation();
    AmbientCalculation(const AmbientCalculation&) = delete;
    AmbientCalculation& operator=(const AmbientCalculation&) = delete;
    void use_cache(AmbientCache* cache) { cache_ = cache; }
    /// Light is made of the terms that a context's sink is told: those of the rays of hemispheres
    /// come from here where there are records, and from one more ray each elsewhere. The values
    /// that other rays get stay as they are.
    void use_coefficients(const CoefficientCache* cache);

    /// `coef` times the ambient value at the ray's hit [W/(m² sr)].
    /// @param normal  shading normal, on the side of the surface whose light is wanted
    [[nodiscard]] Rgb add(Ray& ray, const Rgb& coef, const Vec3& normal,
                          TraceContext& context) const;

    /// Whether the values that rays at the context's ambient level get depend on what was asked for
    /// before.
    [[nodiscard]] bool depends_on_order(const TraceContext& context) const;

    // For filling the cache in rounds. All of these need a cache.

    /// Whether the cache has a value for the point.
    [[nodiscard]] bool is_served(const AmbientPoint& point) const;
    /// Compute the value at a point, without storing it; nothing where it could not be stored. What
    /// its rays lack themselves is treated as context.ambient says.
    [[nodiscard]] std::optional<AmbientRecord> record_at(const AmbientPoint& point,
                                                         TraceContext& context) const;
    /// Trace those rays of record_at that do not depend on what other rays see, so that the values
    /// that they lack are noted: context.ambient.missing must be set.
    void prefetch(const AmbientPoint& point, TraceContext& context) const;

  private:
    using Request = AmbientRequest;
    struct NewValue {
        Rgb value;
        std::optional<AmbientRecord> record;  ///< nothing: it cannot be stored
        std::vector<Rgb> groups;  ///< of the value, what each light group adds; empty: not asked
    };
    [[nodiscard]] bool takes_part(const Ray& ray) const;
    [[nodiscard]] Rgb constant(const Rgb& coef) const;
    /// The same, of which the context's sink is told.
    [[nodiscard]] Rgb told_constant(const Ray& ray, const Rgb& coef, TraceContext& context) const;
    [[nodiscard]] bool uses_cache(const TraceContext& context) const;
    [[nodiscard]] Rgb with_coefficients(const Request& request) const;
    [[nodiscard]] int divisions(double weight, bool cached) const;
    [[nodiscard]] Rgb without_cache(const Request& request) const;
    [[nodiscard]] Rgb by_one_ray(const Request& request) const;
    [[nodiscard]] AmbientSum known(const Request& request) const;
    [[nodiscard]] Rgb with_cache(const Request& request) const;
    [[nodiscard]] std::optional<Rgb> interpolated(const Request& request) const;
    static void tell_groups(const Request& request, const Rgb& coef, std::span<const Rgb> values);
    [[nodiscard]] Rgb new_value(const Request& request) const;
    /// Nothing where no ray could start.
    [[nodiscard]] std::optional<NewValue> make_value(const Request& request) const;
    void store(const Request& request, const NewValue& made) const;
    [[nodiscard]] static double evaluation_weight(const AmbientQuery& query);
    [[nodiscard]] double sampling_weight(const AmbientQuery& query) const;
    [[nodiscard]] Hemisphere sample(const Request& request, const Rgb& coef, double weight,
                                    bool cached) const;
    [[nodiscard]] bool is_blocked(const Ray& ray, const Vec3& target) const;

    const LightTransport& tracer_;
    AmbientCache* cache_ = nullptr;
    std::unique_ptr<const CoefficientCalculation> coefficients_;  ///< null: nothing is kept
    std::vector<bool> listed_;  ///< by modifier, whether -ae or -ai names it; empty without these
};

}  // namespace lightwalk
