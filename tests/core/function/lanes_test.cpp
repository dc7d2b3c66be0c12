// Evaluations side by side: same values as one by one, or none.
#include <doctest/doctest.h>

#include <bit>
#include <cstdint>
#include <random>
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

std::optional<Lanes> side_by_side(const Program& program, const std::vector<ChannelValues>& rays,
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
        const auto values = side_by_side(program, rays, state);
        REQUIRE(values);
        for (std::size_t k = 0; k < rays.size(); ++k) {
            CHECK(bits(values->value[k]) == bits(alone(program, rays[k], state)));
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

TEST_CASE("lanes: nothing where rays take different branches") {
    EvalState state;
    const Program program = compiled("if(Dx,sin(Dy),cos(Dy))");
    CHECK(side_by_side(program, {at(1), at(2), at(3)}, state));
    CHECK(side_by_side(program, {at(-1), at(-2)}, state));
    CHECK_FALSE(side_by_side(program, {at(1), at(1), at(-1)}, state));
    CHECK_FALSE(side_by_side(program, {at(-1), at(1), at(1), at(1)}, state));
    const Program choice = compiled("select(Dx,sin(Dy),cos(Dy),Dy)");
    CHECK(side_by_side(choice, {at(2), at(2.2)}, state));
    CHECK_FALSE(side_by_side(choice, {at(2), at(3)}, state));
    CHECK_FALSE(side_by_side(choice, {at(9), at(9)}, state));
}

TEST_CASE("lanes: nothing where one ray meets a numeric error") {
    struct Row {
        const char* expression;
        double good, bad;  // Dx
    };
    EvalState state;
    for (const Row& row :
         {Row{"log(Dx)", 1, 0}, Row{"1/Dx", 1, 0}, Row{"sqrt(Dx)/sqrt(Dx)", 1, -1},
          Row{"exp(1000*Dx)", 0.1, 1}, Row{"Dx^-2", 1, 0}, Row{"select(Dx,1,2)", 1, 5}}) {
        CAPTURE(row.expression);
        const Program program = compiled(row.expression);
        CHECK(side_by_side(program, std::vector(kLanes, at(row.good)), state));
        (void)alone(program, at(row.bad), state);
        CHECK(state.error != EvalError::none);
        for (std::size_t bad = 0; bad < kLanes; ++bad) {
            std::vector<ChannelValues> rays(kLanes, at(row.good));
            rays[bad] = at(row.bad);
            CHECK_FALSE(side_by_side(program, rays, state));
        }
    }
}

TEST_CASE("lanes: what earlier evaluations left does not matter") {
    EvalState state;
    const Program reciprocal = compiled("1/Dx"), other = compiled("Dx+Dy*Dz-4");
    CHECK_FALSE(side_by_side(reciprocal, {at(1), at(0), at(0), at(0)}, state));
    const auto values = side_by_side(reciprocal, {at(4)}, state);  // the other lanes held zeros
    REQUIRE(values);
    CHECK(values->value[0] == 0.25);
    CHECK(side_by_side(other, {at(1, 2, 3), at(2, 2, 3)}, state)->value[1] == 4);
    CHECK(side_by_side(reciprocal, {at(4), at(8)}, state)->value[1] == 0.125);
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
