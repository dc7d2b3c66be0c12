#include "core/geometry/surface.h"

#include <algorithm>
#include <limits>

namespace lightwalk {

std::size_t SurfaceTable::add(const SurfaceList& list, const SurfaceShapes& shapes,
                              std::int32_t modifier_base) {
    if (list.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()) - size_)
        throw InputError("too many surfaces in one scene");
    parts_.push_back({&list, &shapes, static_cast<std::int32_t>(size_), modifier_base});
    size_ += list.size();
    return parts_.size() - 1;
}

const SurfacePart& SurfaceTable::part_of(SurfaceId id) const {
    if (parts_.size() == 1 || index(id) < parts_[1].first) return parts_[0];
    const auto after =
        std::upper_bound(parts_.begin(), parts_.end(), index(id),
                         [](std::int32_t i, const SurfacePart& part) { return i < part.first; });
    return *std::prev(after);
}

}  // namespace lightwalk
