#include "core/model/model_difference.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "core/model/model_change.h"
#include "core/model/surface_keys.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const std::string kMaterials =
    "void plastic grey 0 0 5 .5 .5 .5 0 0\nvoid plastic red 0 0 5 .5 .1 .1 0 0\n"
    "void light lamp 0 0 3 9 9 9\n";
const std::string kBall = "grey sphere ball 0 0 4 0 0 1 1\n",
                  kCup = "red sphere cup 0 0 4 3 0 1 .5\n",
                  kSun = "lamp source sun 0 0 4 0 0 1 .5\n",
                  kPanel = "lamp ring panel 0 0 8 0 0 3 0 0 -1 0 1\n";
const std::string kScene = kMaterials + kBall + kSun + kCup + kPanel;

std::shared_ptr<const Model> read(const std::string& text) {
    Silence quiet;
    return parse_scene(text, "test.rad", {}, quiet);
}

ComparedModel compare(const std::string& before, const std::string& after) {
    return compare_models(*read(before), read(after));
}

using Indices = std::vector<std::size_t>;

}  // namespace

TEST_CASE("model difference: lines that move, and comments, are none") {
    const auto after = read("# a comment\n\n" + kScene);
    const ComparedModel compared = compare_models(*read(kScene), after);
    CHECK(compared.difference.is_none());
    CHECK(compared.difference.same_geometry);
    CHECK(compared.model == after);
}

TEST_CASE("model difference: a material, a pattern that it has, and its type") {
    const auto check_one = [](const std::string& materials, const Indices& modifiers) {
        const ModelDifference found =
            compare(kScene, materials + kBall + kSun + kCup + kPanel).difference;
        CHECK(found.modifiers == modifiers);
        CHECK(found.sources == 0);
        CHECK_FALSE(found.has_surfaces());
        CHECK(found.modifiers_in_place);
        CHECK(found.same_geometry);
    };
    check_one(
        "void plastic grey 0 0 5 .5 .5 .5 0 0\nvoid plastic red 0 0 5 .9 .1 .1 0 0\n"
        "void light lamp 0 0 3 9 9 9\n",
        {1});
    check_one(
        "void metal grey 0 0 5 .5 .5 .5 0 0\nvoid plastic red 0 0 5 .5 .1 .1 0 0\n"
        "void light lamp 0 0 3 9 9 8\n",
        {0, 2});
}

TEST_CASE("model difference: modifiers keep their indices where others come, go or change places") {
    const auto names = [](const Model& model) {
        std::vector<std::string> all;
        for (const Primitive& modifier : model.modifiers) all.push_back(modifier.name);
        return all;
    };
    // One that nothing uses, in front; two change places.
    const std::string more =
        "void plastic blue 0 0 5 .1 .1 .5 0 0\n"
        "void plastic red 0 0 5 .5 .1 .1 0 0\n"
        "void plastic grey 0 0 5 .5 .5 .5 0 0\n"
        "void light lamp 0 0 3 9 9 9\n";
    const std::string rest = kBall + kSun + kCup + kPanel;
    const ComparedModel added = compare(kScene, more + rest);
    CHECK(names(*added.model) == std::vector<std::string>{"grey", "red", "lamp", "blue"});
    CHECK(added.difference.modifiers == Indices{3});
    CHECK(added.difference.same_geometry);
    CHECK(added.model->surfaces.modifier(0) == 0);
    CHECK(added.model->surfaces[2].where().line == 7);
    const ComparedModel gone = compare(more + rest, kScene);
    CHECK(names(*gone.model) == std::vector<std::string>{"blue", "red", "grey", "lamp"});
    CHECK(gone.difference.is_none());
    // A new pattern of an old material cannot come behind it.
    const ComparedModel patterned =
        compare(kScene,
                "void brightfunc dark 2 .5 . 0 0\ndark plastic grey 0 0 5 .5 .5 .5 0 0\n"
                "void plastic red 0 0 5 .5 .1 .1 0 0\nvoid light lamp 0 0 3 9 9 9\n" +
                    rest);
    CHECK_FALSE(patterned.difference.modifiers_in_place);
    CHECK_FALSE(patterned.difference.same_geometry);
    CHECK(patterned.difference.modifiers == Indices{0, 1});
    CHECK_FALSE(patterned.difference.has_surfaces());
}

