#pragma once
// A room for tests of choosing among lights.
#include <sstream>
#include <string>

#include "tests/test_scene.h"

namespace lightwalk::test {

inline const std::string kShinyFloor =
    "void plastic shiny 0 0 5 .5 .4 .3 .03 .1\n"
    "shiny polygon floor 0 0 12 -5 -5 0  5 -5 0  5 5 0  -5 5 0\n"
    "shiny polygon wall 0 0 12 .2 -1 .1  .2 -1 1.5  .2 1 1.5  .2 1 .1\n";

/// Twelve lamps of all kinds, of which a wall hides some, and some are so near that they are
/// divided. Needs striped_files().
inline std::string lamps_over_floor() {
    std::ostringstream text;
    text << kShinyFloor
         << "void light lamp 0 0 3 100 80 60\n"
            "void brightfunc stripes 2 stripe stripes.cal 0 0\n"
            "stripes light striped 0 0 3 30 30 30\n"
            "void spotlight beam 0 0 7 900 900 900 60 0 0 -1\n"
            "void glow near 0 0 4 50 50 50 2.5\n";
    for (int i = 0; i < 7; ++i)
        text << "lamp sphere s" << i << " 0 0 4 " << (i * 7 % 11) * .3 - 1.5 << ' '
             << (i * 5 % 9) * .3 - 1.2 << " 3 .1\n";
    text << "striped polygon panel 0 0 12 -2 -2 2  -2 -1 2  -1 -1 2  -1 -2 2\n"
            "lamp polygon window 0 0 12 -3 -1 1  -3 1 1  -3 1 2  -3 -1 2\n"
            "beam ring spot 0 0 8 1 1 3  0 0 -1  0 .1\n"
            "near sphere ball 0 0 4 -1 2 2 .2\n"
            "lamp source sun 0 0 4 .5 .2 1 1\n";
    return text.str();
}

inline MemoryResources striped_files() {
    MemoryResources files;
    files.functions["stripes.cal"] = "stripe = 1 + .9*sin(20*Px)*sin(9*Dy);";
    return files;
}

}  // namespace lightwalk::test
