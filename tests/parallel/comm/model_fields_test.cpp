// A change of a scene on its way between ranks, and what a faulty rank may say instead.
#include "parallel/comm/model_fields.h"

#include <doctest/doctest.h>

#include <limits>
#include <memory>
#include <random>
#include <string>

#include "tests/test_scene.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

std::shared_ptr<const Model> model_of(const std::string& text) {
    Silence warnings;
    return parse_scene(text, "room.rad", {LibraryPath(std::vector<std::string>{}), false},
                       warnings);
}

const std::string kChangedRoom = R"(
void plastic grey 0 0 5 .5 .5 .5 0 0
void light sun 0 0 3 1e5 1e5 1e5
void brightfunc stripes 2 Px . 0 1 2
stripes metal shiny 0 0 5 .5 .5 .5 .9 .1
void mixfunc both 4 grey shiny Py . 0 0
void alias other both
other polygon floor 0 0 12  -4 -6 0  4 -6 0  4 6 0  -4 6 0
sun source day 0 0 4 0 1 1 .5
grey sphere ball 0 0 4 -1 2 .7 .7
)";

}  // namespace

TEST_CASE("a change of a model is the same after its way over the wire") {
    CHECK(static_cast<std::size_t>(wire::kEnumerators<PrimitiveType>) == primitive_type_count());
    const auto model = model_of(kChangedRoom);
    const ModelChange change = unchanged(*model);
    REQUIRE(change.sources.size() == 1);
    const std::string bytes = wire::encode(change);
    const auto got = wire::decode<ModelChange>(bytes);
    CHECK(wire::encode(got) == bytes);
    check_sound(got, *model);
    REQUIRE(got.modifiers.size() == model->modifiers.size());
    for (std::size_t i = 0; i < got.modifiers.size(); ++i) {
        const Primitive &a = got.modifiers[i], &b = model->modifiers[i];
        CHECK(a.type == b.type);
        CHECK(a.modifier == b.modifier);
        CHECK(a.name == b.name);
        CHECK(a.strings == b.strings);
        CHECK(a.reals == b.reals);
        CHECK(a.references == b.references);
        CHECK(to_prefix(a.where) == to_prefix(b.where));
    }
    CHECK(got.sources[0].before == 1);
    CHECK(got.sources[0].source.name == "day");
}

TEST_CASE("a change that nobody can have made is refused") {
    const auto model = model_of(kChangedRoom);
    const ModelChange sound = unchanged(*model);
    const auto refused = [&](auto spoil) {
        ModelChange change = sound;
        spoil(change);
        CHECK_THROWS_AS(check_sound(change, *model), InputError);
    };
    refused([](ModelChange& c) { c.modifiers[0].modifier = 0; });
    refused([](ModelChange& c) { c.modifiers[3].modifier = 3; });
    refused([](ModelChange& c) { c.modifiers[1].modifier = kUndefinedIndex; });
    refused([](ModelChange& c) { c.modifiers[4].references[0] = 4; });
    refused([](ModelChange& c) { c.modifiers[4].references[1] = -3; });
    refused([](ModelChange& c) { c.modifiers[0].type = PrimitiveType::sphere; });
    refused(
        [](ModelChange& c) { c.modifiers[0].reals[0] = std::numeric_limits<double>::infinity(); });
    refused([](ModelChange& c) { c.sources[0].source.modifier = 6; });
    refused([](ModelChange& c) { c.sources[0].source.type = PrimitiveType::sphere; });
    refused([](ModelChange& c) { c.sources[0].before = 100; });
}

TEST_CASE("whatever a faulty rank says is refused, or a scene") {
    const auto model = model_of(kChangedRoom);
    Silence warnings;
    MemoryResources files;
    const auto base = std::make_shared<const Scene>(model, modifier_factory, files, warnings);
    const std::string sound = wire::encode(unchanged(*model));
    std::mt19937 random(1);
    int built = 0, refused = 0;
    for (int mutant = 0; mutant < 3000; ++mutant) {
        std::string bytes = sound;
        for (int k = 0; k < 2; ++k)
            bytes[random() % bytes.size()] =
                static_cast<char>(random() % 2 == 0 ? random() : random() % 8);
        try {
            const auto change = wire::decode<ModelChange>(bytes);
            check_sound(change, *model);
            const Scene scene(base, change, modifier_factory, files, warnings);
            ++built;
        } catch (const InputError&) {
            ++refused;
        }
    }
    CHECK(built > 100);
    CHECK(refused > 100);
}
