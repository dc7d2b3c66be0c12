#pragma once
// Indirect light as coefficients: what hemispheres see comes from records, or makes them.
#include <cstdint>
#include <optional>
#include <vector>

#include "core/ambient/ambient_request.h"
#include "core/ambient/coefficient_cache.h"
#include "core/ambient/refined_hemisphere.h"
#include "core/transport/light_transport.h"

namespace lightwalk {

/// No state between calls: any number of threads may use one, each with its own context, whose sink
/// is told of terms and records.
class CoefficientCalculation {
  public:
    /// Both must outlive this.
    CoefficientCalculation(const LightTransport& tracer, const CoefficientCache& cache);

    /// The request's coefficient times what the records have for it [W/(m² sr)]; where there are
    /// none, nothing, or black while such points are collected (context.ambient.missing).
    [[nodiscard]] std::optional<Rgb> known(const AmbientRequest& request) const;
    /// The request's coefficient times what a hemisphere of `divisions` cells an axis brings
    /// [W/(m² sr)]; nothing where no ray could start.
    [[nodiscard]] std::optional<Rgb> seen(const AmbientRequest& request, int divisions) const;

    // For filling the cache in rounds.

    [[nodiscard]] bool is_served(const AmbientPoint& point, CoefficientScratch& scratch) const;
    /// How far a record at a point would reach [m]; nothing where there shall be none, which is
    /// under the open sky: paths are short there, and how far it is to a wall cannot be seen.
    [[nodiscard]] std::optional<double> reach_at(const AmbientPoint& point) const;
    /// The record of a point, without storing it, whose terms the sink is told; nothing where no
    /// ray could start.
    [[nodiscard]] std::optional<CoefficientRecord> record_at(const AmbientPoint& point,
                                                             double reach,
                                                             TraceContext& context) const;

  private:
    [[nodiscard]] Surroundings sample(const AmbientRequest& request,
                                      RefinedHemisphere::Sampling sampling) const;

    const LightTransport& tracer_;
    const CoefficientCache& cache_;
    std::vector<std::uint8_t> lets_light_;  ///< by modifier
};

}  // namespace lightwalk
