#include "apps/walk/render_loop.h"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/picture/picture.h"
#include "tests/apps/walk/steered_walk.h"

using namespace lightwalk;
using namespace lightwalk::test;

TEST_CASE("render loop: a view that rests becomes the picture that is rendered of it") {
    const LoadedScene scene(room());
    Walk walk(scene);
    walk.inbox.message(kDriver, view_message(1, 0.25));
    walk.rest();
    CHECK(number_at<std::uint32_t>(*walk.clients.frames[kDriver].back(), 8) == 1);
    CHECK(walk.clients.frames_of(kWatcher) > 0);
    CHECK(walk.clients.got(kWatcher, "view"));
    CHECK_FALSE(walk.clients.got(kDriver, "view"));
    const ViewRequest wanted = std::get<ViewRequest>(parse_walk_request(view_message(1, 0.25)));
    Renderer renderer(scene, options_of(false));
    PictureTask task;
    task.view = wanted.view;
    task.width = wanted.width;
    task.height = wanted.height;
    const auto expected = renderer.finish(renderer.start(task));
    const Picture saved = read_hdr(walk.saved(), "saved");
    REQUIRE(saved.pixels.size() == expected->radiance.size());
    const Picture written =
        read_hdr(encode_hdr({task.width, task.height, expected->radiance}, {}), "written");
    CHECK(saved.pixels == written.pixels);
}

TEST_CASE("render loop: watchers are told what the driver sees, where frames show more than that") {
    const LoadedScene scene(room());
    Walk walk(scene);
    std::string message = view_message(1, 0.25);
    const std::string seen = R"("seen":{"type":"v","position":[0.5,0,0.5],"direction":[0,1,0],)"
                             R"("up":[0,0,1],"horizontal":33,"vertical":25},)";
    message.insert(1, seen);
    walk.inbox.message(kDriver, message);
    walk.rest();
    CHECK(walk.clients.got(kWatcher, "view", "\"seen\""));
    // Who comes back after a moment finds what was seen.
    walk.inbox.closed(kDriver);
    walk.inbox.message(kDriver,
                       hello("0123456789abcde" + std::to_string(static_cast<int>(kDriver))));
    CHECK(walk.clients.got(kDriver, "welcome", "\"horizontal\":33"));
}

TEST_CASE("render loop: before there is a picture questions and files are refused") {
    const LoadedScene scene(room());
    Walk walk(scene);
    walk.inbox.message(kWatcher, R"({"type":"pick","id":7,"x":0.5,"y":0.5})");
    unsigned status = 0;
    walk.inbox.save("/save/picture.hdr", WebReply([&](const WebAnswer& a) { status = a.status; }));
    walk.loop->step(walk.stop);
    CHECK(walk.clients.got(kWatcher, "refused", "there is no picture yet"));
    CHECK(status == 503);
    CHECK(walk.clients.frames_of(kDriver) == 0);
}

TEST_CASE("render loop: light is told where somebody points, and at pins") {
    const LoadedScene scene(room());
    Walk walk(scene);
    walk.inbox.message(kDriver, view_message(1, 0));
    walk.inbox.message(
        kDriver, R"({"type":"probes","probes":[{"id":3,"position":[0,0,0],"normal":[0,0,1]}]})");
    walk.rest();
    walk.inbox.message(kWatcher, R"({"type":"pick","id":7,"x":0.5,"y":0.2})");
    walk.inbox.message(kWatcher, R"({"type":"rectangle","id":8,"rect":[0,0,1,1]})");
    walk.loop->step(walk.stop);
    CHECK(walk.clients.got(kWatcher, "picked", "\"material\":\"grey\""));
    CHECK(walk.clients.got(kWatcher, "mean", "\"pixels\":768"));
    CHECK(walk.clients.got(kWatcher, "probes", "\"id\":3"));
}

TEST_CASE(
    "render loop: the plan of a place is drawn beside frames, once, and told to whoever asks") {
    const LoadedScene scene(room());
    Walk walk(scene);
    const auto ask = [&](ClientId client, int id) {
        walk.inbox.message(client, R"({"type":"plan","id":)" + std::to_string(id) + "}");
    };
    const auto steps_until = [&](ClientId client, int id) {
        const std::string mark = "\"id\":" + std::to_string(id) + ",";
        for (int i = 1; i < 100; ++i) {
            walk.loop->step(walk.stop);
            if (walk.clients.got(client, "plan", mark)) return i;
        }
        FAIL("no plan comes");
        return 0;
    };
    ask(kWatcher, 1);
    walk.loop->step(walk.stop);
    CHECK(walk.clients.got(kWatcher, "refused", "there is no picture yet"));
    walk.inbox.message(kDriver, view_message(1, 0.25));
    walk.rest();
    ask(kWatcher, 2);
    ask(kWatcher, 3);
    ask(kDriver, 4);
    CHECK(steps_until(kWatcher, 3) > 1);
    CHECK_FALSE(walk.clients.got(kWatcher, "plan", "\"id\":2,"));
    CHECK(walk.clients.got(kDriver, "plan", "\"id\":4,"));
    const int flags = frame_flags(*walk.clients.frames[kDriver].back());
    CHECK((flags & 4) != 0);  // the picture was done, and still is
    ask(kDriver, 5);
    CHECK(steps_until(kDriver, 5) == 1);
}

