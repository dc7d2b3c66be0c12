// Every row of library.def: all ways of evaluation give the same bits.
#include "core/function/library.h"

#include <doctest/doctest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/core/function/evaluate.h"

namespace lightwalk::test {
namespace {

using function::LaneSupport;
using function::LibraryEntry;
using function::LibraryKind;

/// Within the domain of every function.
constexpr std::array<double, 3> kPoint{.3, .625, .45};

std::string call(const LibraryEntry& entry, const std::array<std::string, 3>& arguments) {
    const bool any = entry.kind == LibraryKind::reduction;
    const std::size_t count = any ? 3 : static_cast<std::size_t>(entry.arguments);
    std::string text = std::string(entry.name) + "(";
    for (std::size_t i = 0; i < count; ++i) text += (i > 0 ? "," : "") + arguments[i];
    return text + ")";
}

std::uint64_t bits_of(double x) {
    return std::bit_cast<std::uint64_t>(x);
}

}  // namespace

TEST_CASE(
    "every built-in function of numbers: constant, folded, of a ray and in lanes the same "
    "bits") {
    std::size_t checked = 0;
    for (const LibraryEntry& entry : function::library_functions()) {
        if (entry.kind != LibraryKind::function && entry.kind != LibraryKind::reduction) continue;
        CAPTURE(entry.name);
        FunctionEnvironment environment;
        environment.load("tt.cal", "k : " + call(entry, {".3", ".625", ".45"}) + ";");
        const std::vector<ExpressionRequest> requests{{call(entry, {"Px", "Py", "Pz"}), -1},
                                                      {call(entry, {"A1", "A2", "A3"}), -1},
                                                      {"k", -1}};
        const std::vector<double> reals(kPoint.begin(), kPoint.end());
        const Program program = environment.compile("tt.cal", requests, reals, 0, {"t.rad", 1});
        std::vector<ChannelValues> rays(kLanes, straight_down());
        for (ChannelValues& ray : rays) {
            set(ray, Channel::Px, kPoint[0]);
            set(ray, Channel::Py, kPoint[1]);
            set(ray, Channel::Pz, kPoint[2]);
        }
        EvalState state;
        program.begin(state, rays.front());
        const double value = program.evaluate(0, state);
        CHECK(state.error == EvalError::none);
        for (const std::size_t folded : {1, 2}) {
            REQUIRE(program.constant(folded));
            CHECK(bits_of(*program.constant(folded)) == bits_of(value));
        }
        REQUIRE(program.has_lanes() == (entry.lanes != LaneSupport::none));
        if (program.has_lanes()) {
            const LaneValues values = program.evaluate_lanes(0, rays, state);
            REQUIRE(values.done == (1U << kLanes) - 1);
            for (const double lane : values.lanes.value) CHECK(bits_of(lane) == bits_of(value));
        }
        ++checked;
    }
    CHECK(checked >= 23);
}

TEST_CASE("built-in functions of the ray are no constants") {
    for (const LibraryEntry& entry : function::library_functions()) {
        CAPTURE(entry.name);
        CHECK(entry.constant() == (entry.kind != LibraryKind::ray_function));
        CHECK((entry.channels == 0 || !entry.constant()));
        CHECK(&function::library_entry(entry.function) == &entry);
    }
}

}  // namespace lightwalk::test
