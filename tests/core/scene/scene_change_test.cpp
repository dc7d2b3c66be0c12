// A changed scene is the changed description, read anew: to the bit, with direct and with indirect
// light.
#include <doctest/doctest.h>

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/ambient/serial_cache.h"
#include "core/error.h"
#include "core/model/model_change.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const std::string kSun =
    "void light solar 0 0 3 6e6 6e6 5e6\nsolar source sun 0 0 4 .3 -.6 .7 .5\n";

/// A room with a window below a sun and a sky, a lamp, and materials of all kinds of traits.
const std::string kHouse = kSun + R"(
void brightfunc skyfunc 2 1+.3*Dz . 0 0
skyfunc glow sky 0 0 4 20 25 30 0
sky source up 0 0 4 0 0 1 180
skyfunc glow ground 0 0 4 5 4 3 0
ground source down 0 0 4 0 0 -1 180
void light lamp 0 0 3 40 36 30
void brightfunc stripes 2 if(sin(9*Px),1,.6) . 0 0
stripes plastic wall 0 0 5 .6 .5 .4 .02 .05
void plastic floor 0 0 5 .4 .4 .5 .04 .1
void alias ceiling floor
void glass pane 0 0 3 .9 .9 .9
void mirror glass_mirror 0 0 3 .9 .9 .9
floor polygon ground_floor 0 0 12  -4 -6 0  4 -6 0  4 6 0  -4 6 0
ceiling polygon top 0 0 12  -4 6 3  4 6 3  4 -6 3  -4 -6 3
wall polygon left 0 0 12  -4 -6 0  -4 6 0  -4 6 3  -4 -6 3
glass_mirror polygon right 0 0 12  4 6 0  4 -6 0  4 -6 3  4 6 3
pane polygon front 0 0 12  4 -6 0  -4 -6 0  -4 -6 3  4 -6 3
wall sphere ball 0 0 4 -1 2 .7 .7
lamp polygon panel 0 0 12  -1 -1 2.99  -1 1 2.99  1 1 2.99  1 -1 2.99
)";

std::shared_ptr<const Model> parsed(const std::string& text) {
    Silence warnings;
    return parse_scene(text, "house.rad", {LibraryPath(std::vector<std::string>{}), false},
                       warnings);
}

std::shared_ptr<const Scene> scene_of(const std::shared_ptr<const Model>& model) {
    Silence warnings;
    MemoryResources files;
    return std::make_shared<const Scene>(model, modifier_factory, files, warnings);
}

std::shared_ptr<const Scene> changed_scene(const std::shared_ptr<const Scene>& base,
                                           const ModelChange& change) {
    Silence warnings;
    MemoryResources files;
    return std::make_shared<const Scene>(base, change, modifier_factory, files, warnings);
}

std::vector<Rgb> traced(const Scene& scene, int bounces) {
    Silence warnings;
    RenderOptions options = TestScene::exact();
    options.ambient_bounces = bounces;
    options.ambient_accuracy = 0.2;
    options.ambient_divisions = 64;
    options.specular_samples = 1;
    Tracer tracer(scene, options, warnings);
    const SceneCube cube = scene.cube();
    SerialCache cache(ambient_limits(cube.origin, cube.size, options.ambient_accuracy,
                                     options.ambient_resolution));
    tracer.use_ambient_cache(&cache);
    TraceContext context(tracer, warnings);
    std::vector<Rgb> values;
    RandomStream random = RandomStream::of_pixel(1, 2, 3, 4);
    for (std::uint32_t i = 0; i < 300; ++i) {
        const auto next = [&] { return 2 * static_cast<double>(random.next()) - 1; };
        const Vec3 direction = normalize(Vec3{next(), next(), next()});
        Ray ray = tracer.primary({0, 0, 1.5}, direction, 0, RandomStream::of_pixel(7, i, 0, 0));
        tracer.trace(ray, context);
        values.push_back(ray.value);
    }
    return values;
}

std::size_t modifier_named(const std::vector<Primitive>& modifiers, const std::string& name) {
    for (std::size_t i = modifiers.size(); i-- > 0;)
        if (modifiers[i].name == name) return i;
    FAIL("no such modifier");
    return 0;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    REQUIRE(text.find(what) != std::string::npos);
    return text.replace(text.find(what), what.size(), by);
}

/// Each of the changed scenes is the expected one, which is another than before.
void check_equal(const std::vector<std::shared_ptr<const Scene>>& changed, const Scene& expected,
                 const Scene& before) {
    for (const int bounces : {0, 1}) {
        const std::vector<Rgb> wanted = traced(expected, bounces);
        CHECK_FALSE(wanted == traced(before, bounces));
        for (const auto& one : changed) CHECK(traced(*one, bounces) == wanted);
    }
}

}  // namespace

