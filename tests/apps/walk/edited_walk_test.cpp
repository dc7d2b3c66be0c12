#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/picture/picture.h"
#include "tests/apps/walk/steered_walk.h"

using namespace lightwalk;
using namespace lightwalk::test;
using nlohmann::json;

namespace {

std::string painted_room(const std::string& ball = ".5 .5 .5 0 0",
                         const std::string& lamp = "40 40 40") {
    return "void plastic grey 0 0 5 .5 .5 .5 0 0\nvoid plastic paint 0 0 5 " + ball +
           "\nvoid light lamp 0 0 3 " + lamp + R"(
grey polygon floor 0 0 12  -4 -6 0  4 -6 0  4 6 0  -4 6 0
grey polygon back 0 0 12  -4 6 0  4 6 0  4 6 3  -4 6 3
paint sphere ball 0 0 4 -1 2 .7 .7
lamp polygon panel 0 0 12  -1 -1 2.99  -1 1 2.99  1 1 2.99  1 -1 2.99
)";
}

RendererOptions with_bounces(int ambient_bounces) {
    RendererOptions options = options_of(true);
    options.light.ambient_bounces = ambient_bounces;
    return options;
}

/// A walk at rest, in a scene that may be changed.
struct PaintedWalk : Walk {
    explicit PaintedWalk(const std::string& text, int ambient_bounces = 0, bool changes = true)
        : Walk(LoadedScene(room(text)), with_bounces(ambient_bounces), 30, changes) {
        inbox.message(kDriver, view_message(1, 0.25, 64, 48));
        rest();
    }
    void step() {
        loop->step(stop);
        for (const ClientId client : {kDriver, kWatcher}) acknowledge(client);
    }
    /// Until there is one more final picture.
    void rest() {
        const std::size_t before = clients.frames_of(kDriver);
        for (int i = 0; i < 2000; ++i) {
            step();
            if (clients.frames_of(kDriver) > before &&
                (frame_flags(*clients.frames[kDriver].back()) & 4) != 0)
                return;
        }
        FAIL("the view does not come to rest");
    }
    void edit(ClientId client, int id, const json& materials) {
        inbox.message(client, json{{"type", "edits"}, {"id", id}, {"materials", materials}}.dump());
    }
    /// The newest message of a type.
    json told(ClientId client, const std::string& type) {
        json newest;
        for (const std::string& text : clients.texts[client]) {
            const json message = json::parse(text);
            if (message["type"] == type) newest = message;
        }
        return newest;
    }
    std::vector<Rgb> pixels() { return read_hdr(saved(), "saved").pixels; }
};

json paint(double red, double specularity = 0) {
    return {{"name", "paint"},
            {"definition", 0},
            {"kind", "plastic"},
            {"reals", {red, .5, .5, specularity, 0}}};
}

json lamp(double red) {
    return {{"name", "lamp"}, {"definition", 0}, {"kind", "light"}, {"reals", {red, 40, 40}}};
}

}  // namespace

TEST_CASE("edited walk: the picture becomes that of the changed scene, and most points are kept") {
    PaintedWalk walk(painted_room());
    const std::vector<Rgb> built = walk.pixels();
    walk.edit(kDriver, 3, json::array({paint(.9)}));
    walk.rest();
    const json edited = walk.told(kWatcher, "edited");
    CHECK(edited["id"] == 3);
    CHECK(edited["refused"].empty());
    CHECK(edited["materials"] == json::array({paint(.9)}));
    CHECK(edited["kept"] > 0.8);
    CHECK(edited["kept"] < 1);
    PaintedWalk red(painted_room(".9 .5 .5 0 0"));
    CHECK(walk.pixels() == red.pixels());
    CHECK(walk.pixels() != built);
    // A reflection more than before, then all as it was.
    walk.edit(kDriver, 4, json::array({paint(.5, .1)}));
    walk.rest();
    PaintedWalk polished(painted_room(".5 .5 .5 .1 0"));
    CHECK(walk.pixels() == polished.pixels());
    walk.edit(kDriver, 5, json::array());
    walk.rest();
    CHECK(walk.pixels() == built);
}

