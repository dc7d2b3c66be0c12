// Programs: epochs, channels, real arguments, calls by name, variables of materials.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/core/function/evaluate.h"
#include "tests/tolerance.h"

namespace lightwalk::test {
namespace {

struct Compiled {
    Program program;
    EvalState state;
    ChannelValues channels = straight_down();

    Compiled(const std::string& definitions, const std::vector<ExpressionRequest>& requests,
             const std::vector<double>& reals = {}, ChannelMask mask = 0) {
        FunctionEnvironment environment;
        environment.load("tt.cal", definitions);
        program = environment.compile("tt.cal", requests, reals, mask, {"scene.rad", 7});
    }
    void begin() {
        program.begin(state, channels);
        state.clear_error();
    }
    double operator()(std::size_t k = 0) { return program.evaluate(k, state); }
    double call(std::size_t k, const std::vector<double>& arguments) {
        return program.call(k, arguments, state);
    }
    void set_channel(Channel c, double v) { set(channels, c, v); }
};

constexpr ChannelMask kNormal = channel_bit(Channel::NxP) | channel_bit(Channel::NyP) |
                                channel_bit(Channel::NzP) | channel_bit(Channel::RdotP);
constexpr ChannelMask kColor =
    channel_bit(Channel::CrP) | channel_bit(Channel::CgP) | channel_bit(Channel::CbP);

}  // namespace

TEST_CASE("each channel has its number and its name") {
    const std::array<const char*, 27> names{"Dx", "Dy",   "Dz", "Nx", "Ny", "Nz", "Px", "Py", "Pz",
                                            "T",  "Rdot", "S",  "Tx", "Ty", "Tz", "Ix", "Iy", "Iz",
                                            "Jx", "Jy",   "Jz", "Kx", "Ky", "Kz", "Ts", "Lu", "Lv"};
    for (std::size_t i = 0; i < names.size(); ++i) {
        Compiled c("", {{names[i], -1},
                        {"$" + std::to_string(i + 1), -1},
                        {"$ " + std::to_string(i + 1), -1}});
        for (std::size_t k = 1; k < kChannelCount; ++k)
            c.channels[k] = 100.0 + static_cast<double>(k);
        c.begin();
        for (std::size_t k = 0; k < 3; ++k) CHECK(c(k) == 101.0 + static_cast<double>(i));
        CHECK(c.program.channels() == ChannelMask{1} << (i + 1));
    }
}

TEST_CASE("a program says which channels it reads: untaken branches count not") {
    Compiled c("f = if(A1, Px, Py);", {{"f", -1}, {"source_theta(1)*sin(Lu)", -1}}, {1});
    CHECK(c.program.outputs() == 2);
    CHECK(c.program.channels() ==
          (channel_bit(Channel::Px) | channel_bit(Channel::Dz) | channel_bit(Channel::Lu)));
    CHECK(Program().channels() == 0);
    CHECK(Program().outputs() == 0);
    CHECK(Program().empty());
}

TEST_CASE("variables are computed once an epoch, and anew in the next") {
    Compiled c("v = sqrt(Px); w = v+v*Py;", {{"v", -1}, {"w", -1}, {"v-1", -1}});
    for (const double x : {4.0, 9.0, 0.25}) {
        c.set_channel(Channel::Px, x);
        c.set_channel(Channel::Py, 2);
        c.begin();
        CHECK(c(1) == 3 * std::sqrt(x));
        CHECK(c(0) == std::sqrt(x));
        CHECK(c(2) == std::sqrt(x) - 1);
    }
    c.set_channel(Channel::Px, -1);
    c.begin();
    CHECK(c(0) == 0);
    CHECK(c.state.error == EvalError::domain);
    CHECK(c.state.warnings == 1);
    c.state.clear_error();
    CHECK(c(2) == -1);
    CHECK(c.state.error == EvalError::none);
    CHECK(c.state.warnings == 1);
}

TEST_CASE("one state serves programs in turn") {
    Compiled a("v = sqrt(Px);", {{"v", -1}, {"v*v", -1}});
    Compiled b("v = Px*8; f(n) = if(n-.5, v+f(n-1), 0);", {{"f(Rdot*50)", -1}, {"v", -1}});
    a.set_channel(Channel::Px, 16);
    EvalState state;
    for (int i = 0; i < 3; ++i) {
        a.program.begin(state, a.channels);
        CHECK(a.program.evaluate(1, state) == 16);
        CHECK(a.program.evaluate(0, state) == 4);
        b.set_channel(Channel::Px, i);
        b.program.begin(state, b.channels);
        CHECK(b.program.evaluate(0, state) == 400 * i);
        CHECK(b.program.evaluate(1, state) == 8 * i);
    }
}

TEST_CASE("functions called by name get exactly the values given") {
    Compiled c("f(a,b) = a-b*v; v = Px; g(a,b,c) = a+c; clamp(x) = bound(0,x,1);",
               {{"f", 2},
                {"g", 2},
                {"clamp", 1},
                {"noop", 1},
                {"sqrt", 1},
                {"undefined", 3},
                {"max", 3},
                {"v", 1}});
    c.set_channel(Channel::Px, 10);
    c.begin();
    CHECK(c.call(0, {5, 2}) == -15);
    CHECK(c.call(0, {7, 1}) == -3);
    CHECK(c.call(2, {3}) == 1);
    CHECK(c.call(2, {.5}) == .5);
    CHECK(c.call(3, {42}) == 42);
    CHECK(c.call(4, {9}) == 3);
    CHECK(c.call(6, {1, 7, 3}) == 7);
    CHECK_THROWS_WITH_AS(c.call(1, {1, 2}), "scene.rad:7: g`tt(): too few arguments", InputError);
    CHECK_THROWS_WITH_AS(c.call(5, {1, 2, 3}), "scene.rad:7: undefined(): undefined function",
                         InputError);
    CHECK_THROWS_WITH_AS(c.call(7, {1}), "scene.rad:7: v(): undefined function", InputError);
    CHECK(c.call(4, {-9}) == 0);
    CHECK(c.state.error == EvalError::domain);
    FunctionEnvironment environment;
    const std::vector<ExpressionRequest> bad{{"f(x)", 1}};
    CHECK_THROWS_AS((void)environment.compile(".", bad, {}, 0, {"scene.rad", 7}), InputError);
}

TEST_CASE("a function called by name may use its value more than once, and recursively") {
    Compiled c("p(x) = sqrt(x)*sqrt(x)+h(x*x); h(y) = y-y; sum(n) = if(n-.5, n+sum(n-1), 0);",
               {{"p", 1}, {"sum", 1}});
    c.begin();
    for (const double x : {4.0, 9.0, 16.0}) {
        CHECK(c.call(0, {x}) == x);
        CHECK(c.call(1, {x}) == x * (x + 1) / 2);
    }
}

TEST_CASE("outputs that do not depend on the ray are known constants") {
    Compiled c("v = A1*2; k : 3; f(x) = sin(x);",
               {{"1", -1},
                {"v+k", -1},
                {"f(A1)", -1},
                {"Px", -1},
                {"v/(A2-2)", -1},
                {"sqrt(-A1)", -1},
                {"fac(5)", -1}},
               {4, 2});
    REQUIRE(c.program.constant(0));
    CHECK(*c.program.constant(0) == 1);
    REQUIRE(c.program.constant(1));
    CHECK(*c.program.constant(1) == 11);
    REQUIRE(c.program.constant(2));
    CHECK(*c.program.constant(2) == std::sin(4.0));
    CHECK_FALSE(c.program.constant(3));
    CHECK_FALSE(c.program.constant(4));
    CHECK_FALSE(c.program.constant(5));  // it fails: at run time
    c.begin();
    CHECK(c(1) == 11);
    CHECK(c(5) == 0);
    CHECK(c.state.error == EvalError::domain);
    CHECK_THROWS_AS(c(6), InputError);
}

TEST_CASE("real arguments are counted from one, and missing ones are errors when used") {
    Compiled c("k = arg(Px); safe = if(AC-2.5, A3, 7);",
               {{"A2", -1}, {"arg(0)", -1}, {"k", -1}, {"A3", -1}, {"safe", -1}, {"arg(-5)", -1}},
               {10, 20});
    c.begin();
    CHECK(c(0) == 20);
    CHECK(c(1) == 2);
    CHECK(c(4) == 7);
    CHECK(c(5) == 2);
    CHECK(c(2) == 2);
    CHECK_THROWS_WITH_AS(c(3), "scene.rad:7: bad call to arg(3): there are 2 real arguments",
                         InputError);
    c.set_channel(Channel::Px, 1.4);
    c.begin();
    CHECK(c(2) == 10);
    c.set_channel(Channel::Px, 3);
    c.begin();
    CHECK_THROWS_WITH_AS(c(2), "scene.rad:7: bad call to arg(3): there are 2 real arguments",
                         InputError);
    c.set_channel(Channel::Px, std::numeric_limits<double>::quiet_NaN());
    c.begin();
    CHECK(c(2) == 2);
}

TEST_CASE("variables of materials are undefined where the material does not set them") {
    const std::string file = "r = CrP*2; n = NxP; a = DxA;";
    Compiled with(file, {{"r", -1}, {"n", -1}, {"CgP+RdotP", -1}, {"DxA", -1}}, {},
                  kNormal | kColor);
    with.set_channel(Channel::CrP, .25);
    with.set_channel(Channel::CgP, .5);
    with.set_channel(Channel::NxP, -1);
    with.set_channel(Channel::RdotP, .125);
    with.begin();
    CHECK(with(0) == .5);
    CHECK(with(1) == -1);
    CHECK(with(2) == .625);
    CHECK_THROWS_WITH_AS(with(3), "scene.rad:7: DxA: undefined variable", InputError);
    CHECK((with.program.channels() & (kNormal | kColor)) ==
          (channel_bit(Channel::CrP) | channel_bit(Channel::CgP) | channel_bit(Channel::NxP) |
           channel_bit(Channel::RdotP)));
    Compiled without(file, {{"r", -1}, {"n", -1}});
    without.begin();
    CHECK_THROWS_WITH_AS(without(0), "scene.rad:7: CrP: undefined variable", InputError);
    CHECK_THROWS_WITH_AS(without(1), "scene.rad:7: NxP: undefined variable", InputError);
    CHECK(without.program.channels() == 0);
}

TEST_CASE("the local frame is orthonormal about the perturbed normal") {
    Compiled c("",
               {{"Ldx(1,0,0)", -1},
                {"Ldx(0,1,0)", -1},
                {"Ldx(0,0,1)", -1},
                {"Ldy(1,0,0)", -1},
                {"Ldy(0,1,0)", -1},
                {"Ldy(0,0,1)", -1},
                {"Ldz(1,0,0)", -1},
                {"Ldz(0,1,0)", -1},
                {"Ldz(0,0,1)", -1},
                {"Idx", -1},
                {"Idy", -1},
                {"Idz", -1}},
               {.3, .1, -.2, 1, .5}, kNormal);
    const double n = std::sqrt(.1 * .1 + .4 * .4 + .9 * .9);
    const std::array<double, 3> normal{.1 / n, .4 / n, .9 / n};
    for (std::size_t i = 0; i < 3; ++i)
        c.channels[static_cast<std::size_t>(Channel::NxP) + i] = normal[i];
    c.set_channel(Channel::RdotP, .375);
    c.begin();
    std::array<std::array<double, 3>, 3> axes{};
    for (std::size_t k = 0; k < 9; ++k) axes[k / 3][k % 3] = c(k);
    for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t b = 0; b < 3; ++b) {
            double product = 0;
            for (std::size_t i = 0; i < 3; ++i) product += axes[a][i] * axes[b][i];
            CHECK(product == rounded(a == b ? 1 : 0));
        }
    }
    // The frame's y axis is across the up direction (-.2, 1, .5).
    CHECK(axes[1][0] * -.2 + axes[1][1] * 1 + axes[1][2] * .5 == rounded(0));
    CHECK(axes[2][2] == rounded(normal[2]));
    CHECK(c(9) == rounded(axes[0][2]));  // towards the eye, from straight above
    CHECK(c(10) == rounded(axes[1][2]));
    CHECK(c(11) == .375);
}

