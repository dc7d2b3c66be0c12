#pragma once
// The view of the rooms in which frames and blocks are tested.
#include "core/view/view.h"

namespace lightwalk::test {

/// A view from above of a ball at the origin, at a distance of six metres.
inline View room_view() {
    View view;
    view.position = {1, -6, 2};
    view.direction = {-0.1, 1, -0.2};
    view.horizontal = 60;
    view.vertical = 45;
    return view;
}

}  // namespace lightwalk::test
