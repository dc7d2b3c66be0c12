#include "parallel/walk/first_light.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/cloud/progressive_light.h"
#include "core/light/find_light_groups.h"
#include "parallel/frame.h"
#include "tests/one_thread.h"
#include "tests/parallel/room_view.h"
#include "tests/test_scene.h"
#include "tests/tolerance.h"

namespace lightwalk::test {
namespace {

constexpr int kDraftWidth = 24, kDraftHeight = 18;
constexpr double kWallReflectance = 0.6;
// Of the light that is added, which is less than what is found: gradients by some hundred rays.
constexpr double kSlopes = 0.08;
constexpr double kNoTime = 1e-9, kAllTime = 100;  // [s]

/// A closed room whose walls glow 1 - r, as no light source does, and reflect r.
const std::string kFurnace = R"(
void glow hot 0 0 4 1 1 1 0
void plastic white 0 0 5 1 1 1 0 0
void mixfunc wall 4 white hot share wall.cal 0 0
wall polygon a 0 0 12 -8 -8 -8  8 -8 -8  8 8 -8  -8 8 -8
wall polygon b 0 0 12 -8 -8 8  -8 8 8  8 8 8  8 -8 8
wall polygon c 0 0 12 -8 -8 -8  -8 -8 8  8 -8 8  8 -8 -8
wall polygon d 0 0 12 -8 8 -8  8 8 -8  8 8 8  -8 8 8
wall polygon e 0 0 12 -8 -8 -8  -8 8 -8  -8 8 8  -8 -8 8
wall polygon f 0 0 12 8 -8 -8  8 -8 8  8 8 8  8 8 -8
)";

/// Two lamps in a room with a ball and a mirror.
const std::string kLampRoom = R"(
void plastic grey 0 0 5 .5 .5 .5 0 0
void plastic red 0 0 5 .6 .1 .1 .02 .1
void mirror silver 0 0 3 .8 .8 .8
void light ceiling_lamp 0 0 3 20 20 20
void light desk_lamp 0 0 3 300 200 100
grey polygon floor 0 0 12  -4 -8 -1  4 -8 -1  4 6 -1  -4 6 -1
grey polygon ceiling 0 0 12  -4 6 4  4 6 4  4 -8 4  -4 -8 4
grey polygon back 0 0 12  -4 6 -1  4 6 -1  4 6 4  -4 6 4
red polygon right 0 0 12  4 6 -1  4 -8 -1  4 -8 4  4 6 4
silver polygon left 0 0 12  -4 -8 -1  -4 6 -1  -4 6 4  -4 -8 4
grey sphere ball 0 0 4 0 0 0 1
ceiling_lamp polygon panel 0 0 12  -1 -1 3.99  -1 1 3.99  1 1 3.99  1 -1 3.99
desk_lamp sphere bulb 0 0 4 2 2 1 .1
)";

/// Without a cache: what a pixel gets depends on nothing else.
RenderOptions draft_test_options(int bounces, float constant, double accuracy = 0) {
    RenderOptions options = TestScene::exact();
    options.ambient_bounces = bounces;
    options.ambient_value = Rgb::grey(constant);
    options.ambient_accuracy = accuracy;
    options.ambient_divisions = 1024;
    options.ambient_super_samples = 0;
    return options;
}

MemoryResources wall_of_furnace() {
    MemoryResources files;
    files.functions["wall.cal"] = "share = " + std::to_string(kWallReflectance) + ";";
    return files;
}

