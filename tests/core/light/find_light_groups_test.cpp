#include "core/light/find_light_groups.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "core/error.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using lightwalk::test::TestScene;

namespace {

const std::string kLights = R"(
void light solar 0 0 3 900 900 900
solar source s 0 0 4 .3 .2 1 .5
void glow sky_glow 0 0 4 1 1 1 0
sky_glow source up 0 0 4 0 0 1 180
void glow ground_glow 0 0 4 .1 .1 .1 0
ground_glow source down 0 0 4 0 0 -1 180
void light lamp_1 0 0 3 5 5 5
lamp_1 sphere l1 0 0 4 0 0 3 .2
void alias lamp_2 lamp_1
lamp_2 sphere l2 0 0 4 1 0 3 .2
void plastic paint 0 0 5 .5 .5 .5 0 0
paint sphere ball 0 0 4 3 3 1 .5
void glow ember 0 0 4 1 .1 0 0
void mixfunc half 4 ember paint .5 . 0 0
half sphere coal 0 0 4 3 0 1 .1
void illum window 1 void 0 3 2 2 2
window polygon w 0 0 12 -3 2 .5 -1 2 .5 -1 2 2 -3 2 2
half texfunc smooth 4 0 0 0 . 0 0
smooth sphere spark 0 0 4 3 1 1 .1
lamp_1 brightfunc ribbed 2 1 . 0 0
ribbed sphere l3 0 0 4 2 0 3 .2
void light unused 0 0 3 1 1 1
)";

LightGroups found(const std::vector<LightGroupPattern>& wanted, const Rgb& ambient = {}) {
    const TestScene scene(kLights);
    RenderOptions light;
    light.ambient_value = ambient;
    return find_light_groups(scene.scene, light, wanted);
}

/// The group of the modifier of that name.
std::string group_of(const std::string& name, const std::vector<LightGroupPattern>& wanted) {
    const TestScene scene(kLights);
    const LightGroups groups = find_light_groups(scene.scene, {}, wanted);
    for (std::size_t i = 0; i < scene.scene.modifier_count(); ++i) {
        const ModifierId id{static_cast<std::int32_t>(i)};
        if (scene.scene.modifier(id).name == name) return groups.names[groups.group_of(id)];
    }
    return "";
}

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("the usual light groups are the sun, the sky with the ground, and each other modifier") {
    CHECK(found({}).names == Names{"sun", "sky", "lamp_1", "lamp_2", "half", "window"});
    CHECK(found({}, {.1f, .1f, .1f}).names.back() == "rest");
    CHECK(group_of("solar", {}) == "sun");
    CHECK(group_of("sky_glow", {}) == "sky");
    CHECK(group_of("ground_glow", {}) == "sky");
    CHECK(group_of("smooth", {}) == "half");
    CHECK(group_of("ribbed", {}) == "lamp_1");
}

TEST_CASE("a modifier belongs to the first light group that names it, else to the rest") {
    const std::vector<LightGroupPattern> wanted{{"one", {"lamp_1"}}, {"all", {"lamp_*", "win??w"}}};
    CHECK(found(wanted).names == Names{"one", "all", "rest"});
    CHECK(group_of("lamp_1", wanted) == "one");
    CHECK(group_of("lamp_2", wanted) == "all");
    CHECK(group_of("window", wanted) == "all");
    CHECK(group_of("half", wanted) == "rest");
    CHECK(group_of("ribbed", wanted) == "one");
    CHECK(group_of("ribbed", {{"one", {"rib*"}}}) == "one");
    CHECK(group_of("solar", wanted) == "rest");
    CHECK(found({{"every", {"*"}}}).names == Names{"every"});
}

TEST_CASE("light groups that cannot be are refused, with a reason") {
    const auto refused = [](const std::vector<LightGroupPattern>& wanted, const char* why) {
        CHECK_THROWS_WITH_AS((void)found(wanted), doctest::Contains(why), InputError);
    };
    refused({{"a", {"lamp"}}}, "\"a\": nothing that emits light has such a modifier; there is ");
    refused({{"a", {"lamp"}}}, "half lamp_1 lamp_2 sky_glow solar window");
    refused({{"a", {"paint"}}}, "nothing that emits light");
    refused({{"a", {"unused"}}}, "nothing that emits light");
    refused({{"a", {"lamp_1"}}, {"b", {"lamp_1"}}}, "\"b\": nothing");
    refused({{"a", {"lamp_1"}}, {"a", {"lamp_2"}}}, "twice");
    refused({{"", {"lamp_1"}}}, "needs a name");
    refused({{"a", {}}}, "needs a name and a pattern");
    refused({{"a/b", {"lamp_1"}}}, "without / and blanks");
    refused({{"rest", {"lamp_1"}}}, "choose another name");
    std::vector<LightGroupPattern> many;
    for (int i = 0; i < 64; ++i) many.push_back({"g" + std::to_string(i), {"*"}});
    refused(many, "more than 63");
}

TEST_CASE("more lamps than there may be light groups have to be gathered") {
    std::string scene;
    for (int i = 0; i < 65; ++i) {
        const std::string n = std::to_string(i);
        scene += "void light lamp" + n + " 0 0 3 1 1 1\nlamp" + n + " sphere s" + n + " 0 0 4 " +
                 n + " 0 0 .1\n";
    }
    const TestScene lamps(scene);
    CHECK_THROWS_WITH_AS((void)find_light_groups(lamps.scene, {}, {}),
                         doctest::Contains("more than 64 light groups: gather"), InputError);
    CHECK(find_light_groups(lamps.scene, {}, {{"lamps", {"lamp*"}}}).size() == 1);
}
