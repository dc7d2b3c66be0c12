#pragma once
// The terms of a ray's radiance: all light that reaches the eye is a sum over emitters of a
// coefficient, which the way of the light decides, times what the emitter sends.
#include <cstdint>
#include <utility>

#include "core/math/rgb.h"
#include "core/math/vec3.h"
#include "core/model/ids.h"
#include "core/transport/ray.h"

namespace lightwalk {

/// One term of the radiance along a primary ray.
struct Contribution {
    ModifierId modifier = kVoid;  ///< of the surface that emits; kVoid: the constant -av, which has
                                  ///< neither place nor direction
    Vec3 direction;   ///< unit, of the ray that meets the emitter: away from the eye's side
    Vec3 position;    ///< where the ray meets it; of a distant one, the ray's origin [m], world
    Rgb coefficient;  ///< factor of the emitter's radiance in that of the primary ray
    Rgb value;        ///< what it adds to it: the coefficient times the radiance [W/(m² sr)]
};

/// Is told the terms of the radiance of rays, in no particular order. Their values add up to that
/// of the primary rays, to rounding, but for samples that are left out once their light is known:
/// shadow rays that bring less than kEpsilon. Belongs to one thread's TraceContext.
/// While somebody listens, other than for groups of emitters (GroupSums), all light sources are
/// tested for shadows (-dt 0), and indirect light is neither interpolated (but see add_record) nor
/// extrapolated nor sampled where it differs most
/// (-aa 0 -as 0, no gradients): these decide by radiance what a coefficient would be.
class ContributionSink {
  public:
    virtual ~ContributionSink() = default;
    virtual void add(const Contribution& term) = 0;
    /// In place of terms: a record of the cache of coefficients, where the tracer uses one.
    /// @param coefficient  factor of the record's value in the radiance of the primary ray
    virtual void add_record(std::uint32_t /*record*/, const Rgb& /*coefficient*/) {}

    /// The ray whose radiance the terms are parts of, an ancestor of those that tell; null: the
    /// primary ray. Its own medium and coefficient are not in theirs.
    [[nodiscard]] const Ray* root() const { return root_; }
    /// @return  the one before
    const Ray* set_root(const Ray* root) { return std::exchange(root_, root); }

  private:
    const Ray* root_ = nullptr;
};

/// What a medium leaves of the radiance along `distance`; direct light loses only what is absorbed.
/// @param distance  [m]; may be kHuge
[[nodiscard]] Rgb transmittance(const Medium& medium, double distance, bool shadow);

/// Factor of the radiance that arrives at the near end of what `ray` has met, in that of the
/// primary ray, or of another root (ContributionSink::root): the coefficients and media of its
/// path, its own included. The hits of the path must be set.
[[nodiscard]] Rgb path_throughput(const Ray& ray, const Ray* root = nullptr);
/// The same without the medium of the ray's own segment.
[[nodiscard]] Rgb path_coefficient(const Ray& ray, const Ray* root = nullptr);

/// Tell that `ray` meets an emitter, which sends ray.value. A ray that only asks a light source for
/// its radiance (Ray::aimed) brings nothing.
void tell_emission(const Ray& ray, ContributionSink& sink);
/// Tell of constant light that `ray` brings.
/// @param coefficient  to the primary ray
/// @param radiance     [W/(m² sr)]
void tell_constant(const Ray& ray, const Rgb& coefficient, const Rgb& radiance,
                   ContributionSink& sink);
/// Tell a term unless it is not finite: such rays count as black.
void tell(const Contribution& term, ContributionSink& sink);

}  // namespace lightwalk
