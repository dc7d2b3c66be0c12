#pragma once
// A surface of a BSDF from a file where a ray hits it: its frame, and what it sends on of lights
// and of sampled directions.
#include <cstdint>

#include "core/bsdf/bsdf.h"
#include "core/bsdf/through_part.h"
#include "core/transport/light_transport.h"

namespace lightwalk {

/// The frame of the data: z along the shading normal, which is not turned to the viewer, y towards
/// `up`.
struct BsdfFrame {
    Vec3 x, y, z;

    [[nodiscard]] ProjectedDirection project(const Vec3& v) const { return {dot(x, v), dot(y, v)}; }
    /// @param side  1 for directions on the side of z, -1 for those on the other
    [[nodiscard]] Vec3 direction(const ProjectedDirection& p, double side) const {
        return x * p.x + y * p.y + z * (side * above_disk(p).z);
    }
};

/// What one hit makes of the material.
struct BsdfHit {
    const Bsdf& bsdf;
    BsdfFrame frame;
    ProjectedDirection e;        ///< towards the viewer
    double side = 1;             ///< 1: the viewer is on the side of the frame's z; else -1
    Rgb pattern;                 ///< colours all but the reflected lobes
    Rgb reflected, transmitted;  ///< Lambertian reflectance and transmittance
    double thickness = 0;        ///< 0: none [m]
    BsdfLookup in_reflection{}, in_transmission{};  ///< e in the tables, where these have lobes
    /// Over all components with lobes that are seen from this side: the smallest and the largest
    /// projected solid angle that directions about e are told apart by [sr].
    SolidAngleRange resolution{kPi, kPi};
    double height = above_disk(e).z;  ///< of e above the disk, for what is jittered
    bool split = false;     ///< the part that passes straight is traced by a ray of its own
    ThroughPart through{};  ///< that part, without the pattern

    [[nodiscard]] bool front() const { return side > 0; }
    /// The frame's normal towards the viewer.
    [[nodiscard]] Vec3 facing() const { return frame.z * side; }
    [[nodiscard]] const BsdfComponent& reflection() const { return bsdf.reflection(front()); }
    [[nodiscard]] const BsdfComponent& transmission() const { return bsdf.transmission(front()); }
    [[nodiscard]] bool transmits() const {
        return transmission().lobes || max_component(transmitted) > static_cast<float>(kEpsilon);
    }
};

/// Look e up in the tables of the hit's side, for lights and samples.
void look_up_viewer(BsdfHit& hit);

/// e moved by random parts of `size`, which -ss below 1 reduces.
[[nodiscard]] ProjectedDirection jittered(const BsdfHit& hit, double size, double specular_samples,
                                          RandomStream& random);

/// Several of these, from a stream of independent numbers, at once.
[[nodiscard]] NearDirections jittered_near(const BsdfHit& hit, double size, double specular_samples,
                                           RandomStream& random);

/// Shades the light of single sources.
class BsdfDirect {
  public:
    /// Draws from the ray's random numbers where -ss asks for jitter.
    BsdfDirect(const BsdfHit& hit, Ray& ray, const RenderOptions& options);
    /// f cosθ ω of light from wi. A light's result does not depend on others.
    [[nodiscard]] Rgb operator()(const Vec3& wi, double omega) const;

  private:
    [[nodiscard]] Rgb lobe(const BsdfComponent& component, const ProjectedDirection& l,
                           double omega, double cosine, bool through) const;
    [[nodiscard]] RandomStream stream_for(const Vec3& wi) const;

    const BsdfHit& hit_;
    double specular_samples_;
    int count_;  ///< of values that a lobe's is the mean of
    std::uint64_t key_ = 0;
};

/// Trace samples of both components' lobes and add what they see to ray.value. What is too faint to
/// be sampled (-st) is left to ambient light.
struct UnsampledLobes {
    Rgb reflected, transmitted;
};
[[nodiscard]] UnsampledLobes add_bsdf_samples(Ray& ray, const BsdfHit& hit, TraceContext& context);

}  // namespace lightwalk