TEST_CASE(
    "render loop: illuminances of planes are measured beside the frames, for each client the "
    "newest one") {
    const LoadedScene scene(room());
    Walk walk(scene);
    const auto ask = [&](ClientId client, int id, const std::string& plane) {
        walk.inbox.message(client, R"({"type":"isolux","id":)" + std::to_string(id) +
                                       R"(,"position":[0,-4,1.5],)" + plane + "}");
    };
    const std::string level = R"("height":0.75)", in_air = R"("normal":[0,0,1])";
    const auto told = [&](ClientId client, int id) {
        std::vector<nlohmann::json> messages;
        for (const std::string& text : walk.clients.texts[client]) {
            const auto message = nlohmann::json::parse(text);
            if (message["type"] == "isolux" && message["id"] == id) messages.push_back(message);
        }
        return messages;
    };
    const auto steps_until_done = [&](ClientId client, int id) {
        for (int i = 1; i < 1000; ++i) {
            walk.loop->step(walk.stop);
            const auto messages = told(client, id);
            if (!messages.empty() && messages.back()["done"] == 1) return i;
        }
        FAIL("no isolux comes");
        return 0;
    };
    ask(kWatcher, 1, level);
    walk.loop->step(walk.stop);
    CHECK(walk.clients.got(kWatcher, "refused", "there is no picture yet"));
    walk.inbox.message(kDriver, view_message(1, 0.25));
    walk.rest();
    for (int id = 2; id < 50; ++id) ask(kWatcher, id, level);
    ask(kDriver, 60, in_air);
    ask(kWatcher, 61, level);
    CHECK(steps_until_done(kWatcher, 61) > 3);  // a part of it beside each frame
    CHECK_FALSE(walk.clients.got(kWatcher, "isolux", "\"id\":49,"));
    const auto messages = told(kWatcher, 61);
    CHECK(messages.back()["columns"].get<int>() >= 31);
    CHECK(messages.back()["rows"] == 48);
    const auto nothing = told(kDriver, 60);
    REQUIRE(nothing.size() == 1);
    CHECK(nothing.back()["columns"] == 0);
    // Who has left is not answered.
    ask(kWatcher, 70, level);
    walk.inbox.closed(kWatcher);
    for (int i = 0; i < 5; ++i) walk.loop->step(walk.stop);
    CHECK(told(kWatcher, 70).empty());
}

TEST_CASE("render loop: while the eye moves all time is for its frames") {
    const LoadedScene scene(room());
    Walk walk(scene);
    walk.inbox.message(kDriver, view_message(1, 0));
    walk.rest();
    walk.inbox.message(kDriver, R"({"type":"isolux","id":5,"position":[0,-4,1.5],"height":0.75})");
    for (int i = 0; i < 20; ++i) {
        std::string view = view_message(2 + i, 0.01 * i);
        view.replace(view.find("\"moving\":false"), 14, "\"moving\":true");
        walk.inbox.message(kDriver, view);
        walk.loop->step(walk.stop);
        walk.acknowledge(kDriver);
    }
    CHECK_FALSE(walk.clients.got(kDriver, "isolux"));
    walk.inbox.message(kDriver, view_message(40, 0.3));
    for (int i = 0; i < 100 && !walk.clients.got(kDriver, "isolux", "\"columns\":3"); ++i) {
        walk.loop->step(walk.stop);
        walk.acknowledge(kDriver);
    }
    CHECK(walk.clients.got(kDriver, "isolux", "\"columns\":3"));
}

TEST_CASE("render loop: a view that moves is shown at once, and the eye walks on the ground") {
    const LoadedScene scene(room());
    Walk walk(scene);
    CHECK(walk.loop->eye_height() == doctest::Approx(1.5));
    walk.inbox.message(kDriver, view_message(1, 0));
    walk.rest();
    std::string walking = view_message(2, 0.5);
    walking.replace(walking.find("-4,1.5]"), 7, "-4,1.2]");
    walking.replace(walking.find("\"walk\":false"), 12, "\"walk\":true");
    walk.inbox.message(kDriver, walking);
    const std::size_t before = walk.clients.frames_of(kDriver);
    walk.loop->step(walk.stop);
    REQUIRE(walk.clients.frames_of(kDriver) == before + 1);
    const std::string& frame = *walk.clients.frames[kDriver].back();
    CHECK(number_at<std::uint32_t>(frame, 8) == 2);
    CHECK(number_at<double>(frame, 40) == doctest::Approx(1.5));
}

