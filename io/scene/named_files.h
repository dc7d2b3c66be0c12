#pragma once
// Which files of a scene are there already, for whoever keeps them by their names.
#include "core/model/resources.h"

namespace lightwalk {

/// Whether the files of its kind, maps by name, include a file.
template <class Octrees, class Meshes, class Pictures>
[[nodiscard]] bool is_among(const NamedFile& file, const Octrees& octrees, const Meshes& meshes,
                            const Pictures& pictures) {
    switch (file.kind) {
        case NamedFile::Kind::octree:
            return octrees.contains(file.name);
        case NamedFile::Kind::mesh:
            return meshes.contains(file.name);
        case NamedFile::Kind::picture:
            break;
    }
    return pictures.contains(file.name);
}

}  // namespace lightwalk
