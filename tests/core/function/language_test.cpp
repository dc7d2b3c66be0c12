// Values and errors of the language, as Radiance's renderer prints them.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "tests/core/function/evaluate.h"
#include "tests/tolerance.h"

namespace lightwalk::test {
namespace {

const std::string kLanguagePrelude = R"(
va(i) = select(i,1,2,3);  vb(i) = select(i,4,5,6);
fac(n) : if(n-1.5, n*fac(n-1), 1);   fib(n) = if(n-1.5, fib(n-1)+fib(n-2), n);
app(f,x) = f(x);  comp(f,g,x) = f(g(x));  first(a,b) = a;  second(a,b) = b;
nargs3(a,b,c) = select(0,a,b,c);
x3 = .3;  y1 = .1;  z = 0;  m8 = -8;  o = 1;  K : 3;  kk = 3;
)";
const std::string kFaultyLanguage = "m8=-8; z=0; o=1; bad=sqrt(m8); good=sin(o);";

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kSkip = -12345;  ///< instead of a value: the error flag is set

struct LanguageRow {
    std::string expression;
    double value;
};

const std::vector<LanguageRow> kLanguage{
    {"-2^2", 4},
    {"2^3^2", 512},
    {"2^-1^2", 2},
    {"-2^-2", 0.25},
    {"8/2*2", 8},
    {"1-2-3", -4},
    {"2--3", 5},
    {"-(-3)", 3},
    {"3-2*2^2", -5},
    {"0^0", 1},
    {"(-2)^3", -8},
    {"1.E2", 100},
    {"{c}4{d{e}f}+{g}1", 5},
    {"if(0,1,2)", 2},
    {"if(1e-300,1,2)", 1},
    {"first(7,undefinedname)", 7},
    {"select(0,5,6,7)", 3},
    {"select(2.4,5,6,7)", 6},
    {"select(2.6,5,6,7)", 7},
    {"select(-.4,5,6,7)", 3},
    {"nargs3(9,9,9)", 3},
    {"max(3,9,2)", 9},
    {"floor(-1.5)", -2},
    {"ceil(-1.5)", -1},
    {"fac(5)", 120},
    {"fib(12)", 144},
    {"app(sin,.5)", 0.479425538604203},
    {"comp(sqrt,abs,-16)", 4},
    {"dot(va,vb)", 32},
    {"cross(2,va,vb)", 6},
    {".3/.1", 2.9999999999999996},
    {"x3/.1", 3},
    {"x3/y1", 2.9999999999999996},
    {"floor(x3/.1)", 3},
    {"floor(x3/y1)", 2},
    {"x3+1+x3+2", 3.5999999999999996},
    {"x3/3/x3*7", 2.333333333333333},
    {"0/z", 0},
    {"0^z", 0},
    {"z^0", 1},
    {"-m8^2", 64},
    {"atan2(1,-1)", 2.356194490192345},
    {"erf(.5)", 0.5204998778130465},
    {"erfc(3)", 2.2090496998585556e-05},
    {"$3", -1},
    {"$11", 1},
    {"PI`", 3.141592653589793},
    {"sin(1,99)", 0.8414709848078965},
    {"bound(0,3,1)", 1},
    {"Acos(-2)", 3.141592653589793},
    {"Exp(-100)", 3.720075976020836e-44},
    {"and(1,-2)", -2},
    {"or(-1,-5)", -5},
    {"not(0)", 1},
    {"xor(1,-1)", 1},
    {"sgn(0)", 0},
    {"inside(0,3,2)", -1},
    {"frac(-.25)", 0.75},
    {"mod(-7,3)", 2},
    {"mod(7,-3)", -2},
    {"tri(1.3,1)", 0.7},
    {"tri(2.7,1)", 0.7000000000000002},
    {"linterp(.25,10,20)", 12.5},
    {"blue(-1,-2,-3)", 0},
    {"grey(1,2,3)", 1.799737117},
    {"clipgrey(.2,.3,.4)", 0.2799737117},
    {"fade(1,0,2)", 0.2},
    {"fade(1,0,15.9)", 0.0039399550845120365},
    {"hermite(1,2,.5,-.5,.6)", 1.7680000000000002},
    {"bezier(1,-1,4,2,.7)", 2.288},
    {"bspline(1,-1,4,2,.7)", 2.131333333333333},
    {"turbulence(1.3,2.2,3.7,.125)", 0.2598924557422594},
    {"turbulencex(1.3,2.2,3.7,.125)", 2.429613370456524},
    {"turbulencey(1.3,2.2,3.7,.125)", 1.0541760799591127},
    {"turbulencez(1.3,2.2,3.7,.125)", -0.9555992058725149},
    {"turbulence(-4.1,.6,9.9,.01)", 0.1805330220239829},
    {"unif2norm(.1)", -1.281728756502709},
    {"unif2norm(.5)", -1.0100667546808495e-07},
    {"nrand(3)", -0.47186979401774476},
    {"noise3d(2,1.3,2.2,3.7)", -0.23555688107165795},
};

const std::vector<LanguageRow> kErrors{
    {"m8^(1/3)", kSkip},
    {".25/z", kSkip},
    {".25/z+.5", kSkip},
    {"1/z+sin(o)", 0.841470957},
    {"sin(o)+1/z", kSkip},
    {"sqrt(m8)", kSkip},
    {"sqrt(m8)+.5", kSkip},
    {"sqrt(m8)+sin(z)", 0},
    {".5+if(1/z,2,3)", kSkip},
    {"if(o,.5,1/z)", 0.5},
    {"if(o,1/z,.5)", kSkip},
    {"max(.25,sqrt(m8))", kSkip},
    {"max(sqrt(m8),.25)", kSkip},
    {"max(sqrt(m8),sin(o))", 0.841470957},
    {"max(sin(o),sqrt(m8))", kSkip},
    {"log(z)", kSkip},
    {"log(m8)", kSkip},
    {"exp(o*2000)", kSkip},
    {"acos(o*2)", kSkip},
    {"atan2(z,z)", 0},
    {"bad-good", -0.841470957},
    {"good-bad", kSkip},
    {"bad*good", 0},
    {"good*bad", kSkip},
    {"bad+good", 0.841470957},
    {"good+bad", kSkip},
    {"bad/good", kSkip},
    {"good/bad", kSkip},
    {"good^bad", 1},
    {"bad^good", kSkip},
    {"bad+m8^2", 64},
    {"select(5*o,1,2)", kSkip},
    {"select(m8,1,2)", kSkip},
    {"o*1e308*10", kInfinite},
    {"Sqrt(m8)", 0},
    {"Acos(m8)", 3.14159274},
    {"Exp(m8*100)", 0},
};

const std::vector<std::string> kFatal{"select(5,1,2)",
                                      "undefd",
                                      "undeff(2)",
                                      "sin",
                                      "if(o)",
                                      "if(z,1)",
                                      "sin()",
                                      "$0",
                                      "$28",
                                      "arg(1)",
                                      "PI(2)",
                                      "--3",
                                      "3 4",
                                      "1/0",
                                      "z/0",
                                      ".e",
                                      "1e",
                                      "1.5e+",
                                      "2x",
                                      ".5}",
                                      "x {u",
                                      "NxP"};

bool near(double value, double expected, double tolerance) {
    return value == expected ||
           std::abs(value - expected) <= tolerance * std::max(1.0, std::abs(expected));
}

Setting ray_over(std::string_view definitions) {
    return {definitions, {}, 0, straight_down()};
}

}  // namespace

