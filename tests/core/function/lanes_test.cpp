// Evaluations side by side: same values as one by one, or none.
#include <doctest/doctest.h>

#include <bit>
#include <cstdint>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "tests/core/function/evaluate.h"

namespace lightwalk::test {
namespace {

Program compiled(const std::string& expression, const std::string& definitions = "",
                 const std::vector<double>& reals = {}) {
    FunctionEnvironment environment;
    environment.load("tt.cal", definitions);
    const std::vector<ExpressionRequest> requests{{expression, -1}};
    return environment.compile("tt.cal", requests, reals, 0, {"scene.rad", 7});
}

ChannelValues at(double x, double y = 0, double z = 0) {
    ChannelValues channels = straight_down();
    set(channels, Channel::Dx, x);
    set(channels, Channel::Dy, y);
    set(channels, Channel::Dz, z);
    return channels;
}

LaneValues side_by_side(const Program& program, const std::vector<ChannelValues>& rays,
                        EvalState& state) {
    return program.evaluate_lanes(0, rays, state);
}

double alone(const Program& program, const ChannelValues& ray, EvalState& state) {
    program.begin(state, ray);
    state.clear_error();
    return program.evaluate(0, state);
}

std::uint64_t bits(double x) {
    return std::bit_cast<std::uint64_t>(x);
}

/// Random points with coordinates in (low, high), for 1 to kLanes rays: same bits in all of them.
void check_same(const Program& program, double low, double high) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> coordinate(low, high);
    EvalState state;
    REQUIRE(program.has_lanes());
    for (int round = 0; round < 40; ++round) {
        std::vector<ChannelValues> rays;
        for (std::size_t k = 0; k < 1 + static_cast<std::size_t>(round) % kLanes; ++k)
            rays.push_back(at(coordinate(random), coordinate(random), coordinate(random)));
        const LaneValues values = side_by_side(program, rays, state);
        for (std::size_t k = 0; k < rays.size(); ++k) {
            REQUIRE(values.has(k));
            CHECK(bits(values.lanes.value[k]) == bits(alone(program, rays[k], state)));
            CHECK(state.error == EvalError::none);
        }
    }
}

}  // namespace

TEST_CASE("lanes: every operation gives the bits that it gives alone") {
    for (const char* expression : {"Dx",
                                   "-Dx",
                                   "Dx+Dy",
                                   "Dx+Dy+Dz",
                                   "Dx-Dy",
                                   "Dx*Dy",
                                   "Dx*Dy*Dz",
                                   "Dz+Dx*Dy",
                                   "Dz-Dx*Dy",
                                   "Dx/Dy",
                                   "1.5/Dy",
                                   "Dx/3",
                                   "Dx^2",
                                   "Dx^-3.5",
                                   "(Dz+1.01)^10",
                                   "Dx^Dy",
                                   "min(Dx,Dy)",
                                   "max(Dx,Dy)",
                                   "min(Dx,Dy,Dz)",
                                   "max(Dx,Dy,Dz,.5)",
                                   "rand(Dx)",
                                   "floor(9*Dx)",
                                   "ceil(9*Dx)",
                                   "sqrt(Dx)",
                                   "exp(Dx)",
                                   "log(Dx)",
                                   "log10(Dx)",
                                   "sin(Dx)",
                                   "cos(Dx)",
                                   "tan(Dx)",
                                   "asin(Dx)",
                                   "acos(Dx)",
                                   "atan(Dx)",
                                   "atan2(Dx,Dy)",
                                   "erf(Dx)",
                                   "erfc(Dx)",
                                   "mod(9*Dx,.4)",
                                   "frac(9*Dx)",
                                   "abs(Dx-.5)",
                                   "if(Dx-Dy,Dx,Dz)",
                                   "if(Dx,sin(Dy),cos(Dz))",
                                   "if(Dx-2,sin(Dy),cos(Dz))",
                                   "select(2,Dx,Dy*Dz,3)",
                                   "select(Dx+1,exp(Dx),Dy)"}) {
        CAPTURE(expression);
        const bool chooses = std::string(expression).starts_with("select(Dx");
        check_same(compiled(expression), chooses ? 0.01 : 0.05, chooses ? 0.4 : 0.95);
    }
}

TEST_CASE("lanes: variables, arguments and functions of a file, as skies use them") {
    const std::string sky =
        "cosgamma = Dx*A1 + Dy*A2 + Dz*A3;\n"
        "gamma = Acos(cosgamma);\n"
        "mean(a,x,b,y) = (a*x + b*y)/(a + b);\n"
        "sky = mean((Dz+1.01)^10, clear, (Dz+1.01)^-10, 3);\n"
        "clear = 14*(.91 + 10*exp(-3*gamma) + .45*cosgamma*cosgamma)*\n"
        "        if(Dz-.01, 1-exp(-.32/Dz), 1)/.8;\n";
    check_same(compiled("sky", sky, {0.23, -0.48, 0.84}), 0.02, 0.6);
    check_same(compiled("sky", sky, {0.23, -0.48, 0.84}), -0.6, -0.02);
}

