#pragma once
// Scenes that the material tests share.
#include <string>

#include "tests/test_scene.h"

namespace lightwalk::test {

/// Radiance 1 from all directions (a furnace): materials that conserve energy have radiance 1.
inline const std::string kFurnace =
    "void glow white 0 0 4 1 1 1 0\n"
    "white source up 0 0 4 0 0 1 180\n"
    "white source down 0 0 4 0 0 -1 180\n";

/// A square sheet of the modifier `m` at height z, facing up.
inline std::string sheet(const std::string& name, double z = 0) {
    const std::string h = " " + std::to_string(z) + " ";
    return "m polygon " + name + " 0 0 12 -9 -9" + h + "9 -9" + h + "9 9" + h + "-9 9" + h + "\n";
}

/// Options that follow paths until nothing is left, for scenes of many faces such as panes and
/// solids.
inline RenderOptions deep() {
    RenderOptions options = TestScene::exact();
    options.reflection_limit = 60;
    options.weight_limit = 1e-10;
    options.ambient_value = {1, 1, 1};
    return options;
}

inline double relative_error(double value, double expected) {
    return std::abs(value / expected - 1);
}

}  // namespace lightwalk::test