struct Drafted {
    explicit Drafted(const std::string& text, float constant = 0, bool groups = false,
                     int scale = 1)
        : room(text, draft_test_options(1, constant), wall_of_furnace()),
          direct(room.scene, draft_test_options(0, constant), room.warnings) {
        options.width = scale * kDraftWidth;
        options.height = scale * kDraftHeight;
        options.pixels.spacing = 1;
        if (groups)
            of_lamps = std::make_shared<const LightGroups>(
                find_light_groups(room.scene, room.tracer.options(), {}));
        light = std::make_unique<FirstLight>(room.tracer, direct, of_lamps, 2);
    }
    ViewDraft step(double seconds) {
        return light->step(room_view(), options, seconds, *executor, stop);
    }
    /// By rough values: those of the picture are not kept.
    const DraftLight& rough(double seconds = kAllTime) {
        for (int i = 0; i < 100000; ++i) {
            const ViewDraft made = step(seconds);
            if (!made.last) continue;
            REQUIRE(made.best != nullptr);
            CHECK(made.best->whole());
            return *made.best;
        }
        FAIL("it does not end");
        return *step(seconds).best;
    }
    /// Rows from the bottom.
    std::vector<Rgb> rendered(const Tracer& tracer) {
        WorkerContexts contexts(tracer, room.warnings, 2);
        const Frame frame = render_frame(tracer, Camera(room_view()), options, *executor, contexts,
                                         stop, [](const FrameProgress&) {});
        return turned_rows(std::span<const Rgb>(frame.radiance), options.width);
    }

    TestScene room;
    Tracer direct;
    FrameOptions options;
    std::unique_ptr<Executor> executor = make_executor(ExecutorKind::threads, 2);
    StopFlag stop;
    std::shared_ptr<const LightGroups> of_lamps;
    std::unique_ptr<FirstLight> light;
};

/// In the furnace: what walls send back of what they get.
double expected_of_furnace(double constant) {
    const double r = kWallReflectance;
    return r * (1 - r) + r * r * constant - r * constant;
}

}  // namespace

TEST_CASE("a draft in a furnace: what the first bounce sends in place of the constant, anywhere") {
    for (const float constant : {0.0f, 0.3f}) {
        CAPTURE(constant);
        Drafted furnace(kFurnace, constant);
        for (const Rgb& added : furnace.rough().added())  // all rays of a hemisphere see the same
            CHECK(static_cast<double>(added.g) ==
                  within(kSlopes, expected_of_furnace(static_cast<double>(constant))));
    }
}

TEST_CASE("a draft may be made of the picture's own values, which are there then") {
    Drafted furnace(kFurnace);
    const RenderOptions options = draft_test_options(1, 0, 0.2);
    const SceneCube cube = furnace.room.scene.cube();
    ConcurrentCache cache(ambient_limits(cube.origin, cube.size, options.ambient_accuracy,
                                         options.ambient_resolution));
    Tracer exact(furnace.room.scene, options, furnace.room.warnings);
    exact.use_ambient_cache(&cache);
    DraftLight draft(exact, furnace.direct, nullptr, 2);
    CHECK(draft.aim(room_view(), furnace.options));
    CHECK_FALSE(draft.whole());
    for (int i = 0; i < 3 && !draft.whole(); ++i) {
        draft.step(kAllTime, *furnace.executor, furnace.stop);
        CHECK(draft.usable());
    }
    CHECK(draft.whole());
    CHECK(cache.size() > 0);
    CHECK_FALSE(draft.aim(room_view(), furnace.options));
    for (const Rgb& added : draft.added())
        CHECK(static_cast<double>(added.g) == within(kSlopes, expected_of_furnace(0)));
}

TEST_CASE("a draft is near what indirect light adds" * about_numbers) {
    Drafted room(kLampRoom, 0, false, 2);
    const DraftLight& draft = room.rough();
    const std::vector<Rgb> direct = room.rendered(room.direct);
    const std::vector<Rgb> exact = room.rendered(room.room.tracer);
    double error = 0, without = 0, far = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        const auto all = static_cast<double>(brightness(exact[i]));
        const auto part = static_cast<double>(brightness(direct[i]));
        const double off = part + static_cast<double>(brightness(draft.added()[i])) - all;
        error += std::abs(off) / all;
        without += std::abs(part - all) / all;
        far += std::abs(off) > 0.1 * all ? 1 : 0;
    }
    const auto pixels = static_cast<double>(exact.size());
    CAPTURE(far / pixels);
    CHECK(without / pixels > 0.2);
    CHECK(error / pixels < 0.08);  // 128 rays a value, interpolated with -aa .2
    CHECK(far / pixels < 0.15);
}

