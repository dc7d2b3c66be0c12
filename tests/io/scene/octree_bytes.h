#pragma once
// Octrees as `oconv` writes them, but for the tree, which is one empty leaf: nobody searches it.
#include <string>
#include <vector>

#include "core/model/primitive.h"
#include "tests/all_primitives.h"
#include "tests/io/scene/binary_writer.h"

namespace lightwalk::test {

/// An octree that refers to scene files of so many primitives.
inline std::string referring_octree(const std::vector<std::string>& files, std::size_t primitives) {
    BinaryWriter file = begin_file("Radiance_octree", 287, "20");
    for (const std::string& name : files) file.text(name);
    return file.text("").integer(static_cast<std::int64_t>(primitives), 4).integer(0, 1).bytes();
}

inline void add_object(BinaryWriter& file, const Primitive& object) {
    file.integer(static_cast<std::int64_t>(object.type), 1).integer(object.modifier, 4);
    file.text(object.name).integer(static_cast<std::int64_t>(object.strings.size()), 2);
    for (const std::string& string : object.strings) file.text(string);
    file.integer(static_cast<std::int64_t>(object.reals.size()), 2);
    for (const double real : object.reals) file.real(real);
}

/// An octree that holds a model: its modifiers, then its surfaces. An alias names the latest
/// modifier that has the name of its own.
inline std::string frozen_octree(const Model& model) {
    BinaryWriter file = begin_file("Radiance_octree", 287, "20");
    file.text("").integer(static_cast<std::int64_t>(model.size()), 4).integer(0, 1);
    for (std::size_t i = 0; i < primitive_type_count(); ++i)
        file.text(std::string(to_string(static_cast<PrimitiveType>(i))));
    file.text("");
    for (const Primitive& modifier : model.modifiers) add_object(file, modifier);
    for (const Primitive& surface : surfaces_of(model)) add_object(file, surface);
    return file.integer(-1, 1).bytes();
}

}  // namespace lightwalk::test
