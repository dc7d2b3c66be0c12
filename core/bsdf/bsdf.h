#pragma once
// A BSDF from a file, ready to shade with: what each side reflects and transmits.
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/bsdf/bsdf_lobes.h"

namespace lightwalk {

/// A component of a BSDF: a Lambertian part, and lobes on top of it.
struct BsdfComponent {
    std::unique_ptr<const BsdfLobes> lobes;  ///< null: none
    Rgb lambertian;  ///< reflectance or transmittance of what is the same in all directions

    /// Value with the Lambertian part [1/sr].
    [[nodiscard]] Rgb value(const ProjectedDirection& e, const ProjectedDirection& l) const;
};

/// Immutable; shared by all materials and threads that use the file.
/// Transmission that the data has from one side only is taken in reverse from the other. Reflection
/// that it does not have is none.
/// Source: Radiance's manual "The Radiance 6.x Scene Description Language" (BSDF); Radiance's notes
/// on BSDF directions.
class Bsdf {
  public:
    explicit Bsdf(std::shared_ptr<const BsdfData> data);

    [[nodiscard]] const BsdfData& data() const { return *data_; }
    /// @param front  whether the viewer is on the normal's side
    [[nodiscard]] const BsdfComponent& reflection(bool front) const {
        return parts_[static_cast<std::size_t>(front ? BsdfPart::front_reflection
                                                     : BsdfPart::back_reflection)];
    }
    [[nodiscard]] const BsdfComponent& transmission(bool front) const {
        return parts_[static_cast<std::size_t>(front ? BsdfPart::front_transmission
                                                     : BsdfPart::back_transmission)];
    }
    /// Whether any light passes.
    [[nodiscard]] bool transmits() const;
    /// The largest directional-hemispherical total of a component, the Lambertian part included.
    [[nodiscard]] double largest_total(BsdfPart part) const;
    /// One sentence for each component that sends on more light than it gets.
    [[nodiscard]] std::vector<std::string> warnings() const;
    /// Bytes of the tables and of what has been made of them.
    [[nodiscard]] std::size_t own_bytes() const;

  private:
    void load(BsdfPart part, BsdfPart table, bool reversed);

    std::shared_ptr<const BsdfData> data_;
    std::array<BsdfComponent, kBsdfParts> parts_;
};

}  // namespace lightwalk
