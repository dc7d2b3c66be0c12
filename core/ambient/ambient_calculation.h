#pragma once
// Indirect diffuse light: from the cache, or from a hemisphere of rays, or the constant -av.
#include <vector>

#include "core/ambient/ambient_cache.h"
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

  private:
    struct Request;
    [[nodiscard]] bool takes_part(const Ray& ray) const;
    [[nodiscard]] Rgb constant(const Rgb& coef) const;
    [[nodiscard]] Rgb without_cache(const Request& request) const;
    [[nodiscard]] AmbientSum known(const Request& request) const;
    [[nodiscard]] Rgb with_cache(const Request& request) const;
    [[nodiscard]] Rgb new_value(const Request& request) const;
    [[nodiscard]] Hemisphere sample(const Request& request, const Rgb& coef, double weight,
                                    bool cached) const;
    [[nodiscard]] bool is_blocked(const Ray& ray, const Vec3& target) const;

    const Tracer& tracer_;
    AmbientCache* cache_ = nullptr;
    std::vector<bool> listed_;  ///< by modifier; empty without a list
};

}  // namespace lightwalk