TEST_CASE("the language and its library have the values that Radiance prints") {
    for (const LanguageRow& row : kLanguage) {
        CAPTURE(row.expression);
        const std::string definitions = kLanguagePrelude + "the_value = " + row.expression + ";";
        // Slopes of noise are differences over a small step: they lose digits.
        const bool slope =
            row.expression.rfind("turbulence", 0) == 0 || row.expression.rfind("noise3d", 0) == 0;
        CHECK(near(evaluate("the_value", ray_over(definitions)).value, row.value,
                   slope ? 4e-12 : 1e-14));
    }
}

TEST_CASE("numeric errors make a primitive skip, unless a later function forgets them") {
    for (const LanguageRow& row : kErrors) {
        CAPTURE(row.expression);
        const Evaluated result = evaluate(row.expression, ray_over(kFaultyLanguage));
        CHECK((result.error != EvalError::none) == (row.value == kSkip));
        if (row.value != kSkip) CHECK(near(result.value, row.value, 1e-7));
    }
}

TEST_CASE("what is wrong for certain throws") {
    for (const std::string& expression : kFatal) {
        CAPTURE(expression);
        CHECK(complaint(expression, kFaultyLanguage).substr(0, 13) == "scene.rad:7: ");
    }
}

TEST_CASE("the error flag lives on from one output of an epoch to the next") {
    const auto skips = [](const std::vector<std::string>& in_order) {
        return evaluate_all(in_order, ray_over(kFaultyLanguage)).back().error != EvalError::none;
    };
    CHECK(skips({"good", "good", "bad"}));
    CHECK(skips({"good", "bad", "good"}));  // good is not computed again
    CHECK_FALSE(skips({"bad", "good", "good"}));
    CHECK(skips({"good", "bad", "bad"}));
    CHECK_FALSE(skips({"bad", "bad", "good"}));  // the failed variable is 0, and fails once
}

TEST_CASE("domain and range errors are told apart") {
    const auto error = [](const char* e) { return evaluate(e, ray_over(kFaultyLanguage)).error; };
    CHECK(error("sqrt(m8)") == EvalError::domain);
    CHECK(error("m8^.5") == EvalError::domain);
    CHECK(error("select(7*o,1,2)") == EvalError::domain);
    CHECK(error("o/z") == EvalError::range);
    CHECK(error("exp(800*o)") == EvalError::range);
    CHECK(error("z^-1") == EvalError::range);
    CHECK(error("o*1e308*10") == EvalError::none);
}

