#pragma once
// A room whose indirect light is cached, and ambient values, for tests.
#include <string>

#include "core/ambient/ambient_record.h"
#include "core/transport/options.h"
#include "core/view/view.h"

namespace lightwalk::test {

/// Ground, ceiling and back of a room with a ball, open to a sky on one side.
inline const std::string kAmbientRoom = R"(
void plastic paint 0 0 5 .6 .5 .4 0 0
void glow sky 0 0 4 1 1 2 0
sky source dome 0 0 4 0 -1 0 180
paint polygon ground 0 0 12  -3 -3 0  3 -3 0  3 3 0  -3 3 0
paint polygon ceiling 0 0 12  -3 -3 3  -3 3 3  3 3 3  3 -3 3
paint polygon back 0 0 12  -3 3 0  3 3 0  3 3 3  -3 3 3
paint sphere ball 0 0 4 0 1 1 .7
)";

/// The eye before the open side.
inline Camera ambient_eye() {
    View view;
    view.position = {0.5, -5, 1.4};
    view.direction = {0, 1, 0};
    return Camera(view);
}

/// Few rays a value. Options -ab, -aa and -ar.
inline RenderOptions ambient_options(int bounces, double accuracy, int resolution) {
    RenderOptions options;
    options.ambient_bounces = bounces;
    options.ambient_divisions = 32;
    options.ambient_super_samples = 0;
    options.ambient_accuracy = accuracy;
    options.ambient_resolution = resolution;
    return options;
}

inline AmbientRecord record_at(float x) {
    AmbientRecord record;
    record.position = {x, 0, 0};
    record.radius = {.1F, .1F};
    record.value = {1, 1, 1};
    return record;
}

}  // namespace lightwalk::test
