#include "parallel/comm/wire.h"

#include <doctest/doctest.h>

#include "parallel/comm/core_fields.h"

using namespace lightwalk;

namespace {

enum class Colour : std::uint8_t { red, green };

struct Thing {
    int number = 0;
    std::optional<std::string> name;
    std::vector<std::variant<int, std::string>> list;
    Colour colour = Colour::red;
    View view;
};
template <class Wire>
void visit_fields(Wire& wire, Thing& thing) {
    wire(thing.number, thing.name, thing.list, thing.colour, thing.view);
}

}  // namespace

template <>
inline constexpr int wire::kEnumerators<Colour> = 2;

TEST_CASE("a value with fields, options and alternatives comes back from its bytes") {
    Thing thing{7, "seven", {3, "three"}, Colour::green, {}};
    thing.view.position = {1, -0.0, 1e300};
    const std::string bytes = wire::encode(thing);
    CHECK(bytes.size() == wire::size_of(thing));
    const auto back = wire::decode<Thing>(bytes);
    CHECK(back.number == 7);
    CHECK(back.name == "seven");
    CHECK(back.list == thing.list);
    CHECK(back.colour == Colour::green);
    CHECK(back.view == thing.view);
    CHECK(wire::encode(back) == bytes);
}

TEST_CASE("bytes that no value has are refused") {
    const std::string bytes = wire::encode(Thing{7, "seven", {3, "three"}, Colour::green, {}});
    for (std::size_t size = 0; size < bytes.size(); ++size)
        CHECK_THROWS_AS((void)wire::decode<Thing>(bytes.substr(0, size)), InputError);
    CHECK_THROWS_AS((void)wire::decode<Thing>(bytes + 'x'), InputError);
    // A list of a few bytes cannot have a million elements.
    CHECK_THROWS_AS(
        (void)wire::decode<std::vector<double>>(wire::encode(std::uint64_t{1000000}) + "12345678"),
        InputError);
    CHECK_THROWS_AS((void)wire::decode<bool>("\x02"), InputError);
    CHECK_THROWS_AS((void)wire::decode<Colour>("\x02"), InputError);
    CHECK_THROWS_AS((void)(wire::decode<std::variant<int, bool>>("\x02")), InputError);
}

TEST_CASE("lists that are copied as a whole have the bytes of their elements one after the other") {
    const std::vector<PixelValue> values{{{1, -0.0F, 3}, 4}, {{5, 6, 7}, 1e10F}};
    const std::vector<PixelPlace> places{{1, -2}, {3, 4}, {5, 6}};
    const auto check = [](const auto& list) {
        std::string bytes = wire::encode(std::uint64_t{list.size()});
        for (const auto& element : list) bytes += wire::encode(element);
        CHECK(wire::encode(list) == bytes);
        CHECK(wire::size_of(list) == bytes.size());
        CHECK(wire::decode<std::decay_t<decltype(list)>>(bytes) == list);
    };
    static_assert(wire::kPlain<PixelValue> && wire::kPlain<PixelPlace>);
    check(values);
    check(places);
}