TEST_CASE("changed scenes: what rays find is what they find in the changed scene read anew") {
    const std::shared_ptr<const Scene> base = scene_of(parsed(kHouse));
    const ModelChange same = unchanged(base->model());
    CHECK(traced(*changed_scene(base, same), 1) == traced(*base, 1));
    const auto check = [&](const std::string& text, const std::function<void(ModelChange&)>& edit) {
        ModelChange change = same;
        edit(change);
        const auto changed = changed_scene(base, change);
        CHECK(&changed->geometry() == &base->geometry());
        // From a changed scene, too, and back.
        check_equal({changed, changed_scene(changed_scene(changed, same), change),
                     scene_of(changed_model(base->model(), change))},
                    *scene_of(parsed(text)), *base);
    };
    SUBCASE("the sun's direction") {
        check(replaced(kHouse, ".3 -.6 .7 .5", "-.4 -.5 .6 .5"), [](ModelChange& change) {
            change.sources[0].source.reals = {-.4, -.5, .6, .5};
        });
    }
    SUBCASE("the sky's brightness, by its pattern and by itself") {
        check(replaced(replaced(kHouse, "1+.3*Dz", "2+.1*Dx"), "20 25 30", "10 15 20"),
              [](ModelChange& change) {
                  const std::size_t pattern = modifier_named(change.modifiers, "skyfunc");
                  change.modifiers[pattern].strings[0] = "2+.1*Dx";
                  change.modifiers[modifier_named(change.modifiers, "sky")].reals = {10, 15, 20, 0};
              });
    }
    SUBCASE("a plastic's colour, also where others stand for it") {
        check(replaced(kHouse, ".4 .4 .5 .04 .1", ".7 .2 .1 0 0"), [](ModelChange& change) {
            change.modifiers[modifier_named(change.modifiers, "floor")].reals = {.7, .2, .1, 0, 0};
        });
    }
    SUBCASE("a pattern on a material") {
        check(replaced(kHouse, "sin(9*Px)", "sin(3*Py)"), [](ModelChange& change) {
            const std::size_t pattern = modifier_named(change.modifiers, "stripes");
            change.modifiers[pattern].strings[0] = "if(sin(3*Py),1,.6)";
        });
    }
    SUBCASE("no sun") {
        check(replaced(kHouse, kSun, ""),
              [](ModelChange& change) { change.sources.erase(change.sources.begin()); });
    }
}

TEST_CASE("changed scenes: a sun that was not there, by a modifier that was not there") {
    const std::string night = replaced(kHouse, kSun, "");
    const std::shared_ptr<const Scene> base = scene_of(parsed(night));
    ModelChange change = unchanged(base->model());
    const ModelChange day = unchanged(*parsed(kHouse));
    PlacedSource sun = day.sources[0];
    sun.source.modifier = static_cast<std::int32_t>(change.modifiers.size());
    change.modifiers.push_back(day.modifiers[0]);
    change.sources.insert(change.sources.begin(), sun);
    const auto changed = changed_scene(base, change);
    CHECK(&changed->geometry() == &base->geometry());
    check_equal({changed}, *scene_of(parsed(kHouse)), *base);
    CHECK(changed->model().modifiers.size() + 1 == changed->own_modifiers().size());
    CHECK(traced(*changed_scene(changed, unchanged(base->model())), 1) == traced(*base, 1));
}

TEST_CASE("changed scenes: what the search for hits decides is refused, and built as a whole") {
    const std::shared_ptr<const Scene> base = scene_of(parsed(kHouse));
    ModelChange change = unchanged(base->model());
    Primitive& wall = change.modifiers[modifier_named(change.modifiers, "wall")];
    wall.type = PrimitiveType::glass;
    wall.reals = {.8, .8, .9};
    CHECK_THROWS_AS(changed_scene(base, change), GeometryChange);
    check_equal({scene_of(changed_model(base->model(), change))},
                *scene_of(parsed(replaced(kHouse, "plastic wall 0 0 5 .6 .5 .4 .02 .05",
                                          "glass wall 0 0 3 .8 .8 .9"))),
                *base);
}

TEST_CASE("changed scenes: bad modifiers are told, and modifiers that do not come before") {
    const std::shared_ptr<const Scene> base = scene_of(parsed(kHouse));
    ModelChange change = unchanged(base->model());
    change.modifiers[modifier_named(change.modifiers, "floor")].reals.pop_back();
    CHECK_THROWS_AS(changed_scene(base, change), InputError);
    change = unchanged(base->model());
    const std::size_t floor = modifier_named(change.modifiers, "floor");
    change.modifiers[floor].modifier = static_cast<std::int32_t>(floor);
    CHECK_THROWS_AS(changed_scene(base, change), InputError);
    change = unchanged(base->model());
    change.sources[0].source.modifier = 1000;
    CHECK_THROWS_AS(changed_scene(base, change), InputError);
    change = unchanged(base->model());
    change.sources[0].source.reals.clear();
    CHECK_THROWS_AS(changed_scene(base, change), InputError);
}
