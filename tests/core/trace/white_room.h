#pragma once
// A white room with a lamp below its ceiling, where most light has been reflected.
#include <string>

#include "core/math/xyz.h"
#include "tests/test_scene.h"

namespace lightwalk::test {

inline const std::string kWhiteRoom =
    "void plastic white 0 0 5 .7 .6 .5 0 0\nvoid light lamp 0 0 3 9 9 9\n"
    "white polygon floor 0 0 12 -2 -2 0 2 -2 0 2 2 0 -2 2 0\n"
    "white polygon ceiling 0 0 12 -2 -2 3 -2 2 3 2 2 3 2 -2 3\n"
    "white polygon west 0 0 12 -2 -2 0 -2 2 0 -2 2 3 -2 -2 3\n"
    "white polygon east 0 0 12 2 -2 0 2 -2 3 2 2 3 2 2 0\n"
    "white polygon south 0 0 12 -2 -2 0 -2 -2 3 2 -2 3 2 -2 0\n"
    "white polygon north 0 0 12 -2 2 0 2 2 0 2 2 3 -2 2 3\n"
    "lamp polygon panel 0 0 12 -.5 -.5 2.9 -.5 .5 2.9 .5 .5 2.9 .5 -.5 2.9\n";

/// Of a picture with a cache, which nothing here has.
inline RenderOptions two_bounces() {
    RenderOptions options = TestScene::exact();
    options.ambient_bounces = 2;
    options.ambient_accuracy = .2;
    options.ambient_divisions = 400;
    options.ambient_super_samples = 0;
    return options;
}

/// By many hemispheres of 400 samples, without a cache [lx].
inline double illuminance_of(TestScene& scene, const Vec3& at, const Vec3& normal) {
    constexpr int kHemispheres = 150;
    double sum = 0;
    for (std::uint32_t i = 0; i < kHemispheres; ++i)
        sum += static_cast<double>(brightness(
            scene.tracer.irradiance(at, normal, RandomStream::of_pixel(99, 3, 4, i), scene.context)
                .value));
    return double{kEfficacy} * sum / kHemispheres;
}

}  // namespace lightwalk::test
