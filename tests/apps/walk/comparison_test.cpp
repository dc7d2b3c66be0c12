// A second state of a walk's scene beside it: what it shows, who may see it, and that the walk goes
// on.
#include "apps/walk/comparison.h"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/picture/picture.h"
#include "tests/apps/walk/steered_walk.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

constexpr ClientId kBeside{7}, kStranger{8};
const std::string kDriversSession = "0123456789abcde1", kWatchersSession = "0123456789abcde2";

std::string hour_message(const std::string& hour) {
    return R"({"type":"time","time":{"month":9,"day":21,"hour":)" + hour + R"(,"sky":""}})";
}

std::string green_message(int id) {
    return R"({"type":"edits","id":)" + std::to_string(id) +
           R"(,"materials":[{"name":"grey","definition":0,"kind":"plastic","reals":[0.2,0.6,0.3,0,0]}]})";
}

std::string hello_beside(const std::string& session = kDriversSession) {
    return R"({"type":"hello","session":")" + session + R"(","beside":true})";
}

std::vector<Rgb> decoded(const std::string& hdr) {
    return read_hdr(hdr, "saved").pixels;
}

/// A walk at rest, and who may see another scene beside it.
struct ComparedWalk {
    /// @param other  text of the other scene; "": there is none
    explicit ComparedWalk(const LoadedScene& scene, const std::string& other = "") : walk(scene) {
        reception.attach(walk.clients);
        ComparisonOptions options;
        options.loop = {30, 1, "lightwalk walk"};
        options.request.options = options_of(true);
        options.home.position = {0, -4, 1.5};
        if (!other.empty()) {
            options.request.source = room(other);
            options.scene = "other.rad";
        }
        comparison.emplace(
            std::move(options), reception, WelcomeReply{}, *walk.loop, walk.screen,
            [this]() -> const SceneSession& { return walk.renderer.backend().session(); },
            *walk.executor, walk.warnings);
        walk.inbox.message(kDriver, view_message(1, 0.25));
        settle();
    }
    void acknowledge(ClientId client) {
        if (walk.clients.frames_of(client) == acked[client]) return;
        acked[client] = walk.clients.frames_of(client);
        reception.message(
            client, R"({"type":"ack","frame":)" +
                        std::to_string(frame_number(*walk.clients.frames[client].back())) + "}");
    }
    [[nodiscard]] bool is_final(ClientId client) {
        return walk.clients.frames_of(client) > 0 &&
               (frame_flags(*walk.clients.frames[client].back()) & 4) != 0;
    }
    void step() {
        comparison->step(walk.stop);
        for (const ClientId client : {kDriver, kWatcher}) acknowledge(client);
        if (reception.beside()) acknowledge(kBeside);
    }
    /// Until both are as good as they get.
    void settle() {
        step();
        for (int i = 0; i < 4000; ++i) {
            step();
            const bool compares = reception.beside() != nullptr;
            if (is_final(kDriver) && (!compares || is_final(kBeside))) return;
        }
        FAIL("the views do not come to rest");
    }
    void compare() {
        reception.message(kBeside, hello_beside());
        settle();
    }
    /// After messages that change what there is to be seen: no frame of before counts.
    void settle_anew() {
        walk.clients.frames.clear();
        acked.clear();
        settle();
    }
    [[nodiscard]] std::string saved(const std::string& path) {
        std::string bytes;
        reception.save(path, WebReply([&](const WebAnswer& answer) { bytes = answer.bytes; }));
        comparison->step(walk.stop);
        return bytes;
    }
    [[nodiscard]] std::vector<Rgb> of_a() { return decoded(saved("/save/picture.hdr")); }
    [[nodiscard]] std::vector<Rgb> of_b() { return decoded(saved("/save/beside/picture.hdr")); }

    Walk walk;
    WalkReception reception{walk.inbox};
    std::map<ClientId, std::size_t> acked;
    std::optional<Comparison> comparison;
};

std::vector<Rgb> picture_of_scene(const std::string& text) {
    const LoadedScene scene(room(text));
    Walk walk(scene);
    walk.inbox.message(kDriver, view_message(1, 0.25));
    walk.rest();
    return decoded(walk.saved());
}

}  // namespace

TEST_CASE("comparison: the scene beside begins as the walk's is, and its changes are its own") {
    const LoadedScene scene(room(sunlit("14.3")));
    ComparedWalk both(scene);
    both.walk.inbox.message(kDriver, hour_message("9.5"));
    both.settle_anew();
    const std::vector<Rgb> before = both.of_a();
    both.compare();
    CHECK(both.of_b() == before);
    CHECK(both.walk.clients.got(kBeside, "welcome", "\"driver\":true"));
    CHECK(both.walk.clients.got(kBeside, "loaded", "\"latitude\""));
    CHECK(both.walk.clients.got(kBeside, "time", "\"hour\":9.5"));
    CHECK(both.walk.clients.got(kBeside, "view"));
    both.reception.message(kBeside, hour_message("12"));
    both.reception.message(kBeside, green_message(3));
    both.settle_anew();
    CHECK(both.of_a() == before);
    CHECK(both.of_b() == picture_of_scene(sunlit("12", ".2 .6 .3")));
    CHECK(both.saved("/save/beside/sky.rad").find("gensky 9 21 12.0000") != std::string::npos);
    CHECK(both.saved("/save/beside/materials.rad").find("grey") != std::string::npos);
    CHECK(both.saved("/save/materials.rad").find("grey") == std::string::npos);
}

