#pragma once
// Sensors in scenes for which theory says what they measure.
#include <cstdint>
#include <string>
#include <vector>

#include "tests/core/theory/formulas.h"
#include "tests/test_scene.h"
#include "tests/tolerance.h"

namespace lightwalk::test {

/// Options for `bounces` reflections without cache, by `samples` rays from a sensor.
inline RenderOptions indirect(int bounces, int samples) {
    RenderOptions options = TestScene::exact();
    options.ambient_bounces = bounces;
    options.ambient_accuracy = 0;
    options.ambient_divisions = samples;
    options.ambient_super_samples = 0;
    options.weight_limit = 1e-6;
    return options;
}

/// Irradiance at a sensor [W/m²], the mean of `times` of them.
inline Rgb irradiance_rgb(const TestScene& scene, const Vec3& point, const Vec3& normal,
                          std::uint32_t times = 1) {
    Silence warnings;
    TraceContext context(scene.tracer, warnings);
    std::array<double, 3> sum{};
    for (std::uint32_t i = 0; i < times; ++i) {
        const Rgb value =
            scene.tracer.irradiance(point, normal, RandomStream::of_pixel(3, i, 0, 0), context)
                .value;
        for (std::size_t c = 0; c < 3; ++c) sum[c] += static_cast<double>(value[c]) / times;
    }
    return {static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])};
}
inline double measured(const TestScene& scene, const Vec3& point, const Vec3& normal,
                       std::uint32_t times = 1) {
    return static_cast<double>(irradiance_rgb(scene, point, normal, times).g);
}

/// A polygon of a modifier in the scene language.
inline std::string polygon(const std::string& modifier, const std::string& name,
                           const std::vector<Vec3>& corners) {
    std::string text = modifier + " polygon " + name + " 0 0 " + std::to_string(3 * corners.size());
    for (const Vec3& c : corners)
        text += "  " + std::to_string(c.x) + ' ' + std::to_string(c.y) + ' ' + std::to_string(c.z);
    return text + '\n';
}

inline const std::string kBlack = "void plastic black 0 0 5 0 0 0 0 0\n";

}  // namespace lightwalk::test