TEST_CASE("constants fold as Radiance folds them, rounding included") {
    const std::string x = "x = .3; y = .1;";
    CHECK(value_of("floor(x/.1)", x) == 3);  // x * (1/.1)
    CHECK(value_of("floor(x/y)", x) == 2);   // a true division
    CHECK(evaluate("floor(A1/A2)", {"", {.3, .1}, 0, straight_down()}).value == 2);
    // Sums are flattened in files, not in a scene's strings.
    CHECK(value_of("s", x + "s = x+1+x+2;") == (.3 + 3) + .3);
    CHECK(value_of("x+1+x+2", x) == ((.3 + 1) + .3) + 2);
    CHECK(value_of("s", x + "s = x*3*x*7;") == (.3 * 21) * .3);
    CHECK(value_of("x*3*x*7", x) == ((.3 * 3) * .3) * 7);
    CHECK(value_of("x+(y+x)", x) == .3 + (.1 + .3));
    CHECK(value_of("s", x + "s = x+(y+x);") == (.3 + .1) + .3);
    // Dropped with their errors.
    CHECK(evaluate("0*(1/z)", ray_over(kFaultyLanguage)).error == EvalError::none);
    CHECK(evaluate("(1/z)*0", ray_over(kFaultyLanguage)).error == EvalError::none);
    CHECK(evaluate("(1/z)^0", ray_over(kFaultyLanguage)).value == 1);
    CHECK(evaluate("0/(1/z)", ray_over(kFaultyLanguage)).error == EvalError::none);
    CHECK(complaint("PI(2)").find("undefined function") != std::string::npos);
}

TEST_CASE("select counts its cases at 0 and fails outside of them") {
    CHECK(value_of("select(-.5,5,6)") == 2);
    CHECK(value_of("select(o/2,5,6)", "o = 1;") == 5);
    CHECK(evaluate("select(-.6*o,5,6)", ray_over("o=1;")).error == EvalError::domain);
    CHECK(evaluate("select(2.5*o,5,6)", ray_over("o=1;")).error == EvalError::domain);
    CHECK(value_of("select(2.49*o,5,6)", "o = 1;") == 6);
    CHECK(value_of("select(0*Px-.4*Rdot,5,6)") == 2);
}

TEST_CASE("arguments are computed by need, once") {
    CHECK(value_of("first(7,undefinedname)", kLanguagePrelude) == 7);
    CHECK(complaint("second(7,undefinedname)", kLanguagePrelude) ==
          "scene.rad:7: undefinedname: undefined variable");
    CHECK(complaint("second(7)", kLanguagePrelude) ==
          "scene.rad:7: second`tt(): too few arguments");
    CHECK(value_of("first(7)", kLanguagePrelude) == 7);
    CHECK(value_of("first(7,8,undefinedname)", kLanguagePrelude) == 7);
    // The error of an argument is forgotten with its first use.
    const std::string late = "z = 0; o = 1; late(x) = x + sin(o) + x;";
    CHECK(evaluate("late(1/z)", ray_over(late)).error == EvalError::none);
    CHECK(evaluate("1/z+sin(o)+1/z", ray_over(late)).error == EvalError::range);
}

TEST_CASE("functions are passed by name through any number of levels") {
    const std::string text =
        kLanguagePrelude + "through(g,x) = app(g,x); deeper(h,x) = through(h,x)+h(x);";
    CHECK(value_of("deeper(fac,4)", text) == 48);
    CHECK(value_of("deeper(sqrt,16)", text) == 8);
    CHECK(value_of("through(first,7)", text) == 7);
    CHECK(complaint("app(x3,1)", text) == "scene.rad:7: f(): undefined function");
    CHECK(complaint("app(x3+1,1)", text) == "scene.rad:7: f(): argument not a function");
    CHECK(complaint("app(2,1)", text) == "scene.rad:7: f(): argument not a function");
    // And to functions that are called, not inlined.
    const std::string down = "down(f,n) = if(n-.5, f(n)+down(f,n-1), 0); sq2(x) = x*x;";
    CHECK(value_of("down(sq2,3*Rdot)", down) == 14);
    CHECK(value_of("down(sqrt,4*Rdot)", down) == rounded(1 + std::sqrt(2) + std::sqrt(3) + 2));
    CHECK(complaint("down(Rdot,3*Rdot)", down) == "scene.rad:7: f(): undefined function");
}

TEST_CASE("powers by constant halves agree with pow, and fail where it does") {
    for (int halves = -34; halves <= 34; ++halves) {
        std::ostringstream text;
        text << "(1.37*Rdot)^" << (halves < 0 ? "-" : "") << std::abs(halves) / 2.
             << std::setprecision(17);
        CAPTURE(text.str());
        CHECK(value_of(text.str(), "") == within(10 * kFewRoundings, std::pow(1.37, halves / 2.)));
    }
    CHECK(value_of("(Rdot-1)^.5", "") == 0);
    CHECK(value_of("(Rdot-1)^0", "") == 1);
    CHECK(value_of("7+(Rdot-1)^-1", "") == 7);  // an error: the value is 0
    CHECK(value_of("7+(Rdot-3)^.5", "") == 7);
    CHECK(value_of("(-2*Rdot)^3", "") == -8);
}

}  // namespace lightwalk::test
