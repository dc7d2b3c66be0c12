// Functions by recursion whose values for small integers are known.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "core/error.h"
#include "tests/core/function/evaluate.h"

namespace lightwalk::test {
namespace {

/// An expression of Rdot, and what evaluating it takes.
struct Traced {
    Program program;
    EvalState state;

    Traced(const std::string& expression, const std::string& definitions) {
        FunctionEnvironment environment;
        environment.load("tt.cal", definitions);
        const ExpressionRequest request{expression, -1};
        program = environment.compile("tt.cal", {&request, 1}, {}, 0, {"scene.rad", 7});
    }
    double at(double x, double dz = -1) {
        ChannelValues channels = straight_down();
        set(channels, Channel::Rdot, x);
        set(channels, Channel::Dz, dz);
        program.begin(state, channels);
        state.clear_error();
        return program.evaluate(0, state);
    }
    std::uint64_t operations(double x) {
        (void)at(x);
        return state.operations;
    }
};

const std::string kSum = "sum(n) = if(n-.5, n + sum(n-1), 0);";

}  // namespace

TEST_CASE("recursive functions of integers have the values of recursion, without it") {
    Traced sum("sum(Rdot)", kSum);
    for (int n = 0; n < 400; ++n) CHECK(sum.at(n) == n * (n + 1) / 2);
    CHECK(sum.at(2.5) == 2.5 + 1.5);
    CHECK(sum.at(-3) == 0);
    CHECK(sum.at(-0.0) == 0);
    CHECK(sum.operations(200) == 0);
    CHECK(sum.operations(200.5) > 200);
    CHECK(sum.operations(300) > sum.operations(256));
}

TEST_CASE("the sign of zero is told apart where it matters") {
    Traced f("f(Rdot)", "f(x) = if(x-.5, f(x-1), atan2(x, -1));");
    CHECK(f.at(0.0) == std::atan2(0.0, -1.0));
    CHECK(f.at(-0.0) == std::atan2(-0.0, -1.0));
}

TEST_CASE("what depends on more than its argument is evaluated for each ray") {
    Traced of_ray("sum(Rdot)", "sum(n) = if(n-.5, Dz + sum(n-1), 0);");
    CHECK(of_ray.at(4, -1) == -4);
    CHECK(of_ray.at(4, 2) == 8);
    Traced through("sum(Rdot)", "step(x) = if(x-100, step(x-1), v); v = Dz;" +
                                    std::string("sum(n) = if(n-.5, step(n) + sum(n-1), 0);"));
    CHECK(through.at(4, -1) == -4);
    CHECK(through.at(4, 2) == 8);
    Traced of_two("f(Rdot, Dz)", "f(n, k) = if(n-.5, k + f(n-1, k), 0);");
    CHECK(of_two.at(4, -1) == -4);
    CHECK(of_two.at(4, 2) == 8);
}

TEST_CASE("numeric errors and recursion without end are met as before") {
    Traced roots("sum(Rdot)", "sum(n) = if(n-.5, sqrt(3.5-n) + sum(n-1), 0);");
    CHECK(roots.at(2) == std::sqrt(1.5) + (std::sqrt(2.5) + 0));
    CHECK(roots.state.error == EvalError::none);
    (void)roots.at(5);
    CHECK(roots.state.warnings > 0);
    Traced factorial("f(Rdot)", "f(n) = if(n-1.5, n*f(n-1), 1);");
    CHECK(factorial.at(5) == 120);
    CHECK(factorial.operations(5) == 0);
    CHECK(factorial.at(200) == 0);
    CHECK(factorial.state.error == EvalError::range);

    Traced endless("f(Rdot)", "f(x) = if(x-3, 1, f(x-1));");
    CHECK(endless.at(4) == 1);
    CHECK_THROWS_AS((void)endless.at(2), InputError);
}

}  // namespace lightwalk::test