TEST_CASE("lanes: where rays take different branches those go on that go with the first") {
    EvalState state;
    const Program program = compiled("if(Dx,sin(Dy),cos(Dy))");
    CHECK(side_by_side(program, {at(1), at(2), at(3)}, state).done == 0b111);
    CHECK(side_by_side(program, {at(-1), at(-2)}, state).done == 0b11);
    CHECK(side_by_side(program, {at(1), at(1), at(-1)}, state).done == 0b011);
    CHECK(side_by_side(program, {at(-1), at(1), at(1), at(-1)}, state).done == 0b1001);
    const Program choice = compiled("select(Dx,sin(Dy),cos(Dy),Dy)");
    CHECK(side_by_side(choice, {at(2), at(2.2)}, state).done == 0b11);
    CHECK(side_by_side(choice, {at(2), at(3), at(9), at(2)}, state).done == 0b1001);
    CHECK(side_by_side(choice, {at(9), at(9)}, state).done == 0);
    const Program twice = compiled("if(Dx,if(Dy,sin(Dz),Dz),cos(Dz))");
    const LaneValues values =
        side_by_side(twice, {at(1, 1, 2), at(-1, 1, 2), at(1, -1, 2), at(2, 3, 4)}, state);
    CHECK(values.done == 0b1001);
    CHECK(bits(values.lanes.value[3]) == bits(alone(twice, at(2, 3, 4), state)));
}

TEST_CASE("lanes: nothing for a ray that meets a numeric error") {
    struct Row {
        const char* expression;
        double good, bad;  // Dx
    };
    constexpr LaneMask kAll = (1U << kLanes) - 1;
    EvalState state;
    for (const Row& row :
         {Row{"log(Dx)", 1, 0}, Row{"1/Dx", 1, 0}, Row{"sqrt(Dx)/sqrt(Dx)", 1, -1},
          Row{"exp(1000*Dx)", 0.1, 1}, Row{"Dx^-2", 1, 0}, Row{"select(Dx,1,2)", 1, 5}}) {
        CAPTURE(row.expression);
        const Program program = compiled(row.expression);
        CHECK(side_by_side(program, std::vector(kLanes, at(row.good)), state).done == kAll);
        (void)alone(program, at(row.bad), state);
        CHECK(state.error != EvalError::none);
        for (std::size_t bad = 0; bad < kLanes; ++bad) {
            std::vector<ChannelValues> rays(kLanes, at(row.good));
            rays[bad] = at(row.bad);
            CHECK_FALSE(side_by_side(program, rays, state).has(bad));
        }
    }
}

TEST_CASE("lanes: any number of rays, whatever way each takes") {
    const Program program = compiled("if(Dx,if(Dy,sin(Dz),1/Dz),select(Dy+2,exp(Dz),log(Dz)))");
    REQUIRE(program.has_lanes());
    std::mt19937 random(11);
    std::uniform_int_distribution<int> side(-1, 1);
    std::vector<ChannelValues> rays;
    for (int i = 0; i < 100; ++i) rays.push_back(at(side(random), side(random), side(random)));
    EvalState state;
    for (const std::size_t count : {0, 1, 7, 8, 9, 100}) {
        std::vector<std::optional<double>> values(count, 4711.0);
        program.evaluate_all(0, std::span(rays).first(count), values, state);
        std::size_t errors = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const double expected = alone(program, rays[i], state);
            errors += state.error != EvalError::none ? 1 : 0;
            REQUIRE(values[i].has_value() == (state.error == EvalError::none));
            if (values[i]) CHECK(bits(*values[i]) == bits(expected));
        }
        if (count == 100) CHECK(errors > 5);
    }
}

TEST_CASE("lanes: what earlier evaluations left does not matter") {
    EvalState state;
    const Program reciprocal = compiled("1/Dx"), other = compiled("Dx+Dy*Dz-4");
    CHECK(side_by_side(reciprocal, {at(1), at(0), at(0), at(0)}, state).done == 1);
    const LaneValues values = side_by_side(reciprocal, {at(4)}, state);  // others held zeros
    REQUIRE(values.has(0));
    CHECK(values.lanes.value[0] == 0.25);
    CHECK(side_by_side(other, {at(1, 2, 3), at(2, 2, 3)}, state).lanes.value[1] == 4);
    CHECK(side_by_side(reciprocal, {at(4), at(8)}, state).lanes.value[1] == 0.125);
}

TEST_CASE("lanes: programs with noise, recursion or inputs have none") {
    CHECK_FALSE(Program().has_lanes());
    CHECK_FALSE(compiled("noise3(Dx,Dy,Dz)").has_lanes());
    CHECK_FALSE(compiled("fnoise3(Dx,Dy,Dz)").has_lanes());
    CHECK_FALSE(compiled("f(Dx,5*Dy)", "f(x,n) = if(n, x*f(x,n-1), 1);").has_lanes());
    FunctionEnvironment environment;
    environment.load("tt.cal", "f(x) = x*Dx;");
    const std::vector<ExpressionRequest> call{{"f", 1}};
    CHECK_FALSE(environment.compile("tt.cal", call, {}, 0, {"scene.rad", 7}).has_lanes());
}

}  // namespace lightwalk::test
