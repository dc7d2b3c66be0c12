// Names: contexts, qualified names, redefinition, and where errors are reported.
#include <doctest/doctest.h>

#include <array>
#include <string>

#include "tests/core/function/evaluate.h"
#include "tests/tolerance.h"

namespace lightwalk::test {
namespace {

double value_in(const FunctionEnvironment& environment, const std::string& file,
                const std::string& expression) {
    const std::array<ExpressionRequest, 1> request{ExpressionRequest{expression, -1}};
    const Program program = environment.compile(file, request, {}, 0, {"scene.rad", 7});
    EvalState state;
    const ChannelValues channels = straight_down();
    program.begin(state, channels);
    return program.evaluate(0, state);
}

std::string complaint_in(const FunctionEnvironment& environment, const std::string& file,
                         const std::string& expression) {
    try {
        (void)value_in(environment, file, expression);
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

std::string load_complaint(const std::string& text) {
    FunctionEnvironment environment;
    try {
        environment.load("lib/a.cal", text);
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

}  // namespace

TEST_CASE("a file's names are its own") {
    FunctionEnvironment environment;
    environment.load("a.cal", "v = 1; f(x) = x+v;");
    environment.load("b.cal", "v = 2; f(x) = x*v; abs(x) = 77;");
    CHECK(value_in(environment, "a.cal", "v") == 1);
    CHECK(value_in(environment, "b.cal", "v") == 2);
    CHECK(value_in(environment, "a.cal", "f(10)") == 11);
    CHECK(value_in(environment, "b.cal", "f(10)") == 20);
    CHECK(value_in(environment, "b.cal", "abs(-1)") == 77);
    CHECK(value_in(environment, "a.cal", "abs(-1)") == 1);
    CHECK(complaint_in(environment, ".", "v") == "scene.rad:7: v: undefined variable");
}

TEST_CASE("backquotes say which context a name is of") {
    FunctionEnvironment environment;
    environment.load("a1.cal", "q = 5; shared` = 6; PI = 3; own = `PI; global = PI`;");
    environment.load("a2.cal", "other = q`a1 + 1; s = shared;");
    environment.load("x`inner`outer.cal", "q = 1;");
    CHECK(value_in(environment, ".", "q`a1") == 5);
    CHECK(value_in(environment, "a2.cal", "other") == 6);
    CHECK(value_in(environment, "a2.cal", "s") == 6);
    CHECK(value_in(environment, "a1.cal", "own") == 3);
    CHECK(value_in(environment, "a1.cal", "global") == rounded(3.141592653589793));
    CHECK(complaint_in(environment, "a2.cal", "`shared") ==
          "scene.rad:7: `shared: undefined variable");
    CHECK(complaint_in(environment, "a2.cal", "q`") == "scene.rad:7: q`: undefined variable");
    CHECK(complaint_in(environment, "a2.cal", "`sin(1)") ==
          "scene.rad:7: `sin(): undefined function");
    CHECK(value_in(environment, "a2.cal", "sin`(0)") == 0);
    // Components of a context go from the front.
    environment.load("y`outer.cal", "r = 9;");
    CHECK(value_in(environment, "x`y`outer.cal", "r") == 9);
}

TEST_CASE("the context is the file's name, without what no name may have") {
    FunctionEnvironment environment;
    environment.load("lib/b-1.CAL", "v = 1;");
    CHECK(environment.loaded("lib/b-1.cal"));
    CHECK(environment.loaded("lib/b-1"));
    CHECK(environment.loaded("."));
    CHECK_FALSE(environment.loaded("b-1.cal"));
    CHECK_FALSE(environment.loaded("./lib/b-1.cal"));
    CHECK(value_in(environment, ".", "v`lib_b_1") == 1);
    environment.load(".cal", "v = 2;");  // a name of the suffix alone keeps it
    CHECK(value_in(environment, ".cal", "v`.cal") == 2);
}

TEST_CASE("uses before a redefinition keep what they found, uses after it see the new one") {
    FunctionEnvironment environment;
    environment.load("a.cal", "early = PI; DEGREE = 7; late = DEGREE; PI = 3; later = PI;");
    CHECK(value_in(environment, "a.cal", "early") == rounded(3.141592653589793));
    CHECK(value_in(environment, "a.cal", "later") == 3);
    CHECK(value_in(environment, "a.cal", "late") == 7);
    environment.load(
        "b.cal", "early(x) = sq(x); sq(x) = 100; late(x) = sq(x); early2 = sin(0); sin(x) = 4;");
    CHECK(value_in(environment, "b.cal", "early(3)") == 9);
    CHECK(value_in(environment, "b.cal", "late(3)") == 100);
    CHECK(value_in(environment, "b.cal", "early2") == 0);
    CHECK(value_in(environment, "b.cal", "sin(0)") == 4);
    environment.load("c.cal",
                     "k = 1; q = k; k = 2; c : 1; d = c; c : 2; e = c; g = h(1); h(x) = x+1;");
    CHECK(value_in(environment, "c.cal", "q") == 2);  // by reference
    CHECK(value_in(environment, "c.cal", "d") == 1);  // by value
    CHECK(value_in(environment, "c.cal", "e") == 2);
    CHECK(value_in(environment, "c.cal", "g") == 2);
}

TEST_CASE("variables and functions share their names") {
    FunctionEnvironment environment;
    environment.load("a.cal", "v = 1; u = v; v(x) = x; f(x) = x; g(y) = f(y); f = 3;");
    CHECK(complaint_in(environment, "a.cal", "u") == "scene.rad:7: v: undefined variable");
    CHECK(complaint_in(environment, "a.cal", "g(1)") == "scene.rad:7: f(): undefined function");
    // A variable does not hide the built-in function of its name, but keeps it from being folded.
    environment.load("b.cal", "sqrt` = 5;");
    CHECK(value_in(environment, "b.cal", "sqrt(16)+sqrt") == 9);
}

TEST_CASE("parameters hide names, and the first of two equal ones wins") {
    FunctionEnvironment environment;
    environment.load("a.cal", "v = 1; f(v) = v; g(a,a) = a; h(PI) = PI+PI`; s(sin,x) = sin(x);");
    CHECK(value_in(environment, "a.cal", "f(9)") == 9);
    CHECK(value_in(environment, "a.cal", "g(1,2)") == 1);
    CHECK(value_in(environment, "a.cal", "h(1)") == rounded(4.141592653589793));
    CHECK(value_in(environment, "a.cal", "s(sqrt,16)") == 4);
}

TEST_CASE("functions are counted by their parameters") {
    FunctionEnvironment environment;
    environment.load("a.cal", "f(a,b) = a; grey(x) = x; v = 1;");
    CHECK(environment.parameters("a.cal", "f") == 2);
    CHECK(environment.parameters("a.cal", "grey") == 1);
    CHECK(environment.parameters(".", "grey") == 3);
    CHECK(environment.parameters(".", "noop") == 1);
    CHECK(environment.parameters(".", "sin") == 1);
    CHECK(environment.parameters(".", "max") == 1);
    CHECK(environment.parameters(".", "noise3") == 3);
    CHECK(environment.parameters("a.cal", "v") == 0);
    CHECK(environment.parameters(".", "f") == 0);
    CHECK(environment.parameters(".", "") == 0);
    CHECK(environment.is_function("a.cal", "f"));
    CHECK(environment.is_function(".", "atan2"));
    CHECK_FALSE(environment.is_function("a.cal", "v"));
}

TEST_CASE("errors in a file say on which line") {
    CHECK(load_complaint("a = 1;\nb = 2 +;\n") ==
          "lib/a.cal:2: syntax error: found ';', expected a number, a name or '('");
    CHECK(load_complaint("a = 1;\n{ two\nlines }\nb = ;") ==
          "lib/a.cal:4: syntax error: found ';', expected a number, a name or '('");
    CHECK(load_complaint("\n\na = 1 b = 2;") ==
          "lib/a.cal:3: syntax error: found 'b', expected an operator or ';'");
    CHECK(load_complaint("a = (1;\n") ==
          "lib/a.cal:1: syntax error: found ';', expected an operator or ')'");
    CHECK(load_complaint("a = sin(1;\n") ==
          "lib/a.cal:1: syntax error: found ';', expected an operator, ',' or ')'");
    CHECK(load_complaint("\n$1 = 3;") ==
          "lib/a.cal:2: illegal variable name: only a name can be defined");
    CHECK(load_complaint("3 = 3;") ==
          "lib/a.cal:1: syntax error: found '3', expected a definition");
    CHECK(load_complaint("a 3;") == "lib/a.cal:1: syntax error: found '3', expected '=' or ':'");
    CHECK(load_complaint("f(1) = 3;") ==
          "lib/a.cal:1: syntax error: found '1', expected the name of a parameter");
    CHECK(load_complaint("f(a`b) = 3;") ==
          "lib/a.cal:1: illegal parameter name \"a`b\", expected one without a backquote");
    CHECK(load_complaint("f(a;b) = 3;") ==
          "lib/a.cal:1: syntax error: found ';', expected ',' or ')' in a list of parameters");
    CHECK(load_complaint("a = 1;\n{ b {} = 2;\n") ==
          "lib/a.cal:2: '}' expected: this comment does not end");
    CHECK(load_complaint("a =\n1/0;") == "lib/a.cal:2: divide by zero constant");
    CHECK(load_complaint("a = 0^-1;") == "lib/a.cal:1: bad constant expression: illegal power");
    CHECK(load_complaint("\na = sqrt(-1);") ==
          "lib/a.cal:2: bad constant expression: domain error in sqrt");
    CHECK(load_complaint("k : Px;\nf(x) : k*x;") ==
          "lib/a.cal:2: ray parameter used in constant expression");
    CHECK(load_complaint("f(x) : x*Px;\na = f(2);") ==
          "lib/a.cal:2: ray parameter used in constant expression");
    CHECK(load_complaint("k : A1;\n\na = k;") ==
          "lib/a.cal:3: bad call to arg(n): it has no value in a constant expression");
    CHECK(load_complaint("a = 2;; ;b = 3") == "");
    CHECK(load_complaint("") == "");
}

TEST_CASE("an error leaves what was defined before it, but the file does not count as loaded") {
    FunctionEnvironment environment;
    CHECK_THROWS_AS(environment.load("a.cal", "v = 1; w = ;"), InputError);
    CHECK_FALSE(environment.loaded("a.cal"));
    environment.load("a.cal", "v = 2; w = 3;");
    CHECK(value_in(environment, "a.cal", "v+w") == 5);
}

TEST_CASE("generators have the core library and no ray") {
    FunctionEnvironment environment(FunctionEnvironment::Library::generator);
    environment.define("r(t) = 1+t/2; x(s,t) = r(t)*cos(2*PI*s);", {"gensurf", 0});
    const std::array<ExpressionRequest, 1> request{ExpressionRequest{"x", 2}};
    const Program program = environment.compile(".", request, {}, 0, {"gensurf", 0});
    EvalState state;
    const ChannelValues channels{};
    program.begin(state, channels);
    CHECK(program.call(0, std::array<double, 2>{0.0, 1.0}, state) == 1.5);
    CHECK(program.call(0, std::array<double, 2>{0.5, 2.0}, state) == rounded(-2));
    CHECK(value_in(environment, ".",
                   "hermite(0,1,2,3,.25)+bezier(0,1,2,3,.25)+bspline(0,1,2,3,.25)") ==
          rounded(.296875 + .75 + 1.25));
    CHECK(complaint_in(environment, ".", "noise3(1,2,3)") ==
          "scene.rad:7: noise3(): undefined function");
    CHECK(complaint_in(environment, ".", "abs(1)") == "scene.rad:7: abs(): undefined function");
    CHECK(complaint_in(environment, ".", "Px") == "scene.rad:7: Px: undefined variable");
    CHECK(complaint_in(environment, ".", "$7") ==
          "scene.rad:7: illegal channel $7: there is no ray here");
    try {
        environment.define("a = ;", {"gensurf", 0});
        FAIL("accepted");
    } catch (const InputError& error) {
        CHECK(std::string(error.what()) ==
              "gensurf: syntax error: found ';', expected a number, a name or '('");
    }
}

TEST_CASE("function environment: the same request shares a program, unless it can throw") {
    FunctionEnvironment environment;
    environment.load("f.cal", "v = A1 * Px; w = unknown_name; f(x) = if(x, f(x - 1), A1);");
    const auto program = [&](const char* text, double real) {
        const ExpressionRequest request[] = {{text, -1}};
        const double reals[] = {real};
        return environment.shared_program("f.cal", request, reals, 0, {"scene.rad", 7});
    };
    CHECK(program("v", 2) == program("v", 2));
    CHECK_FALSE(program("v", 2) == program("v", 3));
    CHECK_FALSE(program("v", 2) == program("v + 0", 2));
    CHECK_FALSE(program("v", 2).can_throw());
    for (const char* text : {"w", "f(Px)"}) {
        CAPTURE(text);
        CHECK(program(text, 2).can_throw());
        CHECK_FALSE(program(text, 2) == program(text, 2));
    }
    const Program before = program("v", 2);
    environment.load("g.cal", "v = 3;");
    environment.define("A2 = 4;", {"scene.rad", 1});
    CHECK_FALSE(program("v", 2) == before);
}

}  // namespace lightwalk::test