TEST_CASE("comparison: it goes where the walk goes, and looks as it does") {
    const LoadedScene scene(room(sunlit("14.3")));
    ComparedWalk both(scene);
    both.compare();
    both.reception.message(kBeside, view_message(9, 3));  // not for it to say
    both.walk.inbox.message(kDriver, view_message(2, 0.75));
    both.settle_anew();
    CHECK(both.of_b() == both.of_a());
    // Its exposure is that of the walk's, whose light is another one.
    both.walk.inbox.message(kDriver, hour_message("7"));
    both.settle_anew();
    CHECK_FALSE(both.of_b() == both.of_a());
    const auto exposure = [&](ClientId client) {
        return number_at<float>(*both.walk.clients.frames[client].back(), 20);
    };
    for (int i = 0; i < 50 && exposure(kBeside) != exposure(kDriver); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        both.step();
    }
    CHECK(exposure(kBeside) == exposure(kDriver));
}

TEST_CASE("comparison: it is there for who drives, once, and while that one drives") {
    const LoadedScene scene(room(sunlit("14.3")));
    ComparedWalk both(scene);
    CHECK_THROWS_AS(both.reception.message(kStranger, hello_beside(kWatchersSession)), InputError);
    CHECK_FALSE(both.reception.beside());
    both.compare();
    CHECK_THROWS_AS(both.reception.message(kStranger, hello_beside()), InputError);
    CHECK_THROWS_AS(both.reception.message(kBeside, "{\"type\":\"nonsense\"}"), InputError);
    both.reception.message(kDriver, R"({"type":"hand","to":2})");
    CHECK(both.walk.clients.closed.contains(kBeside));
    CHECK_FALSE(both.reception.beside());
    both.comparison->step(both.walk.stop);
    // Who drives now may, until their connection ends.
    both.reception.message(kStranger, hello_beside(kWatchersSession));
    REQUIRE(both.reception.beside());
    both.comparison->step(both.walk.stop);
    both.reception.closed(kWatcher);
    CHECK(both.walk.clients.closed.contains(kStranger));
    both.reception.closed(kStranger);
    CHECK_FALSE(both.reception.beside());
    both.comparison.reset();
    both.reception.message(kDriver, R"({"type":"take"})");
    CHECK_THROWS_WITH_AS(both.reception.message(kBeside, hello_beside()), "the scene is read again",
                         InputError);
}

TEST_CASE("comparison: who leaves it leaves the walk as it was") {
    const LoadedScene scene(room(sunlit("14.3")));
    ComparedWalk both(scene);
    const std::vector<Rgb> before = both.of_a();
    for (int i = 0; i < 3; ++i) {
        both.reception.message(kBeside, hello_beside());
        both.comparison->step(both.walk.stop);
        if (i == 1) both.settle();
        both.reception.message(kBeside, hour_message("9.5"));
        both.comparison->step(both.walk.stop);
        both.reception.closed(kBeside);
        both.walk.clients.frames.erase(kBeside);
        both.acked.erase(kBeside);
        both.comparison->step(both.walk.stop);
    }
    CHECK(both.of_a() == before);
    CHECK_THROWS_AS(both.saved("/save/beside/sky.rad"), InputError);
}

TEST_CASE(
    "comparison: another scene is seen from the same eye, and what is wrong with it is told") {
    const LoadedScene scene(room(sunlit("14.3")));
    ComparedWalk both(scene, sunlit("9.5", ".7 .2 .2"));
    both.walk.inbox.message(kDriver, green_message(1));  // which is not for the other one
    both.settle_anew();
    both.compare();
    CHECK(both.of_b() == picture_of_scene(sunlit("9.5", ".7 .2 .2")));
    ComparedWalk wrong(scene, "void nonsense x 0 0 0\n");
    wrong.reception.message(kBeside, hello_beside());
    for (int i = 0; i < 500 && !wrong.walk.clients.got(kBeside, "failed"); ++i) {
        wrong.comparison->step(wrong.walk.stop);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    CHECK(wrong.walk.clients.got(kBeside, "failed", "nonsense"));
    wrong.reception.message(kBeside, R"({"type":"pick","id":7,"x":0.5,"y":0.5})");
    wrong.comparison->step(wrong.walk.stop);
    CHECK(wrong.walk.clients.got(kBeside, "refused"));
}

TEST_CASE("comparison: while the eye moves both are drawn") {
    const LoadedScene scene(room(sunlit("14.3")));
    ComparedWalk both(scene);
    both.compare();
    const std::size_t a = both.walk.clients.frames_of(kDriver),
                      b = both.walk.clients.frames_of(kBeside);
    constexpr int kViews = 20;
    for (int k = 0; k < kViews; ++k) {
        std::string moving = view_message(10 + k, 0.3 + 0.01 * k);
        moving.replace(moving.find("\"moving\":false"), 14, "\"moving\":true");
        both.walk.inbox.message(kDriver, moving);
        both.step();
    }
    CHECK(both.walk.clients.frames_of(kDriver) >= a + kViews / 2);
    CHECK(both.walk.clients.frames_of(kBeside) >= b + kViews / 2);
}
