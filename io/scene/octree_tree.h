#pragma once
// The tree of an octree file: which objects lie in which of its cubes.
#include <cstdint>
#include <span>
#include <string>

#include "core/geometry/bounds.h"
#include "core/model/primitive.h"

namespace lightwalk {

inline constexpr int kObjectNumberSize = 4;  ///< in octrees that are written [bytes]

/// An object of a tree. Cubes that it cannot meet may count as met, which costs whoever walks
/// through the tree time; a cube that it meets always counts.
struct TreeObject {
    std::uint32_t number = 0;
    Bounds bounds;  ///< not empty
    /// The plane that the object lies in, normal . p = offset [m]; no normal: it lies in none.
    Vec3 normal;
    double offset = 0;
};

struct TreeLimits {
    int objects = 6;         ///< a cube of more objects is divided
    int resolution = 16384;  ///< the least cube is the whole one divided by this
};

/// The bytes of a tree, as octree files hold them: nodes in preorder, kObjectNumberSize bytes an
/// object number.
/// @param objects  in the order of their numbers
/// @param cube     that holds all of them
/// Throws InputError where more objects than a leaf can name, 511, meet in a least cube.
/// Source: Radiance's "File Formats" (1997), "Octrees"; manual page oconv(1) for the limits.
[[nodiscard]] std::string encode_tree(std::span<const TreeObject> objects, const ModelCube& cube,
                                      const TreeLimits& limits = {});

}  // namespace lightwalk
