// Shadow rays to surfaces that coincide with others find what the nearest hit is.
#include <doctest/doctest.h>

#include <array>
#include <vector>

#include "tests/core/geometry/geometry_scenes.h"

using namespace lightwalk;
using namespace lightwalk::test;

TEST_CASE("a light is visible where the nearest hit is on it, whatever coincides with it") {
    int found[3] = {};
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        Random random(seed);
        TestModels scene = random_models(seed, 6);
        const Vec3 normal = random.direction(), x = perpendicular(normal), y = cross(normal, x);
        const auto pile = [&](std::size_t model, int count) {
            constexpr std::array<double, 8> kSteps{0,    1e-12, 1e-9,   4e-7,
                                                   8e-7, 1e-6,  1.3e-6, 2.1e-6};
            for (int i = 0; i < count; ++i) {
                const Vec3 at =
                    normal *
                    (random.below(2) == 0 ? kSteps[static_cast<std::size_t>(random.below(8))] : 0);
                std::vector<double> reals;
                for (const Vec3& p : {at - x - y, at + x - y, at + x + y, at - x + y})
                    reals.insert(reals.end(), {p.x, p.y, p.z});
                scene.add(surface(PrimitiveType::polygon, reals, random.below(3), kOpaque), model);
            }
        };
        const auto first = static_cast<int>(scene.models[0].surfaces.size());
        const int count = 1 + random.below(4);
        pile(0, count);
        if (random.below(3) == 0) pile(2, 1);  // model 2 is also placed as it is
        const BuiltGeometry geometry = scene.build();
        for (int i = 0; i < 200; ++i) {
            const Vec3 origin = random.below(20) == 0 ? random.in_box(4e6) : random.in_box(4);
            const Vec3 to = x * random.uniform(-1, 1) + y * random.uniform(-1, 1);
            const RaySegment ray{origin, normalize(to - origin)};
            for (int light = first; light < first + count; ++light) {
                const Hit on_light = geometry.intersect_surface(SurfaceId{light}, ray);
                if (!on_light.exists()) continue;
                const Visibility v =
                    geometry.visibility({ray.origin, ray.direction, on_light.t}, SurfaceId{light});
                const Hit seen = geometry.intersect(ray);
                ++found[static_cast<int>(v)];
                if (v == Visibility::clear) {
                    // Surfaces without material may be met first.
                    const bool is_void =
                        seen.modifier == kVoid ||
                        test_traits()[seen.modifier].shadow == ShadowClass::ignored;
                    REQUIRE(
                        (is_void || (seen.surface == SurfaceId{light} && seen.instance == kWorld)));
                } else if (v == Visibility::blocked) {
                    REQUIRE_FALSE((seen.surface == SurfaceId{light} && seen.instance == kWorld));
                }
            }
        }
    }
    for (const int n : found) CHECK(n > 100);
}
