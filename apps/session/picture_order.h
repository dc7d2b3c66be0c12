#pragma once
// What rank 0 tells the others of a picture, or of a walk's frame. Everything else follows from the
// options, which all ranks have.
#include <optional>

#include "core/view/view.h"
#include "parallel/comm/core_fields.h"

namespace lightwalk {

struct PictureOrder {
    View view;
    std::optional<View> previous;  ///< for motion blur
    int width = 0, height = 0;     ///< of a picture; a frame's own order has them
    bool indirect = true;          ///< false: by direct light alone
};
template <class Wire>
void visit_fields(Wire& wire, PictureOrder& order) {
    wire(order.view, order.previous, order.width, order.height, order.indirect);
}

}  // namespace lightwalk
