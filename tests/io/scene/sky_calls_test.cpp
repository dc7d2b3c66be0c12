// A scene at another hour: what its generators write is the same as if the files named that hour.
#include "io/scene/sky_calls.h"

#include <doctest/doctest.h>

#include <string>

#include "core/error.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

LibraryPath no_library() {
    return LibraryPath(std::vector<std::string>{});
}

std::shared_ptr<const Model> model_of(const std::string& text) {
    Silence warnings;
    return parse_scene(text, "sky.rad", {no_library(), false}, warnings);
}

std::string house(const std::string& sky) {
    return "void plastic grey 0 0 5 .5 .5 .5 0 0\ngrey sphere ball 0 0 4 0 0 0 1\n!" + sky + R"(
skyfunc glow sky_glow 0 0 4 1 1 1 0
sky_glow source sky 0 0 4 0 0 1 180
grey sphere other 0 0 4 3 0 0 1
)";
}

/// Whether two models say the same.
void check_same(const Model& a, const Model& b) {
    REQUIRE(a.modifiers.size() == b.modifiers.size());
    for (std::size_t i = 0; i < a.modifiers.size(); ++i) {
        CHECK(a.modifiers[i].name == b.modifiers[i].name);
        CHECK(a.modifiers[i].type == b.modifiers[i].type);
        CHECK(a.modifiers[i].modifier == b.modifiers[i].modifier);
        CHECK(a.modifiers[i].strings == b.modifiers[i].strings);
        CHECK(a.modifiers[i].reals == b.modifiers[i].reals);
    }
    REQUIRE(a.surfaces.size() == b.surfaces.size());
    for (std::size_t i = 0; i < a.surfaces.size(); ++i) {
        CHECK(a.surfaces[i].name == b.surfaces[i].name);
        CHECK(a.surfaces.modifier(i) == b.surfaces.modifier(i));
        const RealArguments of_a = a.surfaces.reals(i), of_b = b.surfaces.reals(i);
        REQUIRE(of_a.size() == of_b.size());
        for (std::size_t k = 0; k < of_a.size(); ++k) CHECK(of_a[k] == of_b[k]);
    }
}

std::shared_ptr<const Model> at(const Model& model, const SkyTime& time) {
    ModelChange change = unchanged(model);
    SkyCalls(model, no_library()).apply(time, change);
    return changed_model(model, change);
}

}  // namespace

TEST_CASE("sky calls: a scene at another hour is the scene whose file names that hour") {
    const auto day = model_of(house("gensky 9 21 14.3 +s -a 46 -o -7 -m -15"));
    const SkyCalls calls(*day, no_library());
    CHECK(calls.refusal().empty());
    CHECK_FALSE(calls.empty());
    check_same(*at(*day, {6, 2, 9.5, ""}),
               *model_of(house("gensky 6 2 9.5 +s -a 46 -o -7 -m -15")));
    check_same(*at(*day, {6, 2, 9.5, "+i"}),
               *model_of(house("gensky 6 2 9.5 +i -a 46 -o -7 -m -15")));
    check_same(*at(*day, calls.first().time()), *day);
    const auto weather = model_of(house("gendaylit 6 21 12 -W 800 100"));
    check_same(*at(*weather, {6, 21, 16, ""}), *model_of(house("gendaylit 6 21 16 -W 800 100")));
    CHECK(calls.text({6, 2, 9.5, ""}).find("gensky 6 2 9.5000") != std::string::npos);
}

TEST_CASE("sky calls: at night there is no sun, and by day it is there, also after a night") {
    const std::string place = " +s -a 46 -o -7 -m -15";
    const auto day = model_of(house("gensky 9 21 14.3" + place));
    const auto night = model_of(house("gensky 9 21 2" + place));
    const auto darkened = at(*day, {9, 21, 2, ""});
    // The sun's modifier stays, and nothing has it.
    CHECK(darkened->modifiers.size() == day->modifiers.size());
    CHECK(darkened->surfaces.size() == night->surfaces.size());
    CHECK(night->modifiers.size() + 1 == day->modifiers.size());
    const auto lit = at(*night, {9, 21, 14.3, ""});
    REQUIRE(lit->surfaces.size() == day->surfaces.size());
    CHECK(lit->surfaces[1].name == "sun");
    const auto& solar = lit->modifiers[static_cast<std::size_t>(lit->surfaces.modifier(1))];
    CHECK(solar.name == "solar");
    CHECK(solar.reals == day->modifiers[1].reals);
}

TEST_CASE("sky calls: two skies follow one clock, each in its place") {
    const auto two = [](const std::string& hour) {
        return house("gensky 9 21 " + hour + " | xform -rz 30") +
               house("gensky 3 1 " + hour + " -a 10");
    };
    const auto model = model_of(two("12"));
    ModelChange change = unchanged(*model);
    const SkyCalls calls(*model, no_library());
    REQUIRE(calls.refusal().empty());
    calls.apply({3, 1, 10, ""}, change);
    std::string expected = two("10");
    expected.replace(expected.find("9 21"), 4, "3 1");
    check_same(*changed_model(*model, change), *model_of(expected));
}

TEST_CASE("sky calls: what cannot be changed is told, with its place") {
    const auto refusal = [](const std::string& text) {
        const auto model = model_of(text);
        return SkyCalls(*model, no_library()).refusal();
    };
    CHECK(refusal(house("gensky -ang 40 20")).find("sky.rad:3: gensky -ang") == 0);
    CHECK(refusal(house("gensky 1 1 12; genbox grey box 1 1 1")).find("sky.rad:3: ") == 0);
    CHECK(refusal(house("gensky 1 1 12 | xform -m grey")).find("sky.rad:3: ") == 0);
    CHECK(refusal(house("gensky 1 1 12")).empty());
    const auto none = model_of("void plastic grey 0 0 5 .5 .5 .5 0 0\ngrey sphere b 0 0 4 0 0 0 1");
    CHECK(SkyCalls(*none, no_library()).empty());
    CHECK(SkyCalls(*none, no_library()).refusal().empty());
}
