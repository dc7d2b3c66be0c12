#pragma once
// Decodes the parts that octrees and meshes have in common: bounding cube, tree, serialised
// objects.
#include <cstdint>

#include "core/model/model_builder.h"
#include "core/model/primitive.h"
#include "io/formats/binary_reader.h"

namespace lightwalk {

/// Read the cube, which is stored as four decimal strings: x y z of the origin, edge length. Throws
/// InputError when they are no numbers.
[[nodiscard]] ModelCube read_cube(BinaryReader& reader);

/// Skip a tree in pre-order whose leaves hold object numbers of `id_size` bytes. Returns the number
/// of nodes.
std::uint64_t skip_tree(BinaryReader& reader, int id_size);

/// Read the type table and the objects that follow it into `builder`. It must be empty, so that
/// object numbers of the file are indices into the model.
void read_objects(BinaryReader& reader, int id_size, ModelBuilder& builder);

}  // namespace lightwalk
