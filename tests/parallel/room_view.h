#pragma once
// The eye in the rooms that frames and blocks are tested with.
#include "core/view/view.h"

namespace lightwalk::test {

/// Six metres before a ball at the origin, looking at it from above.
inline View room_view() {
    View view;
    view.position = {1, -6, 2};
    view.direction = {-0.1, 1, -0.2};
    view.horizontal = 60;
    view.vertical = 45;
    return view;
}

}  // namespace lightwalk::test
