#pragma once
// Indirect diffuse light: from the cache, or from a hemisphere of rays, or the constant -av.
#include <optional>
#include <vector>

#include "core/ambient/ambient_cache.h"
#include "core/ambient/ambient_point.h"
#include "core/ambient/hemisphere.h"
#include "core/transport/tracer.h"

namespace lightwalk {

class AmbientCalculation {
  public:
    /// Finds the modifiers that -ae and -ai name.
    explicit AmbientCalculation(const Tracer& tracer);
    void use_cache(AmbientCache* cache) { cache_ = cache; }

    /// `coef` times the ambient value at the ray's hit. `normal` is the shading normal, on the side
    /// that is asked for.
    [[nodiscard]] Rgb add(Ray& ray, const Rgb& coef, const Vec3& normal,
                          TraceContext& context) const;

    // Values apart from the rays that want them; all need a cache.

    /// Whether the cache has a value for the point.
    [[nodiscard]] bool is_served(const AmbientPoint& point) const;
    /// The value at a point, which is not stored; nothing where it could not be. What its rays miss
    /// is treated as the context wants.
    [[nodiscard]] std::optional<AmbientRecord> record_at(const AmbientPoint& point,
                                                         TraceContext& context) const;
    /// Traces the rays that record_at would trace, as far as they do not depend on what the others
    /// see, for what they miss: context.missing must be set.
    void prefetch(const AmbientPoint& point, TraceContext& context) const;

  private:
    struct Request;
    struct NewValue {
        Rgb value;
        std::optional<AmbientRecord> record;  ///< nothing: it cannot be stored
    };
    [[nodiscard]] bool takes_part(const Ray& ray) const;
    [[nodiscard]] Rgb constant(const Rgb& coef) const;
    [[nodiscard]] Rgb without_cache(const Request& request) const;
    [[nodiscard]] AmbientSum known(const Request& request) const;
    [[nodiscard]] Rgb with_cache(const Request& request) const;
    [[nodiscard]] Rgb new_value(const Request& request) const;
    /// Nothing where no ray could start.
    [[nodiscard]] std::optional<NewValue> make_value(const Request& request) const;
    void store(const Request& request, const AmbientRecord& record) const;
    [[nodiscard]] static double evaluation_weight(const AmbientQuery& query);
    [[nodiscard]] static AmbientPoint point_of(const Request& request);
    [[nodiscard]] Hemisphere sample(const Request& request, const Rgb& coef, double weight,
                                    bool cached) const;
    [[nodiscard]] bool is_blocked(const Ray& ray, const Vec3& target) const;

    const Tracer& tracer_;
    AmbientCache* cache_ = nullptr;
    std::vector<bool> listed_;  ///< by modifier; empty without a list
};

}  // namespace lightwalk
