#pragma once
// What octrees and meshes share: the bounding cube, the tree, and serialised objects.
#include <cstdint>

#include "core/model/model_builder.h"
#include "core/model/primitive.h"
#include "io/formats/binary_reader.h"

namespace lightwalk {

/// The cube as four decimal strings: origin x y z, edge. Throws InputError when they are no
/// numbers.
[[nodiscard]] ModelCube read_cube(BinaryReader& reader);

/// Skip a tree in pre-order whose leaves hold numbers of `id_size` bytes. Returns how many nodes it
/// has.
std::uint64_t skip_tree(BinaryReader& reader, int id_size);

/// Read the type table and the objects that follow it into `builder`, which is empty: object
/// numbers of the file are then indices into the model.
void read_objects(BinaryReader& reader, int id_size, ModelBuilder& builder);

}  // namespace lightwalk
