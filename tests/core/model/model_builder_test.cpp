#include "core/model/model_builder.h"

#include <doctest/doctest.h>

#include <string>
#include <utility>
#include <vector>

namespace lightwalk {
namespace {

const SourceLocation kHere{"room.rad", 7};

Primitive make(PrimitiveType type, std::string name, std::vector<double> reals = {},
               std::vector<std::string> strings = {}, std::int32_t modifier = kVoidIndex) {
    return {type, modifier, std::move(name), std::move(strings), std::move(reals), {}, kHere};
}

Primitive plastic(std::string name, double grey) {
    return make(PrimitiveType::plastic, std::move(name), {grey, grey, grey, 0, 0});
}

std::string message_of(const auto& action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST_CASE("a name means its latest definition, what was read before keeps the older one") {
    ModelBuilder builder;
    const auto old = builder.add(plastic("paint", 0.1));
    CHECK(builder.modifier("paint", kHere) == old);
    const auto renewed = builder.add(plastic("paint", 0.2));
    CHECK(renewed != old);
    CHECK(builder.modifier("paint", kHere) == renewed);
    CHECK(builder.modifier("void", kHere) == kVoidIndex);
}

TEST_CASE("an equal redefinition adds a primitive, but the name keeps its identity") {
    ModelBuilder builder;
    const auto first = builder.add(plastic("paint", 0.5));
    CHECK(builder.add(plastic("paint", 0.5 * (1 + 5e-7))) != first);
    CHECK(builder.modifier("paint", kHere) == first);
    const auto other = builder.add(plastic("paint", 0.5 * (1 + 5e-6)));
    CHECK(builder.modifier("paint", kHere) == other);
    CHECK(builder.model().size() == 3);
}

TEST_CASE("definitions are equal when their modifiers are, whatever those are called") {
    ModelBuilder builder;
    const auto a = builder.add(make(PrimitiveType::brightfunc, "a", {1}, {"dirt", "dirt.cal"}));
    const auto b = builder.add(make(PrimitiveType::brightfunc, "b", {1}, {"dirt", "dirt.cal"}));
    const auto c = builder.add(make(PrimitiveType::brightfunc, "c", {2}, {"dirt", "dirt.cal"}));
    const auto first = builder.add(make(PrimitiveType::metal, "m", {1, 1, 1, 0, 0}, {}, a));
    builder.add(make(PrimitiveType::metal, "m", {1, 1, 1, 0, 0}, {}, b));
    CHECK(builder.modifier("m", kHere) == first);
    const auto last = builder.add(make(PrimitiveType::metal, "m", {1, 1, 1, 0, 0}, {}, c));
    CHECK(builder.modifier("m", kHere) == last);
}

TEST_CASE("names in string arguments compare by what they mean") {
    ModelBuilder builder;
    builder.add(plastic("a", 0.3));
    builder.add(plastic("b", 0.3));
    const auto first = builder.add(make(PrimitiveType::mirror, "m", {1, 1, 1}, {"a"}));
    builder.add(make(PrimitiveType::mirror, "m", {1, 1, 1}, {"b"}));
    CHECK(builder.modifier("m", kHere) == first);
    builder.add(plastic("a", 0.4));
    const auto last = builder.add(make(PrimitiveType::mirror, "m", {1, 1, 1}, {"a"}));
    CHECK(builder.modifier("m", kHere) == last);
}

TEST_CASE("long equal chains compare in bounded time") {
    ModelBuilder builder;
    std::int32_t a = kVoidIndex, b = kVoidIndex;
    for (int i = 0; i < 20000; ++i) {
        const std::string number = std::to_string(i);
        a = builder.add(make(PrimitiveType::texfunc, "a" + number, {}, {"x", "y", "z", "."}, a));
        b = builder.add(make(PrimitiveType::texfunc, "b" + number, {}, {"x", "y", "z", "."}, b));
    }
    builder.add(make(PrimitiveType::metal, "m", {}, {}, a));
    const auto last = builder.add(make(PrimitiveType::metal, "m", {}, {}, b));
    CHECK(builder.modifier("m", kHere) == last);  // too deep to call equal
}

TEST_CASE("references follow the types that have them") {
    ModelBuilder builder;
    const auto a = builder.add(plastic("a", 0.1));
    const auto b = builder.add(plastic("b", 0.2));
    const auto references = [&](PrimitiveType type, std::vector<std::string> strings) {
        const auto index = builder.add(make(type, "user", {}, std::move(strings)));
        return builder.model().modifiers[static_cast<std::size_t>(index)].references;
    };
    using Ids = std::vector<std::int32_t>;
    CHECK(references(PrimitiveType::illum, {"a"}) == Ids{a});
    CHECK(references(PrimitiveType::illum, {}) == Ids{});
    CHECK(references(PrimitiveType::mirror, {"void"}) == Ids{kVoidIndex});
    CHECK(references(PrimitiveType::mirror, {"nobody"}) == Ids{kUndefinedIndex});
    CHECK(references(PrimitiveType::mixfunc, {"b", "void", "a", "."}) == Ids{b, kVoidIndex});
    CHECK(references(PrimitiveType::mixtext, {"b"}) == Ids{b});
    CHECK(references(PrimitiveType::antimatter, {"void", "b", "c", "a"}) ==
          Ids{kVoidIndex, b, kUndefinedIndex, a});
    CHECK(references(PrimitiveType::brightfunc, {"a", "."}) == Ids{});
    CHECK(references(PrimitiveType::mist, {"a"}) == Ids{});
}

TEST_CASE("a primitive's strings mean what preceded it, not itself") {
    ModelBuilder builder;
    const auto old = builder.add(plastic("m", 0.1));
    const auto index = builder.add(make(PrimitiveType::illum, "m", {1, 1, 1}, {"m"}));
    CHECK(builder.model().modifiers[static_cast<std::size_t>(index)].references[0] == old);
}

TEST_CASE("an alias is a modifier of its own, with the arguments at the end of the trail") {
    ModelBuilder builder;
    const auto p = builder.add(make(PrimitiveType::brightfunc, "p", {1}, {"f", "."}));
    const auto q = builder.add(make(PrimitiveType::brightfunc, "q", {2}, {"f", "."}));
    const auto r = builder.add(make(PrimitiveType::plastic, "r", {1, 1, 1, 0, 0}, {}, p));
    const auto check = [&](std::int32_t alias, const char* name, std::int32_t modifier) {
        CAPTURE(name);
        const Primitive& primitive = builder.model().modifiers[static_cast<std::size_t>(alias)];
        CHECK(primitive.type == PrimitiveType::alias);
        CHECK(primitive.name == name);
        CHECK(primitive.modifier == modifier);
        CHECK(primitive.references == std::vector<std::int32_t>{r});
        CHECK(builder.modifier(name, kHere) == alias);
    };
    check(builder.rename("x1", r, kHere), "x1", p);
    check(builder.add_alias(p, "x2", r, kHere), "x2", p);
    check(builder.add_alias(kVoidIndex, "x3", r, kHere), "x3", kVoidIndex);
    const auto other = builder.add_alias(q, "x4", r, kHere);
    check(other, "x4", q);
    check(builder.add_alias(p, "x5", other, kHere), "x5", p);  // alias of an alias
    check(builder.rename("x6", other, kHere), "x6", q);
    check(builder.add_alias(kVoidIndex, "r", r, kHere), "r", kVoidIndex);  // own earlier name
    CHECK(message_of([&] { builder.rename("x", kVoidIndex, kHere); }) ==
          "room.rad:7: bad reference \"void\" in alias \"x\"");
}

TEST_CASE("illegal names and modifiers are refused, with their place") {
    ModelBuilder builder;
    CHECK(message_of([&] { builder.add(plastic("void", 0)); }) ==
          "room.rad:7: illegal modifier name \"void\"");
    CHECK(message_of([&] { builder.add(plastic("inherit", 0)); }) ==
          "room.rad:7: illegal modifier name \"inherit\"");
    CHECK(message_of([&] { builder.add(plastic("a\tb", 0)); }) ==
          "room.rad:7: identifier \"a\tb\" holds a tab");
    CHECK(builder.add(make(PrimitiveType::sphere, "void", {0, 0, 0, 1})) == 0);
    CHECK(message_of([&] { builder.add(make(PrimitiveType::metal, "m", {}, {}, 9)); }) ==
          "room.rad:7: modifier number 9 is not defined yet");
    CHECK(message_of([&] { builder.add(make(PrimitiveType::metal, "m", {}, {}, -7)); }) ==
          "room.rad:7: modifier number -7 is not defined yet");
    CHECK(message_of([&] { static_cast<void>(builder.alias_target("gone", kHere)); }) ==
          "room.rad:7: bad reference \"gone\": no modifier has this name");
}

TEST_CASE("an undefined modifier brings the nearest known name") {
    ModelBuilder builder;
    builder.add(plastic("white_paint", 0.8));
    builder.add(plastic("red_paint", 0.2));
    builder.add(
        make(PrimitiveType::sphere, "wite_paint", {0, 0, 0, 1}));  // a surface is no modifier
    CHECK(message_of([&] { static_cast<void>(builder.modifier("wite_paint", kHere)); }) ==
          "room.rad:7: undefined modifier \"wite_paint\", did you mean \"white_paint\"?");
    CHECK(message_of([&] { static_cast<void>(builder.modifier("granite", kHere)); }) ==
          "room.rad:7: undefined modifier \"granite\"");
}

TEST_CASE("equally near suggestions go by the alphabet") {
    CHECK(did_you_mean("cat", {"rat", "bat", "hat"}) == ", did you mean \"bat\"?");
    CHECK(did_you_mean("cat", {"dog"}).empty());
    CHECK(did_you_mean("", {"a"}).empty());
}

TEST_CASE("taking the model empties the builder") {
    ModelBuilder builder;
    builder.add(plastic("a", 0.1));
    CHECK(builder.release()->size() == 1);
    CHECK(builder.model().size() == 0);
    CHECK_THROWS_AS(static_cast<void>(builder.modifier("a", kHere)), InputError);
}

}  // namespace
}  // namespace lightwalk
