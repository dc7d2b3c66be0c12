#include "io/scene/octree_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/math/portable_numbers.h"

namespace lightwalk {
namespace {

constexpr char kEmpty = 0, kFull = 1, kDivided = 2;
constexpr int kChildren = 8;
constexpr std::size_t kLargestSet = 511;

using Members = std::vector<std::uint32_t>;  ///< places in the list of objects

struct Cube {
    Vec3 middle;
    double half = 0;  ///< of its edge [m]
};

class TreeEncoder {
  public:
    /// @param half  of the whole cube's edge [m]
    TreeEncoder(std::span<const TreeObject> objects, const TreeLimits& limits, double half)
        : objects_(objects),
          limits_(limits),
          least_half_(half / limits.resolution),
          coarse_half_(half / (8 * std::cbrt(1 + static_cast<double>(objects.size())))) {}

    void add(const Cube& cube, const Members& members) {
        if (members.empty()) {
            bytes_ += kEmpty;
        } else if (members.size() <= static_cast<std::size_t>(limits_.objects) ||
                   cube.half <= least_half_ || !divide(cube, members)) {
            add_leaf(members);
        }
    }
    [[nodiscard]] std::string take() { return std::move(bytes_); }

  private:
    [[nodiscard]] bool meets(const TreeObject& object, const Cube& cube) const {
        // Rounding, of the walker's own tests too, must not lose an object between two cubes.
        const double reach = cube.half * (1 + 1e-6);
        const Vec3 low = object.bounds.lower, high = object.bounds.upper, c = cube.middle;
        if (low.x > c.x + reach || high.x < c.x - reach || low.y > c.y + reach ||
            high.y < c.y - reach || low.z > c.z + reach || high.z < c.z - reach)
            return false;
        const Vec3 n = object.normal;
        if (length_squared(n) == 0) return true;
        const double span = reach * (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
        return std::abs(dot(n, c) - object.offset) <= span;
    }

    void add_leaf(const Members& members) {
        if (members.size() > kLargestSet)
            throw InputError("an octree cannot hold " + std::to_string(members.size()) +
                             " surfaces that meet in one place, at most " +
                             std::to_string(kLargestSet));
        bytes_ += kFull;
        append_integer(bytes_, members.size(), kObjectNumberSize);
        for (const std::uint32_t member : members)
            append_integer(bytes_, objects_[member].number, kObjectNumberSize);
    }

    /// False: nothing is gained, or too little for so small a cube. Objects that are large beside
    /// it meet many of its parts, and would be named in more and more of them.
    [[nodiscard]] bool divide(const Cube& cube, const Members& members) {
        const double half = cube.half / 2;
        std::array<Cube, kChildren> cubes;
        std::array<Members, kChildren> parts;
        std::size_t all = 0;
        for (unsigned k = 0; k < kChildren; ++k) {
            const auto side = [&](unsigned bit) { return (k & bit) != 0 ? half : -half; };
            cubes[k] = {cube.middle + Vec3{side(1), side(2), side(4)}, half};
            for (const std::uint32_t member : members)
                if (meets(objects_[member], cubes[k])) parts[k].push_back(member);
            all += parts[k].size();
        }
        const std::size_t poor = (cube.half > coarse_half_ ? 8 : 3) * members.size();
        if (all >= poor && members.size() <= kLargestSet) return false;
        bytes_ += kDivided;
        for (unsigned k = 0; k < kChildren; ++k) {
            add(cubes[k], parts[k]);
            parts[k] = {};
        }
        return true;
    }

    std::span<const TreeObject> objects_;
    TreeLimits limits_;
    double least_half_, coarse_half_;
    std::string bytes_;
};

}  // namespace

std::string encode_tree(std::span<const TreeObject> objects, const ModelCube& cube,
                        const TreeLimits& limits) {
    Members all(objects.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    const double half = cube.size / 2;
    TreeEncoder encoder(objects, limits, half);
    encoder.add({Vec3{cube.x, cube.y, cube.z} + Vec3{half, half, half}, half}, all);
    return encoder.take();
}

}  // namespace lightwalk
