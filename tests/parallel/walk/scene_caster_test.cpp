#include "parallel/walk/scene_caster.h"

#include <doctest/doctest.h>

#include <string>
#include <utility>
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
            caster.probe(places, {}, seen, 0);
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

TEST_CASE("patterns are told of where they are asked for: of probed pixels, and of traced points") {
    lightwalk::test::MemoryResources files;
    files.functions["boards.cal"] = "board = if(Px - 3, .25, 2);\n";
    TestScene room(R"(
void brightfunc boards 2 board boards.cal 0 0
boards plastic wood 0 0 5 .5 .5 .5 0 0
void glow sky 0 0 4 1 1 1 0
wood polygon wall 0 0 12  -90 40 -90  90 40 -90  90 40 90  -90 40 90
)",
                   TestScene::exact(), files);
    const VisibilityProbe visibility(room.tracer);
    const StopFlag stop;
    WorkerContexts contexts(room.tracer, room.warnings, 1);
    View ahead = view('v');
    ahead.horizontal = ahead.vertical = 90;
    FrameOptions options;
    options.width = options.height = 16;
    std::vector<PixelPlace> places;
    for (const int u : {0, 8})
        for (int y = 0; y < 8; ++y)
            for (int x = u; x < u + 8; ++x) places.push_back({x, y});
    SceneCaster caster(room.tracer, visibility, Camera(ahead), options, contexts, stop,
                       FrameUse::passing);
    std::vector<PixelVisibility> seen(places.size());
    std::vector<TracedPixel> traced(places.size());
    caster.trace(places, traced, 0, 0);
    std::size_t dark = 0;
    for (const int spacing : {1, 2, 4}) {
        caster.probe(places, {true, spacing}, seen, 0);
        for (std::size_t i = 0; i < places.size(); ++i) {
            REQUIRE(seen[i].ahead.seen);
            const float pattern = seen[i].ahead.position.x > 3 ? 0.25f : 2.0f;
            dark += pattern < 1 ? 1 : 0;
            REQUIRE(seen[i].ahead.pattern == pattern);
            REQUIRE(points_of(traced[i], 0.1).points[0].pattern == encode_pattern(pattern));
        }
        caster.probe(places, {false, spacing}, seen, 0);
        CHECK(seen[0].ahead.pattern == 1);
    }
    CHECK(dark > 0);
    CHECK(dark < 3 * places.size());
}

TEST_CASE("a pane or mirror with ripples shows in passing what an even one does, at its place") {
    lightwalk::test::MemoryResources files;
    files.functions["waves.cal"] = "small = .002*cos(9*Pz); large = .3*cos(9*Pz);\n";
    const auto seen_through = [&](const std::string& texture, const std::string& kind,
                                  FrameUse use) {
        TestScene room("void texfunc waves 4 " + texture + " " + texture + " 0 waves.cal 0\n" +
                           "0\nwaves " + kind + R"( pane 0 0 3 .9 .9 .9
void glow sky 0 0 4 1 1 1 0
sky bubble far 0 0 4 1 2 3 30
pane polygon window 0 0 12  -40 5 -40  40 5 -40  40 5 40  -40 5 40
)",
                       TestScene::exact(), files);
        const VisibilityProbe visibility(room.tracer);
        const StopFlag stop;
        WorkerContexts contexts(room.tracer, room.warnings, 1);
        View ahead = view('v');
        ahead.direction = {0, 1, 0};
        ahead.horizontal = ahead.vertical = 40;
        FrameOptions options;
        options.width = options.height = 8;
        SceneCaster caster(room.tracer, visibility, Camera(ahead), options, contexts, stop, use);
        const PixelPlace place{3, 3};
        PixelVisibility probed;
        TracedPixel traced;
        caster.probe({&place, 1}, {}, {&probed, 1}, 0);
        caster.trace({&place, 1}, {&traced, 1}, 0, 0);
        const PrimaryVisibility& image =
            kind == "mirror" ? traced.visibility.mirrored : traced.visibility.ahead;
        const PrimaryVisibility& check = kind == "mirror" ? probed.mirrored : probed.ahead;
        if (use != FrameUse::picture) CHECK(check.surface == image.surface);
        if (use != FrameUse::picture) CHECK(check.distance == image.distance);
        CHECK(probed.x == traced.visibility.x);
        CHECK((probed.x == 3.5f) == (use == FrameUse::passing));
        return std::pair(traced.distance, image.slope);
    };
    for (const char* kind : {"glass", "mirror"}) {
        CAPTURE(kind);
        const auto [exact, never] = seen_through("small", kind, FrameUse::picture);
        CHECK(exact < 4);
        CHECK(never >= kMirrorLike);
        const auto [passing, slope] = seen_through("small", kind, FrameUse::passing);
        CHECK(passing == doctest::Approx(30).epsilon(kind[0] == 'g' ? 0.001 : 0.3));
        CHECK(slope < 1);
        CHECK(seen_through("small", kind, FrameUse::resting).second < 1);
        CHECK(seen_through("large", kind, FrameUse::passing).second >= kMirrorLike);
    }
}
