// Scene files behind an octree: what `oconv -i base.oct more.rad` makes.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "core/model/model_builder.h"
#include "io/scene/scene_reader.h"
#include "tests/io/scene/octree_bytes.h"
#include "tests/temporary_folder.h"
#include "tests/test_scene.h"
#include "tests/tolerance.h"

namespace lightwalk {
namespace {

const std::string kBase = R"(
void plastic white 0 0 5 .5 .5 .5 0 0
void light lamp 0 0 3 10 10 10
void brightfunc dirt 2 .5 . 0 0
dirt plastic grey 0 0 5 .25 .25 .25 0 0
void alias plain grey
white polygon floor 0 0 9 0 0 0 4 0 0 4 4 0
white polygon more 0 0 9 0 0 0 4 4 0 0 4 0
lamp sphere l 0 0 4 2 2 3 .5
)";

/// Uses names of the base, redefines them alike and otherwise, and names them in strings.
const std::string kAdded = R"(
white sphere old 0 0 4 1 1 1 .5
void plastic white 0 0 5 .5 .5 .5 0 0
white sphere same 0 0 4 1 2 1 .5
void plastic white 0 0 5 .75 .25 .25 0 0
white sphere new 0 0 4 1 3 1 .5
inherit alias other grey
void alias clean plain
other polygon a 0 0 9 0 0 0 4 0 0 4 4 1
clean sphere b 0 0 4 3 1 1 .5
void illum pane 1 grey 0 3 1 1 1
pane ring c 0 0 8 3 3 1 0 0 1 0 .5
void antimatter cut 2 white lamp 0 0
cut sphere d 0 0 4 3 2 1 .5
void mixfunc both 4 white plain .5 . 0 0
both sphere e 0 0 4 2 1 1 .5
)";

struct Base {
    Base() {
        folder.write("base.rad", kBase);
        folder.write("added.rad", kAdded);
        const std::shared_ptr<const Model> model = read({"base.rad"});
        folder.write("frozen.oct", test::frozen_octree(*model));
        folder.write("referring.oct", test::referring_octree({"base.rad"}, model->size()));
    }
    [[nodiscard]] std::shared_ptr<const Model> read(
        const std::vector<std::string>& files, std::shared_ptr<const Model> base = nullptr) const {
        test::Silence silence;
        return read_scene(files, {LibraryPath({"."}), false, folder.path(), {}, std::move(base)},
                          silence);
    }
    [[nodiscard]] std::string refusal(const std::vector<std::string>& files) const {
        try {
            (void)read(files);
        } catch (const InputError& error) {
            return error.what();
        }
        return "no error";
    }
    test::TemporaryFolder folder;
};

void check_equal(const Primitive& got, const Primitive& expected) {
    CAPTURE(expected.name);
    CHECK(got.type == expected.type);
    CHECK(got.modifier == expected.modifier);
    CHECK(got.name == expected.name);
    CHECK(got.strings == expected.strings);
    CHECK(got.references == expected.references);
    REQUIRE(got.reals.size() == expected.reals.size());
    for (std::size_t i = 0; i < got.reals.size(); ++i)
        CHECK(got.reals[i] == test::within(0x1p-30, expected.reals[i]) /* an octree's mantissa */);
}

void check_equal(const Model& got, const Model& expected) {
    REQUIRE(got.modifiers.size() == expected.modifiers.size());
    for (std::size_t i = 0; i < got.modifiers.size(); ++i)
        check_equal(got.modifiers[i], expected.modifiers[i]);
    const std::vector<Primitive> a = test::surfaces_of(got), b = test::surfaces_of(expected);
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) check_equal(a[i], b[i]);
}

TEST_CASE("files behind an octree are read as behind its scene files") {
    const Base base;
    const auto expected = base.read({"base.rad", "added.rad"});
    REQUIRE(expected->surfaces.size() == 11);
    for (const char* octree : {"frozen.oct", "referring.oct"}) {
        CAPTURE(octree);
        const auto model = base.read({octree, "added.rad"});
        check_equal(*model, *expected);
        CHECK(model->header == std::vector<std::string>{"#?RADIANCE", "oconv -f x.rad"});
        REQUIRE(model->cube);
        CHECK(model->cube->size == 20);
        CHECK_FALSE(model->cube->holds_all);
        CHECK(base.read({octree})->cube->holds_all);
    }
}

TEST_CASE("files are added to a model as to the octree that it comes from, which stays as it was") {
    const Base base;
    const auto octree = base.read({"frozen.oct"});
    const auto expected = base.read({"frozen.oct", "added.rad"});
    check_equal(*base.read({"added.rad"}, octree), *expected);
    CHECK(octree->cube->holds_all);
    check_equal(*octree, *base.read({"base.rad"}));
    CHECK_THROWS_WITH_AS(base.read({"referring.oct"}, octree),
                         (base.folder.path("referring.oct: ") + kOneBase).c_str(), InputError);
}

TEST_CASE("what cannot be added to an octree is named") {
    const Base base;
    base.folder.write("bad.rad", "whit sphere s 0 0 4 0 0 0 1\nfloor sphere s 0 0 4 0 0 0 1\n");
    const std::string bad = base.folder.path("bad.rad");
    for (const char* octree : {"frozen.oct", "referring.oct"})
        CHECK(base.refusal({octree, "bad.rad"}) ==
              bad + ":1: undefined modifier \"whit\", did you mean \"white\"?\n" + bad +
                  ":2: undefined modifier \"floor\"");
    const std::string late = ": " + std::string(kOneBase);
    CHECK(base.refusal({"base.rad", "frozen.oct"}) == base.folder.path("frozen.oct") + late);
    CHECK(base.refusal({"frozen.oct", "referring.oct"}) ==
          base.folder.path("referring.oct") + late);
    base.folder.write("base.rad", kBase + "white sphere s 0 0 4 0 0 0 1\n");
    CHECK(base.refusal({"referring.oct", "added.rad"}).find("octree stale?") != std::string::npos);
}

}  // namespace
}  // namespace lightwalk
