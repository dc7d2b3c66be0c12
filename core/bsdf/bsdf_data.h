#pragma once
// What a file says about how a window system scatters light: tables of values, as they were
// measured or computed. See LBNL WINDOW's XML schema (BSDF-v1.4.xsd) and Radiance's genBSDF.
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/bsdf/angle_basis.h"
#include "core/bsdf/tensor_tree.h"

namespace lightwalk {

/// A matrix of BSDF values [1/sr], the cosine not included.
struct BsdfMatrix {
    AngleBasis incident, exitant;
    std::vector<float> y;  ///< luminous; of incident patch i to exitant patch o: [i * exitant + o]
    /// Of each value the ratios of X and Z to Y in CIE XYZ; empty: grey.
    std::vector<std::array<float, 2>> xz;
};

/// Tensor trees of BSDF values [1/sr], the cosine not included.
/// Rank 4: dimensions 0 and 1 are the incident direction as light travels, projected and mapped to
/// the square by disk_to_square, 2 and 3 the exitant direction. Rank 3, the same in all azimuths:
/// dimension 0 is half of 1 less the sine of the incident polar angle, 1 and 2 are the exitant
/// direction, turned so that light travels along +x.
struct BsdfTree {
    TensorTree y;                    ///< luminous
    std::optional<TensorTree> u, v;  ///< u' and v' of CIE 1976; both, or none: grey
};

using BsdfTable = std::variant<BsdfMatrix, BsdfTree>;

/// The components of a BSDF, by the side of the normal on which the viewer is. Files call this side
/// Back.
enum class BsdfPart : std::uint8_t {
    front_transmission,
    back_transmission,
    front_reflection,
    back_reflection,
};
inline constexpr std::size_t kBsdfParts = 4;

/// The contents of a file.
struct BsdfData {
    std::string name;                                        ///< the material's, for people
    std::array<std::optional<BsdfTable>, kBsdfParts> parts;  ///< nothing: not in the file
    std::string geometry;            ///< the system's geometry in MGF; "" where the file has none
    double geometry_unit = 1;        ///< [m]
    std::int32_t geometry_line = 0;  ///< of the file, where it begins
    std::array<double, 3> size{};    ///< width, height, thickness [m]; 0: not in the file

    [[nodiscard]] const std::optional<BsdfTable>& part(BsdfPart which) const {
        return parts[static_cast<std::size_t>(which)];
    }
};

}  // namespace lightwalk
