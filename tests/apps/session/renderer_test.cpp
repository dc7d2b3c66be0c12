#include "apps/session/lightwalk/renderer.h"

#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "apps/session/render_backend.h"
#include "core/error.h"
#include "tests/apps/session/room.h"
#include "tests/temporary_folder.h"

using namespace lightwalk;
using lightwalk::test::kLampRoom;
using lightwalk::test::task_at;
using lightwalk::test::TemporaryFolder;

namespace {

/// The same scene, built in code.
std::vector<ScenePrimitive> room_primitives() {
    return {{"void", "plastic", "grey", {}, {.5, .4, .3, .02, .1}},
            {"void", "light", "lamp", {}, {40, 40, 40}},
            {"grey", "polygon", "floor", {}, {-4, -6, 0, 4, -6, 0, 4, 6, 0, -4, 6, 0}},
            {"grey", "sphere", "ball", {}, {-1, 2, .7, .7}},
            {"lamp", "polygon", "panel", {}, {-1, -1, 2.99, -1, 1, 2.99, 1, 1, 2.99, 1, -1, 2.99}}};
}

SceneSource from_bytes(const std::string& bytes) {
    SceneSource source;
    source.bytes = bytes;
    source.threads = 2;
    return source;
}

RendererOptions two_threads() {
    RendererOptions options;
    options.threads = 2;
    options.light.ambient_value = {.1f, .1f, .1f};
    return options;
}

std::vector<Rgb> picture_of(const LoadedScene& scene, const RendererOptions& options) {
    Renderer renderer(scene, options);
    return renderer.finish(renderer.start(task_at(0)))->radiance;
}

std::string read_file_of(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

}  // namespace

TEST_CASE("renderer: files, text, primitives and frozen scenes give the same picture") {
    const TemporaryFolder folder;
    const std::string file = folder.write("room.rad", kLampRoom), frozen = folder.path("room.lwz");
    const std::vector<Rgb> expected = picture_of(LoadedScene({file}), two_threads());
    CHECK(expected.size() == 48 * 36);
    CHECK(picture_of(LoadedScene(from_bytes(kLampRoom)), two_threads()) == expected);
    SceneSource built;
    built.primitives = room_primitives();
    CHECK(picture_of(LoadedScene(built), two_threads()) == expected);
    SceneSource source;
    source.files = {file};
    freeze_scene(source, frozen);
    CHECK(picture_of(LoadedScene({frozen}), two_threads()) == expected);
    CHECK(picture_of(LoadedScene(from_bytes(read_file_of(frozen))), two_threads()) == expected);
}

TEST_CASE("renderer: what is wrong with a scene is an error that names file and line") {
    const TemporaryFolder folder;
    const std::string file = folder.write(
        "bad.rad", "void plastic grey\n0\n0\n3 .5 .5 .5\n\ngrey sphere a 0 0 4 0 0 0 1\n");
    std::string text;
    try {
        const LoadedScene scene({file});
    } catch (const InputError& error) {
        text = error.what();
    }
    CHECK(text.find(file + ":1: ") == 0);
    SceneSource named = from_bytes("void sphere s 0 0 4 0 0 0 1\nwood sphere t 0 0 4 0 0 0 1\n");
    named.name = "built";
    try {
        const LoadedScene scene(named);
        text.clear();
    } catch (const InputError& error) {
        text = error.what();
    }
    CHECK(text.find("built:2: undefined modifier \"wood\"") == 0);
    SceneSource both = from_bytes(kLampRoom);
    both.primitives = room_primitives();
    CHECK_THROWS_AS(LoadedScene{both}, InputError);
}

TEST_CASE("renderer: several scenes and renderers live in one process, on several threads") {
    const LoadedScene bright(from_bytes(kLampRoom));
    const LoadedScene dark(
        from_bytes("void plastic grey 0 0 5 .5 .5 .5 0 0\ngrey sphere a 0 0 4 0 0 1 1\n"));
    const std::vector<Rgb> expected = picture_of(bright, two_threads());
    const std::vector<Rgb> of_dark = picture_of(dark, two_threads());
    CHECK(expected != of_dark);
    std::vector<Rgb> first, second, third;
    std::thread one([&] { first = picture_of(bright, two_threads()); });
    std::thread two([&] { second = picture_of(dark, two_threads()); });
    third = picture_of(bright, two_threads());
    one.join();
    two.join();
    CHECK(first == expected);
    CHECK(second == of_dark);
    CHECK(third == expected);
}

TEST_CASE("renderer: a task that is polled goes on by itself, and gives the same picture") {
    const LoadedScene scene(from_bytes(kLampRoom));
    const std::vector<Rgb> expected = picture_of(scene, two_threads());
    Renderer renderer(scene, two_threads());
    const auto before = renderer.start(task_at(1));
    const auto ticket = renderer.start(task_at(0));
    while (renderer.poll(ticket).stage != RenderProgress::Stage::finished)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    CHECK(renderer.poll(ticket).done == 1);
    CHECK(renderer.poll(before).stage == RenderProgress::Stage::finished);
    CHECK(renderer.finish(ticket)->radiance == expected);
    CHECK(renderer.finish(before)->radiance != expected);
    CHECK_THROWS_AS((void)renderer.finish(ticket), std::invalid_argument);
}

TEST_CASE("renderer: cancelling ends what was started, from any thread, and nothing else") {
    const LoadedScene scene(from_bytes(kLampRoom));
    RendererOptions options = two_threads();
    options.pixels.samples = 16;
    std::atomic<bool> begun{false};
    std::vector<RenderProgress::Stage> stages;
    options.progress_interval = 0;
    options.progress = [&](const RenderProgress& progress) {
        stages.push_back(progress.stage);
        begun = true;
    };
    Renderer renderer(scene, options);
    const auto ticket = renderer.start(task_at(0, 1024, 768));
    const auto later = renderer.start(task_at(0, 1024, 768));
    std::thread other([&] {
        while (!begun) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        renderer.cancel();
    });
    CHECK_FALSE(renderer.finish(ticket));
    CHECK_FALSE(renderer.finish(later));
    other.join();
    CHECK(stages.back() == RenderProgress::Stage::cancelled);
    const auto fresh = renderer.finish(renderer.start(task_at(0)));
    REQUIRE(fresh);
    options.progress = {};
    CHECK(fresh->radiance == picture_of(scene, options));
    CHECK(stages.back() == RenderProgress::Stage::finished);
}

TEST_CASE(
    "renderer: until a picture is good all rays are told, those that fill the cache as well") {
    const LoadedScene scene(from_bytes(kLampRoom));
    for (const bool deterministic : {false, true}) {
        CAPTURE(deterministic);
        RendererOptions options = two_threads();
        options.light.ambient_bounces = 1;
        options.deterministic = deterministic;
        options.goal.error = .3;
        options.progress_interval = 0;
        std::vector<RenderProgress> told;
        options.progress = [&](const RenderProgress& progress) { told.push_back(progress); };
        Renderer renderer(scene, options);
        const auto picture = renderer.finish(renderer.start(task_at(0)));
        REQUIRE(picture);
        const std::uint64_t all = renderer.backend().statistics().rays.total();
        REQUIRE(told.size() > 2);
        CHECK(told.back().rays == all);
        CHECK(picture->rays == all);
        std::uint64_t before = 0;
        for (const RenderProgress& progress : told) {
            CHECK(progress.rays >= before);
            CHECK(progress.rays <= all);
            before = progress.rays;
        }
    }
}

TEST_CASE("renderer: lists of rays are one input, however it is divided") {
    const LoadedScene scene(from_bytes(kLampRoom));
    RendererOptions options = two_threads();
    options.light.source_jitter = 1;  // so that random numbers count
    std::vector<RayQuery> rays;
    for (int i = 0; i < 300; ++i) rays.push_back({{0, -5, 1.5}, {0.004 * i - 0.6, 1, -0.3}});
    rays.push_back({{0, 0, 1}, {0, 0, 0}});
    Renderer renderer(scene, options);
    const auto whole = renderer.finish(renderer.start(RayTask{rays, 0}));
    REQUIRE(whole);
    const auto first = renderer.start(RayTask{{rays.begin(), rays.begin() + 77}, 0});
    const auto rest = renderer.start(RayTask{{rays.begin() + 77, rays.end()}, 77});
    CHECK(renderer.finish(first)->bytes + renderer.finish(rest)->bytes == whole->bytes);
    const std::vector<RayResult> answers = whole->answers();
    REQUIRE(answers.size() == rays.size());
    CHECK(answers.back().distance == 1e10);
    CHECK(answers.back().radiance == Rgb());
    CHECK(answers[0].radiance.g > 0);
    CHECK(answers[0].distance < 10);
    CHECK(renderer.backend().statistics().rays.primary >= rays.size());
    CHECK_THROWS_AS((void)RayBytes{"abc"}.answers(), InputError);
}

TEST_CASE(
    "renderer: the first frame of a walk is the picture that is traced, later ones cost less") {
    const LoadedScene scene(from_bytes(kLampRoom));
    RendererOptions options = two_threads();
    options.pixels.spacing = 1;
    const std::vector<Rgb> expected = picture_of(scene, options);
    options.reuse = default_reuse();
    options.frames = 2;
    Renderer renderer(scene, options);
    const auto first = renderer.finish(renderer.start(task_at(0)));
    const auto second = renderer.finish(renderer.start(task_at(0.02)));
    CHECK(first->radiance == expected);
    CHECK(second->rays < first->rays / 2);
}

TEST_CASE(
    "renderer: warnings come to the one who opened it, and a picture without pixels is refused") {
    std::vector<std::string> messages;
    const LoadedScene scene(
        from_bytes("void plastic grey 0 0 5 .5 .5 .5 0 0\ngrey sphere a 0 0 4 0 0 1 1\n"));
    RendererOptions options = two_threads();
    options.warn = [&](const std::string& message) { messages.push_back(message); };
    options.ambient_file = "unused.amb";
    Renderer renderer(scene, options);
    REQUIRE(messages.size() == 1);
    CHECK(messages[0].find("ambient file") != std::string::npos);
    CHECK_THROWS_AS((void)renderer.start(task_at(0, 0, 5)), InputError);
    PictureTask blind = task_at(0);
    blind.view.direction = {0, 0, 0};
    CHECK_THROWS_AS((void)renderer.start(blind), InputError);
}