TEST_CASE(
    "render loop: what cannot be drawn in time while a view moves is drawn smaller, and whole once "
    "it rests") {
    const LoadedScene scene(room());
    Walk walk(scene, 1e6);  // frames a second: no time at all
    walk.inbox.message(kDriver, view_message(1, 0, 320, 240));
    const auto width = [&] {
        return number_at<std::uint16_t>(*walk.clients.frames[kDriver].back(), 12);
    };
    const std::uint16_t whole = 320;
    for (int i = 0; i < 100 && (i == 0 || width() < whole); ++i) {  // sketches come first
        walk.loop->step(walk.stop);
        walk.acknowledge(kDriver);
    }
    REQUIRE(width() == whole);
    const auto move = [&](int id, double turned, bool moving) {
        std::string view = view_message(id, turned, 320, 240);
        if (moving) view.replace(view.find("\"moving\":false"), 14, "\"moving\":true");
        walk.inbox.message(kDriver, view);
        walk.loop->step(walk.stop);
        walk.acknowledge(kDriver);
    };
    for (int i = 0; i < 12; ++i) move(2 + i, i % 2 == 0 ? 0.25 : -0.25, true);
    CHECK(width() < whole);
    CHECK(width() > whole / 3);
    move(20, 0.1, false);
    CHECK(width() == whole);
}

TEST_CASE("render loop: a place that is new is drawn small first, one nearby is whole at once") {
    const LoadedScene scene(room());
    Walk walk(scene);
    const auto first_width = [&](int id, double turned) {
        walk.inbox.message(kDriver, view_message(id, turned, 320, 240));
        walk.loop->step(walk.stop);
        const auto width = number_at<std::uint16_t>(*walk.clients.frames[kDriver].back(), 12);
        walk.acknowledge(kDriver);
        walk.rest();
        CHECK(number_at<std::uint16_t>(*walk.clients.frames[kDriver].back(), 12) == 320);
        return width;
    };
    CHECK(first_width(1, 0) < 320);
    CHECK(first_width(2, 0.1) == 320);
    CHECK(first_width(3, 3) < 320);
}

TEST_CASE(
    "render loop: dimmers change pictures, pins and files at once, and only the driver's do") {
    std::string scaled_text = kRoom;
    const std::string lamp = "light lamp 0 0 3 40 40 40";
    scaled_text.replace(scaled_text.find(lamp), lamp.size(), "light lamp 0 0 3 20 10 20");
    const LoadedScene scene(room()), scaled_scene(room(scaled_text));
    Walk walk(scene, 30, true), scaled(scaled_scene);
    const std::string pins =
        R"({"type":"probes","probes":[{"id":3,"position":[0,0,0],"normal":[0,0,1]}]})";
    for (Walk* one : {&walk, &scaled}) {
        one->inbox.message(kDriver, view_message(1, 0.25));
        one->inbox.message(kDriver, pins);
        one->rest();
        one->loop->step(one->stop);
    }
    const auto lights = [](double level) {
        return R"({"type":"lights","levels":[{"name":"lamp","level":)" + std::to_string(level) +
               R"(,"rgb":[1,0.5,1]},{"name":"gone","level":0,"rgb":[1,1,1]}]})";
    };
    const std::string nominal = walk.saved();
    walk.inbox.message(kWatcher, lights(0.1));
    CHECK(walk.saved() == nominal);
    // A slow machine may have sent another one meanwhile: who has not drawn it gets none.
    for (const ClientId client : {kDriver, kWatcher}) walk.acknowledge(client);
    const std::size_t frames = walk.clients.frames_of(kDriver);
    walk.clients.texts.clear();
    walk.inbox.message(kDriver, lights(0.5));
    walk.loop->step(walk.stop);  // one step: what is known is mixed anew
    CHECK(walk.clients.frames_of(kDriver) == frames + 1);
    CHECK(walk.clients.got(kWatcher, "lights", "\"level\":0.5"));
    CHECK_FALSE(walk.clients.got(kDriver, "lights"));
    CHECK(walk.clients.got(kDriver, "probes", "\"id\":3"));
    const Picture dimmed = read_hdr(walk.saved(), "dimmed");
    const Picture expected = read_hdr(scaled.saved(), "expected");
    REQUIRE(dimmed.pixels.size() == expected.pixels.size());
    constexpr float kStep = 1.0f / 128;  // of RGBE
    for (std::size_t i = 0; i < dimmed.pixels.size(); ++i) {
        const Rgb off = dimmed.pixels[i] - expected.pixels[i];
        REQUIRE(std::max(max_component(off), -min_component(off)) <=
                kStep * max_component(expected.pixels[i]));
    }
    const std::string file = walk.saved("lights.rad");
    CHECK(file.find("void light lamp") != std::string::npos);
    CHECK(file.find("20 10 20") != std::string::npos);
    CHECK(scaled.saved("lights.rad").find("may be dimmed") != std::string::npos);
    walk.inbox.message(kWatcher, R"({"type":"take"})");
    walk.inbox.message(ClientId{9}, hello("0123456789abcdef99"));
    CHECK(walk.clients.got(ClientId{9}, "lights", "\"level\":0.5"));
}
