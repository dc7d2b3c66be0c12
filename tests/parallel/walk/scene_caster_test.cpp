#include "parallel/walk/scene_caster.h"

#include <doctest/doctest.h>

#include <vector>

#include "tests/test_scene.h"

using namespace lightwalk;
using lightwalk::test::TestScene;

namespace {

View view(char type, double fore = 0, double aft = 0) {
    View v;
    v.type = type;
    v.position = {1, 2, 3};
    v.direction = {0.3, 2, -0.1};
    v.horizontal = v.vertical = type == 'l' ? 4 : 170;
    v.shift = 0.2;
    v.lift = -0.1;
    v.fore = fore;
    v.aft = aft;
    return v;
}

}  // namespace

TEST_CASE("the check looks along the rays of the pixels, to the bit, in every kind of view") {
    TestScene room("void plastic grey 0 0 5 .5 .5 .5 0 0\ngrey bubble room 0 0 4 0 0 0 20\n");
    const VisibilityProbe visibility(room.tracer);
    const StopFlag stop;
    WorkerContexts contexts(room.tracer, room.warnings, 1);
    FrameOptions options;
    options.width = 21;
    options.height = 13;
    std::vector<PixelPlace> places;
    for (int y = 0; y < options.height; ++y)
        for (int x = 0; x < options.width; ++x) places.push_back({x, y});
    // One memory for all: nothing of the view before may be left.
    std::vector<PixelVisibility> seen(places.size());
    long outside = 0;
    for (const View& v :
         {view('v'), view('h'), view('v', 0.5, 0.6), view('a'), view('l'), view('c'), view('s')}) {
        for (const double aperture : {0.0, 0.1}) {
            CAPTURE(v.type);
            CAPTURE(aperture);
            options.pixels.aperture = aperture;
            const Camera camera(v);
            const PixelRays rays(camera, nullptr, options.width, options.height, options.pixels,
                                 options.seed, options.step);
            SceneCaster caster(room.tracer, visibility, camera, options, contexts, stop);
            caster.probe(places, seen, 0);
            for (std::size_t i = 0; i < places.size(); ++i) {
                const PixelRay expected = rays(places[i].x, places[i].y);
                REQUIRE(seen[i].ray == expected.ray.has_value());
                outside += expected.ray ? 0 : 1;
                if (!expected.ray) continue;
                REQUIRE(seen[i].direction == expected.ray->direction);
                REQUIRE(seen[i].x == static_cast<float>(expected.h * options.width));
                REQUIRE(seen[i].y == static_cast<float>(expected.v * options.height));
                REQUIRE(seen[i].ahead.seen);
                // How far the room is tells the origin; aft planes cut it off.
                const auto far = static_cast<double>(seen[i].ahead.distance);
                const Vec3 end = expected.ray->origin + expected.ray->direction * far;
                if (v.aft > 0)
                    REQUIRE(far == kHuge);
                else
                    REQUIRE(length(end) == doctest::Approx(20).epsilon(1e-5));
            }
        }
    }
    CHECK(outside > 0);
}
