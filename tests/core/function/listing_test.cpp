// The worked example of core/function/README.md is what the program does.
#include <doctest/doctest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/core/function/evaluate.h"

namespace lightwalk::test {
namespace {

/// The README's k-th text between ```language and ```; "" when there is none.
std::string block(const std::string& language, std::size_t k = 0) {
    std::ifstream in(LIGHTWALK_SOURCE "/core/function/README.md");
    const std::string text(std::istreambuf_iterator<char>(in), {});
    const std::string start = "\n```" + language + "\n";
    std::size_t at = text.find(start);
    for (; k > 0 && at != std::string::npos; --k) at = text.find(start, at + 1);
    if (at == std::string::npos) return {};
    at += start.size();
    return text.substr(at, text.find("```\n", at) - at);
}

const std::vector<ExpressionRequest> kRings{{"rings", -1}};
const std::vector<double> kReals{.2, .9};
const SourceLocation kWhere{"scene.rad", 7};

FunctionEnvironment rings() {
    FunctionEnvironment environment;
    environment.load("rings.cal", block("cal"));
    return environment;
}

std::string number(double x) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "  %8.6f", x);
    return text.data();
}

/// Rays that meet (x, 0, 0), and what they give side by side: as the README has it.
std::string in_lanes(const Program& program, const std::vector<double>& x) {
    std::vector<ChannelValues> rays(x.size(), straight_down());
    for (std::size_t k = 0; k < x.size(); ++k) set(rays[k], Channel::Px, x[k]);
    EvalState state;
    const LaneValues values = program.evaluate_lanes(0, rays, state);
    std::string text = "rings";
    for (std::size_t k = 0; k < x.size(); ++k) {
        if (!values.has(k)) {
            text += "      none";
            continue;
        }
        text += number(values.lanes.value[k]);
        program.begin(state, rays[k]);
        state.clear_error();
        const double alone = program.evaluate(0, state);
        CHECK(std::bit_cast<std::uint64_t>(values.lanes.value[k]) ==
              std::bit_cast<std::uint64_t>(alone));
    }
    std::string head = "Px   ";
    for (const double value : x) head += number(value);
    return head + "\n" + text + "\n";
}

}  // namespace

TEST_CASE("the function language's worked example: graph and code are as its README shows") {
    const auto listing = rings().listing("rings.cal", kRings, kReals, 0, kWhere);
    CHECK(block("graph") == listing.graph);
    CHECK(block("code") == listing.code);
}

TEST_CASE("the function language's worked example: lanes are as its README shows") {
    const Program program = rings().compile("rings.cal", kRings, kReals, 0, kWhere);
    CHECK(block("lanes", 0) == in_lanes(program, {.21, .25, .28, .42}));
    CHECK(block("lanes", 1) == in_lanes(program, {.21, .25, .28, .38}));
}

TEST_CASE("listings name every kind of cell, and number what is none") {
    FunctionEnvironment environment;
    environment.load("t.cal", "f(n) = if(n-.5, n*f(n-1)+v, 1); v = sqrt(Px); g(x) = x*2;");
    const std::vector<ExpressionRequest> requests{{"f(Py)", -1}, {"g", 1}};
    const auto listing = environment.listing("t.cal", requests, {}, 0, kWhere);
    for (const char* part :
         {"output0 = conditional(sum(Py, -0.5), sum(product(Py, instance0(sum(Py, -1))), ",
          "instance0 = conditional(sum(parameter0, -0.5), ", "product(input0, 2)"}) {
        CAPTURE(listing.graph);
        CHECK(listing.graph.find(part) != std::string::npos);
    }
    for (const char* part :
         {"instance0:\n  0  ", "force_parameter parameter0\n", "load_global -0.5\n",
          "force_global thunk", " = call #0, #", "return_call t0\n", "output0:\n",
          "multiply input0, 2\n", "  halt t0\n"}) {
        CAPTURE(listing.code);
        CHECK(listing.code.find(part) != std::string::npos);
    }
}

}  // namespace lightwalk::test
