#pragma once
// A room with a lamp, and pictures of it, for the tests of renderers: of threads and of ranks.
#include <string>

#include "apps/session/lightwalk/renderer.h"

namespace lightwalk::test {

inline const std::string kLampRoom = R"(
void plastic grey 0 0 5 .5 .4 .3 .02 .1
void light lamp 0 0 3 40 40 40
grey polygon floor 0 0 12  -4 -6 0  4 -6 0  4 6 0  -4 6 0
grey sphere ball 0 0 4 -1 2 .7 .7
lamp polygon panel 0 0 12  -1 -1 2.99  -1 1 2.99  1 1 2.99  1 -1 2.99
)";

/// A picture from x [m], by the near wall; its size in pixels.
inline PictureTask task_at(double x, int width = 48, int height = 36) {
    PictureTask task;
    task.view.position = {x, -5, 1.5};
    task.width = width;
    task.height = height;
    return task;
}

}  // namespace lightwalk::test
