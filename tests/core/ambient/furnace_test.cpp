// The furnace: in a closed enclosure of one emission and one reflectance the light is known at
// every point.
#include <doctest/doctest.h>

#include <cmath>

#include "core/ambient/serial_cache.h"
#include "tests/test_scene.h"
#include "tests/tolerance.h"

namespace lightwalk::test {
namespace {

constexpr double kReflectance = 0.6;

/// Walls that glow 1 and reflect. A glow of radius 0 is no direct light; two coincident sheets
/// would be ambiguous, so the walls reflect, and a black-body sky of the same radiance shines
/// through a share of them.
RenderOptions furnace_options(int bounces, double accuracy) {
    RenderOptions options = TestScene::exact();
    options.ambient_bounces = bounces;
    options.ambient_accuracy = accuracy;
    options.ambient_divisions = 256;
    options.ambient_super_samples = 0;
    options.reflection_limit = -10;
    options.weight_limit = 1e-5;
    return options;
}

/// Each wall is a mixture of a glow (share 1 - r) and a white surface (share r): emission 1 - r,
/// reflectance r.
std::string furnace(const std::string& shape) {
    return "void glow hot 0 0 4 1 1 1 0\nvoid plastic white 0 0 5 1 1 1 0 0\n"
           "void mixfunc wall 4 white hot share wall.cal 0 0\nwall " +
           shape;
}

const std::string kSphere = "bubble s 0 0 4 0 0 0 2\n";
const std::string kBox =
    "polygon a 0 0 12 -1 -1 -1  1 -1 -1  1 1 -1  -1 1 -1\nwall polygon b 0 0 12 -1 -1 1  -1 1 1  1 "
    "1 1  1 -1 1\n"
    "wall polygon c 0 0 12 -1 -1 -1  -1 -1 1  1 -1 1  1 -1 -1\nwall polygon d 0 0 12 -1 1 -1  1 1 "
    "-1  1 1 1  -1 1 1\n"
    "wall polygon e 0 0 12 -1 -1 -1  -1 1 -1  -1 1 1  -1 -1 1\nwall polygon f 0 0 12 1 -1 -1  1 -1 "
    "1  1 1 1  1 1 -1\n";

/// L (1 - r^(N+1)) / (1 - r) for emission L = 1 - r.
double expected(int bounces) {
    return 1 - std::pow(kReflectance, bounces + 1);
}

const std::vector<Vec3> kDirections{
    {1, 0.1, 0.2}, {-0.3, 1, -0.9}, {0.5, 0.6, -1}, {-1, -1, 0.95}, {0.1, -0.2, 1}};

MemoryResources wall_share() {
    MemoryResources files;
    files.functions["wall.cal"] = "share = " + std::to_string(kReflectance) + ";";
    return files;
}

}  // namespace

TEST_CASE("furnace: N bounces without cache give L (1 - r^(N+1)) / (1 - r) everywhere") {
    for (const std::string& shape : {kSphere, kBox}) {
        for (int bounces = 0; bounces <= 3; ++bounces) {
            CAPTURE(bounces);
            TestScene scene(furnace(shape), furnace_options(bounces, 0), wall_share());
            for (const Vec3& direction : kDirections) {
                const Rgb value = scene.trace({0.1, 0.2, -0.1}, direction).value;
                // Every sample sees the same: the rest is what weights below 1e-5 leave out.
                CHECK(static_cast<double>(value.g) == within(1e-5, expected(bounces)));
            }
        }
    }
}

TEST_CASE("furnace: the cache adds at most the bounces that deeper values hold already") {
    for (const std::string& shape : {kSphere, kBox}) {
        for (int bounces = 1; bounces <= 3; ++bounces) {
            CAPTURE(bounces);
            TestScene scene(furnace(shape), furnace_options(bounces, 0.2), wall_share());
            const SceneCube cube = scene.scene.cube();
            SerialCache cache(ambient_limits(cube.origin, cube.size, 0.2, 32));
            scene.tracer.use_ambient_cache(&cache);
            for (const Vec3& direction : kDirections) {
                const auto value =
                    static_cast<double>(scene.trace({0.1, 0.2, -0.1}, direction).value.g);
                // One percent for the values' RGBE-like mantissas and what weights below 1e-5 leave
                // out.
                CHECK(value >= 0.99 * expected(bounces));
                CHECK(value <= 1.01);
            }
            CHECK(cache.size() > 0);
            scene.tracer.use_ambient_cache(nullptr);
        }
    }
}

}  // namespace lightwalk::test