TEST_CASE("a draft is added to what is shown, and makes no pixel black that is guessed too dark") {
    constexpr float kConstant = 2;  // more than the light that there is
    for (const bool furnace : {true, false}) {
        Drafted room(furnace ? kFurnace : kLampRoom, kConstant);
        const DraftLight& draft = room.rough();
        const std::vector<Rgb> direct = room.rendered(room.direct);
        const auto shown = [&](float share) {
            std::vector<Rgb> pixels;
            for (const Rgb& pixel : direct) pixels.push_back(share * pixel);
            pixels = turned_rows(std::span<const Rgb>(pixels), room.options.width);
            draft.add_to(pixels);
            return turned_rows(std::span<const Rgb>(pixels), room.options.width);
        };
        const std::vector<Rgb> seen = shown(1), darker = shown(.05f);
        std::size_t less = 0, same = 0;
        for (std::size_t i = 0; i < direct.size(); ++i) {
            const float sum = direct[i].g + draft.added()[i].g;
            same += std::abs(seen[i].g - sum) <= 1e-4f * sum ? 1 : 0;
            less += .05f * direct[i].g + draft.added()[i].g < 0 ? 1 : 0;
            CHECK(darker[i].g > .001f * direct[i].g);
        }
        CHECK(less > direct.size() / 2);  // would be black
        // In the lamp room one pixel in four has a draft that is itself guessed.
        CHECK(same >= (furnace ? direct.size() : direct.size() * 7 / 10));
    }
}

TEST_CASE("a draft that has no time is made bit by bit, and is usable for all pixels at once") {
    Drafted room(kFurnace);
    const ViewDraft nothing = room.step(kNoTime);
    CHECK(nothing.best == nullptr);
    CHECK_FALSE(nothing.last);
    ViewDraft made;
    for (int i = 0; i < 100000 && made.best == nullptr; ++i) made = room.step(kNoTime);
    REQUIRE(made.best != nullptr);
    CHECK_FALSE(made.last);
    for (const Rgb& added : made.best->added())
        CHECK(static_cast<double>(added.g) == within(kSlopes, expected_of_furnace(0)));
    int steps = 0, off = 0;  // also while it is mended, of pixels that lack values as well
    for (; !made.last && steps < 100000; ++steps) {
        made = room.step(kNoTime);
        REQUIRE(made.best != nullptr);
        for (const Rgb& added : made.best->added())
            off += static_cast<double>(added.g) == within(kSlopes, expected_of_furnace(0)) ? 0 : 1;
    }
    CHECK(made.last);
    CHECK(off == 0);
    CHECK(steps > 10);
}

TEST_CASE("what light groups add to a draft is all of it, and follows their dimmers") {
    Drafted room(kLampRoom, 0, true);
    REQUIRE(room.of_lamps->size() == 2);
    const DraftLight& draft = room.rough();
    const std::vector<Rgb> whole(draft.added().begin(), draft.added().end());
    for (std::size_t i = 0; i < whole.size(); ++i) {
        const Rgb sum = draft.groups()[2 * i] + draft.groups()[2 * i + 1];
        CHECK(sum.r == doctest::Approx(whole[i].r).epsilon(1e-3));
    }
    room.light->mix({{Rgb::grey(0.5f), Rgb::grey(0.5f)}});
    for (std::size_t i = 0; i < whole.size(); ++i)
        CHECK(draft.added()[i].r == doctest::Approx(0.5f * whole[i].r).epsilon(1e-3));
}

}  // namespace lightwalk::test
