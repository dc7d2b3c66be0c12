#pragma once
// A basis of matrices of BSDF values: a hemisphere cut into rings of polar angle, each ring into
// equal sectors. Source: Klems, "A new method for predicting the solar heat gain of complex
// fenestration systems", ASHRAE Transactions 100 (1994); the names and their numbers: LBNL WINDOW's
// technical documentation, and genBSDF's manual page.
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "core/math/vec3.h"

namespace lightwalk {

/// A direction of a hemisphere by its projection along the pole: a point of the unit disk. Areas of
/// the disk are projected solid angles [sr].
struct ProjectedDirection {
    double x = 0, y = 0;
};
/// The unit vector above the disk's point, with z >= 0.
[[nodiscard]] inline Vec3 above_disk(const ProjectedDirection& p) {
    return {p.x, p.y, std::sqrt(std::max(0.0, 1 - p.x * p.x - p.y * p.y))};
}

/// Directions that are looked up together: side by side, as vectors of a processor have them.
inline constexpr std::size_t kNearDirections = 4;
struct NearDirections {
    alignas(32) std::array<double, kNearDirections> x{}, y{};
};
using PatchNumbers = std::array<std::size_t, kNearDirections>;

/// A ring as files describe it.
struct AngleRing {
    double upper = 0;  ///< its largest polar angle [degrees]; the smallest is the ring before's
    std::size_t sectors = 1;  ///< the first is centred on azimuth 0
};

/// Patches are numbered ring by ring from the pole, then by azimuth. Immutable.
class AngleBasis {
  public:
    static constexpr std::size_t kMostRings = 46;
    static constexpr std::size_t kMostSectors = 360;

    AngleBasis() = default;
    /// @param rings  of rising upper angles, the last of them 90 degrees
    explicit AngleBasis(std::vector<AngleRing> rings);

    [[nodiscard]] const std::vector<AngleRing>& rings() const { return rings_; }
    [[nodiscard]] std::size_t size() const { return patch_count_; }
    /// The number of the patch that holds a direction.
    [[nodiscard]] std::size_t index(const ProjectedDirection& p) const;
    /// The same for several at once.
    [[nodiscard]] PatchNumbers indices(const NearDirections& p) const;
    /// A patch's projected solid angle [sr].
    [[nodiscard]] double solid_angle(std::size_t patch) const { return areas_[patch]; }
    /// The smallest of these.
    [[nodiscard]] double least_solid_angle() const;
    /// A point of the patch from two numbers that are uniform in [0, 1), uniform in projected solid
    /// angle.
    [[nodiscard]] ProjectedDirection sample(std::size_t patch, double xi1, double xi2) const;

  private:
    struct Place {
        double inner = 0, outer = 0;  ///< squared sines of the polar angles
        double area = 0;              ///< of one patch [sr]
        std::size_t first = 0;        ///< number of the ring's first patch
        std::size_t ends = 0;         ///< where the ring's begin in ends_
    };
    [[nodiscard]] std::size_t ring_of(std::size_t patch) const;
    [[nodiscard]] std::size_t patch_of(std::size_t ring, double azimuth) const;

    std::vector<AngleRing> rings_;
    std::vector<Place> places_;  ///< one a ring
    std::vector<double> outer_;  ///< Place::outer of all rings but the last
    std::vector<double> areas_;  ///< Place::area of each patch
    /// Where the sectors of each ring end, as pseudo_azimuth, between numbers that are less and
    /// more than all.
    std::vector<double> ends_;
    std::size_t patch_count_ = 0;
};

/// Klems' full, half and quarter bases by the names that files give them (145, 77 and 41 patches),
/// and the half basis of older files (73); nothing for other names.
[[nodiscard]] std::optional<AngleBasis> klems_basis(std::string_view name);
[[nodiscard]] AngleBasis old_klems_half_basis();

}  // namespace lightwalk
