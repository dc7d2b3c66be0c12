// A walk whose scene changes under it: pictures and numbers are those of the changed scene.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/picture/picture.h"
#include "tests/apps/walk/steered_walk.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const std::string kPins =
    R"({"type":"probes","probes":[{"id":3,"position":[2,2,0],"normal":[0,0,1]}]})";

std::string time_of(const std::string& hour) {
    return R"({"type":"time","time":{"month":9,"day":21,"hour":)" + hour + R"(,"sky":""}})";
}

nlohmann::json last_of(const RecordedClients& clients, ClientId client, const std::string& type) {
    nlohmann::json found;
    for (const std::string& text : clients.texts.at(client)) {
        auto message = nlohmann::json::parse(text);
        if (message["type"] == type) found = std::move(message);
    }
    return found;
}

std::vector<Rgb> pixels_of(Walk& walk) {
    return read_hdr(walk.saved(), "saved").pixels;
}

/// A walk at rest, with a pin.
void rest(Walk& walk) {
    walk.inbox.message(kDriver, view_message(1, 0.25));
    walk.inbox.message(kDriver, kPins);
    walk.rest();
    walk.loop->step(walk.stop);
}

/// As many steps as it takes until nothing is left to be drawn.
void settle(Walk& walk) {
    walk.clients.frames[kDriver].clear();
    walk.acked[kDriver] = 0;
    walk.rest();
    walk.loop->step(walk.stop);
}

void check_same_walk(Walk& walk, Walk& expected) {
    CHECK(pixels_of(walk) == pixels_of(expected));
    const auto value = last_of(walk.clients, kDriver, "probes");
    const auto wanted = last_of(expected.clients, kDriver, "probes");
    CHECK(value["probes"] == wanted["probes"]);
}

}  // namespace

TEST_CASE("changed walk: at another hour it is the walk of the scene that names that hour") {
    const LoadedScene scene(room(sunlit("14.3"))), earlier(room(sunlit("9.5")));
    Walk walk(scene), expected(earlier);
    rest(walk);
    rest(expected);
    const std::vector<Rgb> before = pixels_of(walk);
    walk.inbox.message(kWatcher, time_of("9.5"));  // only the driver's counts
    CHECK(pixels_of(walk) == before);
    walk.inbox.message(kDriver, time_of("9.5"));
    settle(walk);
    CHECK_FALSE(pixels_of(walk) == before);
    check_same_walk(walk, expected);
    const auto told = last_of(walk.clients, kWatcher, "time");
    CHECK(told["time"]["hour"] == 9.5);
    CHECK(told["rise"].get<double>() < 8);
    CHECK(told["altitude"].get<double>() > 10);
    CHECK_FALSE(told.contains("problem"));
    CHECK(walk.saved("sky.rad").find("gensky 9 21 9.5000") != std::string::npos);
    // Back to what the files say.
    walk.inbox.message(kDriver, R"({"type":"time","time":null})");
    settle(walk);
    CHECK(pixels_of(walk) == before);
}

TEST_CASE("changed walk: while the hour is drawn pictures are small, then there is a whole one") {
    const LoadedScene scene(room(sunlit("14.3")));
    Walk walk(scene);
    rest(walk);
    const auto width = [&] {
        return number_at<std::uint16_t>(*walk.clients.frames[kDriver].back(), 12);
    };
    const int whole = width();
    for (const std::string hour : {"9", "10", "11", "12"}) {
        const std::size_t seen = walk.clients.frames_of(kDriver);
        walk.inbox.message(kDriver, time_of(hour));
        for (int i = 0; i < 100 && walk.clients.frames_of(kDriver) == seen; ++i) {
            walk.acknowledge(kDriver);
            walk.loop->step(walk.stop);
        }
        REQUIRE(walk.clients.frames_of(kDriver) > seen);
        CHECK(4 * width() == whole);
    }
    settle(walk);
    CHECK(width() == whole);
}

TEST_CASE("changed walk: night falls, also where there was no sun, and it is day again") {
    for (const std::string first : {"14.3", "2"}) {
        const LoadedScene scene(room(sunlit(first)));
        Walk walk(scene);
        rest(walk);
        for (const std::string hour : {"2", "9.5", "2", "14.3"}) {
            const LoadedScene other(room(sunlit(hour)));
            Walk expected(other);
            rest(expected);
            walk.inbox.message(kDriver, time_of(hour));
            settle(walk);
            check_same_walk(walk, expected);
        }
    }
}

TEST_CASE("changed walk: a modifier that is replaced, and the time beside it") {
    const LoadedScene scene(room(sunlit("14.3"))), other(room(sunlit("9.5", ".2 .6 .3")));
    Walk walk(scene), expected(other);
    rest(walk);
    rest(expected);
    walk.inbox.message(kDriver, time_of("9.5"));
    walk.loop->step(walk.stop);
    SceneState state = walk.loop->scene_state();
    const auto& modifiers = walk.renderer.backend().session().scene().own_modifiers();
    for (std::size_t i = 0; i < modifiers.size(); ++i) {
        if (modifiers[i].name != "grey") continue;
        Primitive green = modifiers[i];
        green.reals = {.2, .6, .3, 0, 0};
        state.replaced[static_cast<std::int32_t>(i)] = green;
    }
    REQUIRE(walk.loop->change_scene(state));
    settle(walk);
    check_same_walk(walk, expected);
    // What is wrong with it is told, and nothing changes.
    SceneState bad = state;
    bad.replaced.begin()->second.reals = {.2};
    CHECK_FALSE(walk.loop->change_scene(bad));
    CHECK_FALSE(walk.loop->change_problem().empty());
    bad = state;
    bad.replaced[1000] = state.replaced.begin()->second;
    CHECK_FALSE(walk.loop->change_scene(bad));
    check_same_walk(walk, expected);
}

TEST_CASE("changed walk: where no generator writes the sky its time is refused") {
    const LoadedScene scene(room());
    Walk walk(scene);
    rest(walk);
    CHECK_FALSE(walk.loop->time_place());
    const std::vector<Rgb> before = pixels_of(walk);
    walk.inbox.message(kDriver, time_of("9.5"));
    walk.loop->step(walk.stop);
    CHECK(walk.clients.got(kDriver, "time", "no generator writes"));
    CHECK(pixels_of(walk) == before);
    CHECK(walk.saved("sky.rad").find("no generator") != std::string::npos);
    const LoadedScene angles(
        room("!gensky -ang 40 20\nskyfunc glow g 0 0 4 1 1 1 0\ng source s 0 0 4 0 0 1 180\n"));
    Walk other(angles);
    REQUIRE(other.loop->time_place());
    CHECK(other.loop->time_place()->refused.find("gensky -ang") != std::string::npos);
}