TEST_CASE("model difference: a source that is another one, has come or is gone") {
    const ModelDifference turned =
        compare(kScene, kMaterials + kBall + "lamp source sun 0 0 4 0 1 1 .5\n" + kCup + kPanel)
            .difference;
    CHECK(turned.sources == 1);
    CHECK(turned.same_geometry);
    CHECK(turned.sources_in_place);
    for (const auto& [before, after] :
         {std::pair{kMaterials + kBall + kCup + kPanel, kScene},
          std::pair{kScene, kMaterials + kBall + kCup + kPanel},
          std::pair{kScene, kMaterials + kBall + kCup + kSun + kPanel + kSun}}) {
        const ModelDifference found = compare(before, after).difference;
        CHECK(found.sources == 1);
        CHECK(found.same_geometry);
        CHECK_FALSE(found.sources_in_place);
        CHECK_FALSE(found.has_surfaces());
    }
}

TEST_CASE("model difference: surfaces that come, go, move, change order or get another material") {
    const auto check = [](const std::string& surfaces, const Indices& gone, const Indices& come) {
        const ModelDifference found = compare(kScene, kMaterials + surfaces).difference;
        CHECK(found.gone == gone);
        CHECK(found.come == come);
        CHECK(found.modifiers.empty());
        CHECK(found.sources == 0);
        CHECK_FALSE(found.same_geometry);
        CHECK(found.modifiers_in_place);
        return found;
    };
    (void)check(kBall + kSun + "red sphere cup 0 0 4 3 1 1 .5\n" + kPanel, {2}, {2});
    (void)check(kBall + kSun + "grey sphere cup 0 0 4 3 0 1 .5\n" + kPanel, {2}, {2});
    (void)check(kCup + kSun + kBall + kPanel, {0, 2}, {0, 2});
    (void)check(kScene.substr(kMaterials.size()) + kBall, {}, {4});
    const ModelDifference gone = check(kBall + kSun + kPanel, {2}, {});
    CHECK(gone.first == 2);
    CHECK(gone.before_count == 1);
    CHECK(gone.after_count == 0);
    (void)check(kBall + kBall + kSun + kCup + kPanel, {}, {1});
}

TEST_CASE("model difference: where models are placed new modifiers make another geometry") {
    const std::string placed = kScene + "void instance tree 1 tree.oct 0 0\n";
    CHECK(compare(placed, placed + "void plastic blue 0 0 5 .1 .1 .5 0 0\n")
              .difference.same_geometry == false);
    CHECK(compare(kScene, kScene + "void plastic blue 0 0 5 .1 .1 .5 0 0\n")
              .difference.same_geometry);
}

TEST_CASE("surface keys: surfaces that stay have the keys that they had, others have new ones") {
    // The same edits of a list of names, and of keys.
    std::vector<std::uint32_t> list{0, 1, 2, 3, 4, 5, 6, 7};
    SurfaceKeys keys;
    std::uint32_t fresh = 1000;
    const auto check = [&](std::size_t first, std::size_t gone, std::size_t come) {
        std::vector<std::uint32_t> before, stay = list;
        for (std::size_t i = 0; i < list.size(); ++i)
            before.push_back(keys(static_cast<std::int32_t>(i)));
        std::vector<std::uint32_t> wanted = before;
        const auto at = static_cast<std::ptrdiff_t>(first);
        wanted.erase(wanted.begin() + at, wanted.begin() + at + static_cast<std::ptrdiff_t>(gone));
        list.erase(list.begin() + at, list.begin() + at + static_cast<std::ptrdiff_t>(gone));
        for (std::size_t i = 0; i < come; ++i) list.insert(list.begin() + at, fresh++);
        keys = keys.replaced(first, gone, come);
        for (std::size_t i = 0; i < list.size(); ++i) {
            const std::uint32_t key = keys(static_cast<std::int32_t>(i));
            if (i >= first && i < first + come)
                CHECK(std::ranges::find(before, key) == before.end());
            else
                CHECK(key == wanted[i < first ? i : i - come]);
        }
    };
    check(3, 1, 0);
    check(0, 0, 2);
    check(8, 1, 3);
    check(2, 4, 1);
    check(list.size(), 0, 2);
    check(0, 3, 3);
    CHECK(keys(-1) == 0xffffffff);
}
