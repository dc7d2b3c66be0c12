#include "core/model/argument_names.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/test_scene.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

Primitive primitive_of(PrimitiveType type, std::vector<double> reals) {
    Primitive primitive;
    primitive.type = type;
    primitive.name = "m";
    primitive.reals = std::move(reals);
    return primitive;
}

std::string names_in_words(const Primitive& primitive) {
    std::string words;
    for (const ArgumentName& name : argument_names(primitive)) {
        words += words.empty() ? "" : ", ";
        words += name.quantity;
        if (!name.channel.empty()) words += ' ' + std::string(name.channel);
    }
    return words;
}

/// Materials with names for their numbers, as scene files have them.
const std::vector<Primitive>& named() {
    using enum PrimitiveType;
    static const std::vector<Primitive> all{
        primitive_of(plastic, {.1, .2, .3, .04, .05}),
        primitive_of(metal, {.1, .2, .3, .9, .05}),
        primitive_of(trans, {.1, .2, .3, .04, .05, .6, .7}),
        primitive_of(plastic2, {.1, .2, .3, .04, .05, .1}),
        primitive_of(metal2, {.1, .2, .3, .9, .05, .1}),
        primitive_of(trans2, {.1, .2, .3, .04, .05, .1, .6, .7}),
        primitive_of(light, {10, 20, 30}),
        primitive_of(illum, {10, 20, 30}),
        primitive_of(glow, {10, 20, 30, 0}),
        primitive_of(spotlight, {10, 20, 30, 40, 0, 0, -1}),
        primitive_of(mirror, {.9, .8, .7}),
        primitive_of(glass, {.9, .8, .7}),
        primitive_of(glass, {.9, .8, .7, 1.4}),
        primitive_of(dielectric, {.9, .8, .7, 1.4, 0}),
        primitive_of(interface, {.9, .8, .7, 1.4, 1, 1, 1, 1}),
        primitive_of(ashik2, {.1, .2, .3, .1, .1, .1, 100, 10}),
        primitive_of(mist, {.1, .1, .1, .5, .5, .5, .2}),
    };
    return all;
}

}  // namespace

TEST_CASE("argument names: each number of a material has a name") {
    CHECK(names_in_words(named()[0]) ==
          "reflectance red, reflectance green, reflectance blue, specularity, roughness");
    CHECK(names_in_words(named()[5]) ==
          "colour red, colour green, colour blue, specularity, roughness along, roughness across, "
          "transmissivity, transmitted specularity");
    CHECK(names_in_words(named()[9]) ==
          "radiance red, radiance green, radiance blue, cone angle, direction x, direction y, "
          "direction z");
    CHECK(names_in_words(named()[12]) ==
          "transmissivity red, transmissivity green, transmissivity blue, refractive index");
    for (const Primitive& primitive : named()) {
        CAPTURE(std::string(to_string(primitive.type)));
        CHECK(argument_names(primitive).size() == primitive.reals.size());
        CHECK_FALSE(argument_problem(primitive, primitive.reals));
    }
    CHECK(argument_names(primitive_of(PrimitiveType::plastic, {1, 2})).empty());
    CHECK(argument_names(primitive_of(PrimitiveType::brtdfunc, {1, 2, 3})).empty());
    CHECK(argument_problem(primitive_of(PrimitiveType::brightfunc, {1}), std::vector{1.0}) ==
          "the numbers of a brightfunc cannot be changed here");
}

TEST_CASE("argument names: what no scene could have is refused in words") {
    const double none = std::numeric_limits<double>::quiet_NaN();
    for (const Primitive& primitive : named()) {
        CAPTURE(std::string(to_string(primitive.type)));
        const std::vector<ArgumentName> names = argument_names(primitive);
        for (std::size_t i = 0; i < names.size(); ++i) {
            CAPTURE(i);
            std::vector<double> reals = primitive.reals;
            for (const double value : {none, std::numeric_limits<double>::infinity(),
                                       names[i].high * 1.01 + 1, names[i].low - 1}) {
                reals[i] = value;
                const std::optional<std::string> problem = argument_problem(primitive, reals);
                REQUIRE(problem);
                CHECK(problem->find(names[i].quantity) != std::string::npos);
            }
        }
        CHECK(argument_problem(primitive, std::vector{0.5}));
    }
    const Primitive& wall = named()[0];
    CHECK(argument_problem(wall, std::vector{.1, 1.5, .3, .04, .05}) ==
          "reflectance (green) must be from 0 to 1");
    CHECK(argument_problem(named()[9], std::vector{1.0, 1.0, 1.0, 90.0, 0.0, 0.0, 0.0}) ==
          "direction must not be 0 0 0");
    // What the scene has already is no reason to refuse the other numbers.
    const Primitive bright = primitive_of(PrimitiveType::plastic, {1.2, .2, .3, 0, 0});
    CHECK_FALSE(argument_problem(bright, std::vector{1.2, .9, .3, 0.0, 0.0}));
    CHECK(argument_problem(bright, std::vector{1.3, .9, .3, 0.0, 0.0}));
}

TEST_CASE("argument names: scenes accept whatever is not refused") {
    for (const Primitive& primitive : named()) {
        CAPTURE(std::string(to_string(primitive.type)));
        const std::vector<ArgumentName> names = argument_names(primitive);
        for (const bool upper : {false, true}) {
            std::string text = "void " + std::string(to_string(primitive.type)) + " m ";
            text += primitive.type == PrimitiveType::plastic2 ||
                            primitive.type == PrimitiveType::metal2 ||
                            primitive.type == PrimitiveType::trans2 ||
                            primitive.type == PrimitiveType::ashik2
                        ? "4 1 0 0 ."
                        : "0";
            text += " 0 " + std::to_string(names.size());
            for (const ArgumentName& name : names)
                text += ' ' + std::to_string(upper ? name.high : name.low);
            if (!upper && primitive.type == PrimitiveType::spotlight) continue;  // no direction
            text += "\nm sphere s 0 0 4 0 0 0 1\n";
            CHECK_NOTHROW(TestScene(text).trace({0, -3, 0}, {0, 1, 0}));
        }
    }
}
