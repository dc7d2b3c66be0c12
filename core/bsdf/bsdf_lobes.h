#pragma once
// A component of a BSDF from tables, less its Lambertian part: values, totals and samples.
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "core/bsdf/bsdf_data.h"
#include "core/math/rgb.h"

namespace lightwalk {

/// Range of projected solid angles [sr] between which the table tells directions apart.
struct SolidAngleRange {
    double least = 0, largest = 0;
};

/// A direction as one component's table is looked up for it. Made once: a direction to the viewer
/// meets many lights, and that to a light several directions about the viewer's.
struct BsdfLookup {
    ProjectedDirection direction;
    std::size_t patch = 0;              ///< of a matrix
    std::array<HalvingPath, 2> path{};  ///< into a tree
};

/// A component for light that comes from one side and leaves to one side. Directions are given by
/// their projections onto the surface, those of unit vectors that point away from it: `e` to the
/// viewer, on whose side data is looked up as that of the incident light, and `l` to the light.
/// Immutable; any number of threads may use it.
class BsdfLobes {
  public:
    struct Value {
        Rgb f;                   ///< [1/sr]
        double solid_angle = 0;  ///< projected, of the cell [sr]
        std::uint64_t cell = 0;  ///< which one, for the same e
        /// False where there is nothing but the Lambertian part. Cells of matrices never are so: as
        /// in Radiance, which tells equal ones apart by small differences.
        bool has_lobe = true;
    };
    struct Sample {
        ProjectedDirection l;
        Rgb color{1, 1, 1};  ///< of brightness 1, or white
    };

    virtual ~BsdfLobes() = default;
    [[nodiscard]] virtual BsdfLookup look_up(const ProjectedDirection& e) const = 0;
    [[nodiscard]] virtual BsdfLookup look_up_light(const ProjectedDirection& l) const = 0;
    /// @param l  as look_up_light() returned it
    [[nodiscard]] virtual Value value(const BsdfLookup& e, const BsdfLookup& l) const = 0;
    [[nodiscard]] Value value_for(const BsdfLookup& e, const ProjectedDirection& l) const {
        return value(e, look_up_light(l));
    }
    /// The values of several directions to the viewer for one light. Matrices look all of them up
    /// at once.
    [[nodiscard]] virtual std::array<Value, kNearDirections> values_near(
        const NearDirections& e, const BsdfLookup& l) const {
        std::array<Value, kNearDirections> values;
        for (std::size_t i = 0; i < kNearDirections; ++i)
            values[i] = value(look_up({e.x[i], e.y[i]}), l);
        return values;
    }
    /// The directional-hemispherical total: the integral of f over projected solid angle.
    [[nodiscard]] virtual double total(const BsdfLookup& e) const = 0;
    /// A direction of probability f / total over projected solid angle, for total(e) > 0.
    /// @param choice    uniform in [0, 1): which cell
    /// @param xi1, xi2  uniform in [0, 1): where in the cell
    [[nodiscard]] virtual Sample sample(const BsdfLookup& e, double choice, double xi1,
                                        double xi2) const = 0;
    /// Which cell of directions to the viewer e is in: the same values stand for all of a cell.
    [[nodiscard]] virtual std::uint32_t viewer_cell(const BsdfLookup& e) const = 0;
    /// The range about e.
    [[nodiscard]] virtual SolidAngleRange resolution(const BsdfLookup& e) const = 0;
    /// The smallest projected solid angle of all cells [sr].
    [[nodiscard]] virtual double least_solid_angle() const = 0;
    /// The largest total.
    [[nodiscard]] virtual double largest_total() const = 0;
    /// Bytes of what it has made of the table, without the table itself.
    [[nodiscard]] virtual std::size_t own_bytes() const = 0;
};

/// A table's component, and what has been taken off it.
struct SplitLobes {
    std::unique_ptr<const BsdfLobes> lobes;
    Rgb lambertian;  ///< reflectance or transmittance of the part that is the same everywhere
};

/// @param table     kept; must live as long as the lobes
/// @param reversed  take the values for (e, l) from (l, e): by reciprocity those of light that
/// comes
///                  from the other side
[[nodiscard]] SplitLobes make_matrix_lobes(const BsdfMatrix& table, bool reversed);
[[nodiscard]] SplitLobes make_tree_lobes(const BsdfTree& table, bool reversed);

/// Whether a least value of so much luminance [1/sr] counts as a Lambertian part.
[[nodiscard]] inline bool is_lambertian_part(double least) {
    return least > 0.01 / kPi;
}

}  // namespace lightwalk