TEST_CASE("infinities pass through arithmetic and end in functions") {
    Compiled c("", {{"Px*10", -1},
                    {"noop(Px*10)", -1},
                    {"if(Rdot,Px*10,1)", -1},
                    {"Px*10-Px*10", -1},
                    {"max(Px*10,0)", -1}});
    c.set_channel(Channel::Px, 1e308);
    c.begin();
    CHECK(std::isinf(c(0)));
    CHECK(std::isinf(c(1)));
    CHECK(std::isnan(c(3)));
    CHECK(c.state.error == EvalError::none);
    CHECK(c(2) == 0);
    CHECK(c.state.error == EvalError::range);
    c.state.clear_error();
    CHECK(c(4) == 0);
    CHECK(c.state.error == EvalError::range);
}

TEST_CASE("what a prism does with light needs sensible arguments") {
    const ChannelMask aim =
        channel_bit(Channel::DxA) | channel_bit(Channel::DyA) | channel_bit(Channel::DzA);
    const std::vector<double> good{.63, 1.18, 1, .87, 1.5, .02, 4, 1, .01, .05};
    for (std::size_t i = 0; i < good.size(); ++i) {
        std::vector<double> reals = good;
        reals[i] = i == 4 ? .5 : i == 6 ? 3 : i == 7 ? good[i] : -1;
        Compiled c("", {{"fprism_val(3,1,1)", -1}}, reals, aim);
        c.set_channel(Channel::Dx, .6);
        c.set_channel(Channel::Dz, -.8);
        c.begin();
        (void)c();
        CAPTURE(i);
        CHECK(c.state.error == (i == 7 ? EvalError::none : EvalError::domain));
    }
    Compiled c("",
               {{"fprism_val(3,-2,1)+fprism_val(3,1,1)", -1},
                {"fprism_val(4,1,1)", -1},
                {"fprism_val(0,1,7)", -1}},
               good, aim);
    c.set_channel(Channel::Dx, .6);
    c.set_channel(Channel::Dz, -.8);
    c.begin();
    const double shares = c();
    CHECK(shares > .3);
    CHECK(shares < 1);  // no more light leaves than came
    CHECK(c(2) == 1);
    CHECK(c(1) == 0);
    CHECK(c.state.error == EvalError::domain);
    // Mirrored light that is never absorbed ends, too.
    Compiled trap("", {{"fprism_val(3,1,1)", -1}}, {1, 1, 1, .5, 9, 0, 1, 1, .01, .05}, aim);
    trap.set_channel(Channel::Dx, .8);
    trap.set_channel(Channel::Dy, .6);
    trap.begin();
    CHECK(trap() <= 1);
    Compiled needs("", {{"fprism_val(3,1,1)", -1}}, good);
    needs.begin();
    CHECK_THROWS_AS(needs(), InputError);
}

}  // namespace lightwalk::test
