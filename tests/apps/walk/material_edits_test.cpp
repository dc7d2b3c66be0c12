#include "apps/walk/material_edits.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/test_scene.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const std::string kMadeOf = R"(
void brightfunc stripes 2 0.5 . 0 0
stripes plastic wall 0 0 5 .5 .5 .5 0 0
wall sphere first 0 0 4 0 0 0 1
void plastic wall 0 0 5 .2 .2 .2 0 0
wall sphere second 0 0 4 10 0 0 1
void alias door wall
door sphere third 0 0 4 20 0 0 1
void metal steel 0 0 5 .7 .7 .7 .9 .1
void mixfunc blend 4 wall steel 0.5 . 0 0
blend sphere fourth 0 0 4 30 0 0 1
void illum glowing 1 steel 0 3 1 2 3
glowing polygon fifth 0 0 9 39 0 -1 41 0 -1 40 0 1
void BRTDfunc strange 10 0 0 0 0 0 0 0 0 0 . 0 9 .1 .1 .1 .1 .1 .1 0 0 0
strange sphere sixth 0 0 4 50 0 0 1
)";

struct EditedScene {
    TestScene scene{kMadeOf};
    const Model& model = scene.scene.model();

    MaterialReply at(double x) {
        const Hit hit =
            scene.scene.geometry().intersect({{x, -9, 0.1}, {0, 1, 0}, farthest_hit(0)});
        return describe_material(scene.scene, model, hit, 7);
    }
    [[nodiscard]] std::size_t modifier(const std::string& name, std::uint32_t n = 0) const {
        for (std::size_t i = 0; i < model.modifiers.size(); ++i)
            if (model.modifiers[i].name == name && n-- == 0) return i;
        FAIL("no such modifier");
        return 0;
    }
};

MaterialEdit wall_edit(std::uint32_t definition, double red) {
    return {"wall", definition, "plastic", {red, .5, .5, 0, 0}};
}

}  // namespace

TEST_CASE("material edits: a surface is described by the very definition that it has") {
    EditedScene walk;
    const MaterialReply first = walk.at(0), second = walk.at(10), third = walk.at(20);
    CHECK(first.surface == "first");
    REQUIRE(first.layers.size() == 2);
    CHECK(first.layers[0].name == "wall");
    CHECK(first.layers[0].definition == 0);
    CHECK(first.layers[0].modifier == "stripes");
    CHECK(first.layers[0].where == "test.rad:3");
    CHECK(first.layers[0].fixed.empty());
    CHECK(first.layers[0].names.size() == 5);
    CHECK(first.layers[1].name == "stripes");
    CHECK(first.layers[1].kind == "brightfunc");
    CHECK(first.layers[1].names.empty());
    CHECK(first.layers[1].strings == std::vector<std::string>{"0.5", "."});
    REQUIRE(second.layers.size() == 1);
    CHECK(second.layers[0].definition == 1);
    CHECK(second.layers[0].reals[0] == .2);
    REQUIRE(third.layers.size() == 1);  // an alias has the numbers of what it stands for
    CHECK(third.layers[0].name == "wall");
    CHECK(third.layers[0].definition == 1);
    CHECK_FALSE(walk.at(-10).hit);
}

TEST_CASE("material edits: mixtures list their materials, and what is not seen comes last") {
    EditedScene walk;
    const auto names = [](const MaterialReply& reply) {
        std::string words;
        for (const MaterialLayer& layer : reply.layers) words += layer.name + ' ';
        return words;
    };
    CHECK(names(walk.at(30)) == "blend wall steel ");
    CHECK(names(walk.at(40)) == "steel glowing ");
    const MaterialReply strange = walk.at(50);
    REQUIRE(strange.layers.size() == 1);
    CHECK(strange.layers[0].fixed == "The numbers of a BRTDfunc cannot be changed here.");
}

TEST_CASE("material edits: what is sound is taken, what is not is refused with a reason") {
    const EditedScene walk;
    const CheckedEdits checked =
        check_edits(walk.model, {9,
                                 {wall_edit(1, .9),
                                  wall_edit(2, .5),
                                  wall_edit(0, 1.5),
                                  {"steel", 0, "plastic", {.1, .1, .1, 0, 0}},
                                  {"steel", 1, "metal", {.7, .7, .7, .9, .1}},
                                  {"stripes", 0, "brightfunc", {1}},
                                  {"glowing", 0, "illum", {1, 2, 3}},
                                  {"door", 0, "alias", {1}}}});
    CHECK(checked.reply.id == 9);
    CHECK(checked.sound ==
          std::vector<ModifierEdit>{{walk.modifier("wall", 1), {.9, .5, .5, 0, 0}}});
    CHECK(checked.reply.materials == std::vector<MaterialEdit>{wall_edit(1, .9)});
    std::vector<std::string> why;
    for (const RefusedEdit& refused : checked.reply.refused) why.push_back(refused.why);
    CHECK(why == std::vector<std::string>{"the scene's own files define no such material any more",
                                          "reflectance (red) must be from 0 to 1",
                                          "it is a metal by now",
                                          "the scene's own files define no such material any more",
                                          "the numbers of a brightfunc cannot be changed here",
                                          "the numbers of a alias cannot be changed here"});
}

TEST_CASE("material edits: the file has the changed modifiers, and gives them when it is read") {
    const EditedScene walk;
    const CheckedEdits checked = check_edits(walk.model, {1, {wall_edit(0, .9)}});
    const std::string text = edited_materials(walk.model, checked.sound);
    CHECK(text.find("# test.rad:3\n") != std::string::npos);
    CHECK(text.find("stripes plastic wall\n") != std::string::npos);
    const std::string pattern = "void brightfunc stripes 2 0.5 . 0 0\n";
    const TestScene read(pattern + text + "wall sphere s 0 0 4 0 0 0 1\n");
    CHECK(read.scene.model().modifiers[1].reals == std::vector<double>{.9, .5, .5, 0, 0});
    CHECK(edited_materials(walk.model, {}).find("plastic") == std::string::npos);
}

TEST_CASE("material edits: whatever is made of a material shows it") {
    const EditedScene walk;
    const std::vector<bool> with = modifiers_with(walk.scene.scene, {walk.modifier("wall", 1)});
    const auto shows = [&](const std::string& name, std::uint32_t n = 0) {
        return static_cast<bool>(with[walk.modifier(name, n)]);
    };
    CHECK_FALSE(shows("wall", 0));
    CHECK(shows("wall", 1));
    CHECK(shows("door"));
    CHECK(shows("blend"));
    CHECK_FALSE(shows("steel"));
    CHECK_FALSE(shows("glowing"));
    const std::vector<bool> steel = modifiers_with(walk.scene.scene, {walk.modifier("steel")});
    CHECK(steel[walk.modifier("glowing")]);
}
