#include "apps/walk/dimmed_lights.h"

#include <doctest/doctest.h>

#include <array>
#include <string>

#include "core/light/find_light_groups.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const std::string kLamps = R"(
void brightfunc pattern 2 0.5 . 0 0
pattern light desk 0 0 3 10 20 30
void alias shelf desk
void glow sky 0 0 4 1 2 3 0
void plastic grey 0 0 5 .5 .5 .5 0 0
desk sphere a 0 0 4 0 0 0 .1
shelf sphere b 0 0 4 1 0 0 .1
grey sphere c 0 0 4 2 0 0 .1
sky source d 0 0 4 0 0 1 360
)";

}  // namespace

TEST_CASE(
    "dimmed lights: the file has the scaled modifiers, and gives their light when it is read") {
    const TestScene scene(kLamps);
    const LightGroups groups = find_light_groups(scene.scene, {}, {});
    Silence warnings;
    const auto model = parse_scene(kLamps, "lamps.rad",
                                   {LibraryPath(std::vector<std::string>{}), false}, warnings);
    const auto file = [&](const LightsRequest& lights) {
        return scaled_lights(model->modifiers, groups, mixture_of(lights, groups));
    };
    CHECK(file({}).find(" light ") == std::string::npos);
    const LightsRequest lights{{{"shelf", 0.5, {1, 2, 1}}, {"sky", 2, {1, 1, 0.5f}}}};
    const std::string text = file(lights);
    CHECK(text.find("pattern light shelf") != std::string::npos);
    CHECK(text.find("5 20 15") != std::string::npos);
    CHECK(text.find("2 4 3 0") != std::string::npos);
    CHECK(text.find("light desk") == std::string::npos);
    CHECK(text.find("grey") == std::string::npos);
}

TEST_CASE("dimmed lights: where nothing is dimmed light is as it is, to the bit") {
    LightGroups groups;
    groups.names = {"desk", "sky"};
    CHECK(mixture_of({}, groups).levels.empty());
    CHECK(mixture_of({{{"desk", 1, {1, 1, 1}}, {"gone", 0, {1, 1, 1}}}}, groups).levels.empty());
    const LightMixture mixture = mixture_of({{{"sky", 2, {1, 0.5f, 0}}}}, groups);
    REQUIRE(mixture.levels.size() == 2);
    CHECK(mixture.levels[0] == Rgb{1, 1, 1});
    CHECK(mixture.levels[1] == Rgb{2, 1, 0});
    CHECK(mixture({7, 7, 7}, std::array{Rgb{1, 1, 1}, Rgb{1, 1, 1}}) == Rgb{3, 2, 1});
}
