#pragma once
// What rank 0 tells the others of a picture, or of a walk's frame. Everything else follows from the
// options, which all ranks have.
#include <cstdint>
#include <optional>
#include <vector>

#include "core/view/view.h"
#include "parallel/comm/core_fields.h"

namespace lightwalk {

struct PictureOrder {
    View view;
    std::optional<View> previous;  ///< for motion blur
    int width = 0, height = 0;     ///< of a picture; a frame's own order has them
    bool indirect = true;          ///< false: by direct light alone
    // Of a pass over a picture (parallel/adaptive_picture.h).
    int samples = 0;  ///< rays a pixel; 0: it is no pass
    std::uint64_t seed = 0;
    bool first = true;                ///< of its picture
    std::vector<std::uint8_t> tiles;  ///< TileMask::bytes()
};
template <class Wire>
void visit_fields(Wire& wire, PictureOrder& order) {
    wire(order.view, order.previous, order.width, order.height, order.indirect, order.samples,
         order.seed, order.first, order.tiles);
}

}  // namespace lightwalk