TEST_CASE("edited walk: pictures after a change have the new colour where it belongs") {
    PaintedWalk walk(painted_room());
    const std::vector<Rgb> built = walk.pixels();
    PaintedWalk red(painted_room("1 .5 .5 0 0"));
    const std::vector<Rgb> expected = red.pixels();
    walk.edit(kDriver, 1, json::array({paint(1)}));
    std::size_t changed = 0, right = 0;
    // The first one, on a machine that has time for it; at once there is no old colour.
    for (int picture = 0; picture < 20 && right <= changed / 2; ++picture) {
        const std::size_t frames = walk.clients.frames_of(kDriver);
        for (int i = 0; i < 100 && walk.clients.frames_of(kDriver) == frames; ++i) walk.step();
        const std::vector<Rgb> shown = walk.pixels();
        REQUIRE(shown.size() == expected.size());
        // Of pixels at edges the rays of a picture at rest go elsewhere.
        std::size_t stale = 0;
        changed = right = 0;
        for (std::size_t i = 0; i < shown.size(); ++i) {
            if (!(expected[i].r > 1.5f * built[i].r)) continue;
            ++changed;
            right += std::abs(shown[i].r - expected[i].r) < 0.1f * expected[i].r ? 1 : 0;
            stale += std::abs(shown[i].r - built[i].r) < 0.1f * built[i].r ? 1 : 0;
        }
        CHECK(changed > 50);
        CHECK(stale < changed / 5);
    }
    CHECK(right > changed / 2);
}

TEST_CASE("edited walk: another lamp changes all light, and indirect light is calculated anew") {
    PaintedWalk walk(painted_room(), 1);
    walk.edit(kDriver, 1, json::array({lamp(80)}));
    walk.rest();
    CHECK(walk.told(kDriver, "edited")["kept"] == 0);
    PaintedWalk brighter(painted_room(".5 .5 .5 0 0", "80 40 40"), 1);
    const std::vector<Rgb> is = walk.pixels(), should = brighter.pixels();
    double sum = 0, expected = 0;
    for (std::size_t i = 0; i < is.size(); ++i) {
        sum += static_cast<double>(is[i].r);
        expected += static_cast<double>(should[i].r);
    }
    CHECK(sum == doctest::Approx(expected).epsilon(0.01));
}

TEST_CASE(
    "edited walk: only the driver changes materials, newcomers are told, and there is a file") {
    PaintedWalk walk(painted_room());
    walk.edit(kWatcher, 1, json::array({paint(.9)}));
    walk.step();
    CHECK_FALSE(walk.clients.got(kWatcher, "edited"));
    CHECK(walk.saved("materials.rad").find("plastic") == std::string::npos);
    walk.edit(kDriver, 2, json::array({paint(.9), lamp(-1)}));
    walk.step();
    const json edited = walk.told(kDriver, "edited");
    REQUIRE(edited["refused"].size() == 1);
    CHECK(edited["refused"][0]["name"] == "lamp");
    CHECK(edited["materials"].size() == 1);
    walk.inbox.message(ClientId{3}, hello("0123456789abcdef77"));
    CHECK(walk.clients.got(ClientId{3}, "edited", "\"paint\""));
    CHECK(walk.saved("materials.rad").find("0.9") != std::string::npos);
    walk.inbox.message(kWatcher, R"({"type":"material","id":8,"x":0.4,"y":0.45})");
    walk.step();
    const json material = walk.told(kWatcher, "material");
    CHECK(material["surface"] == "ball");
    CHECK(material["layers"][0]["reals"][0] == .9);
    CHECK(material["layers"][0]["built"][0] == .5);
}

TEST_CASE("edited walk: a scene that cannot be changed says so, and goes on as it is") {
    PaintedWalk walk(painted_room(), 0, false);
    walk.edit(kDriver, 2, json::array({paint(.9)}));
    walk.step();
    const json edited = walk.told(kDriver, "edited");
    CHECK(edited["materials"].empty());
    REQUIRE(edited["refused"].size() == 1);
    CHECK(edited["refused"][0]["why"] == "the scene cannot be changed here");
}
