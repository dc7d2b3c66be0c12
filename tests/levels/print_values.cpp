// Prints values of the function language to the last bit, a line each: "EXPRESSION POINT VALUE".
// Programs built for different processors must print the same.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/function/environment.h"
#include "core/function/program.h"

namespace lightwalk {
namespace {

constexpr std::size_t kPoints = 400;

const std::vector<std::string> kExpressions{
    "rand(Px)", "floor(Px)", "ceil(Py)", "sqrt(Px*Px+Py*Py)", "exp(Px)", "log(1e-9+Px*Px)",
    "log10(1e-9+Py*Py)", "sin(Px*Py)", "cos(Px*Pz)", "tan(Px)", "asin(Dx)", "acos(Dy)", "atan(Px)",
    "atan2(Px,Py)", "erf(Px/9)", "erfc(Py/9)", "noise3(Px,Py,Pz)", "noise3x(Px,Py,Pz)",
    "noise3y(Px,Py,Pz)", "noise3z(Px,Py,Pz)", "fnoise3(Px,Py,Pz)", "degrees(acos(Dz))",
    "(1+Px*Px)^1.7", "(1+Px*Px)^2.5", "(Px*Px)^.5", "Px^3", "min(Px,Py,Pz)", "max(Px,Py,Pz)",
    "if(Px-Py,Px/(1+Py*Py),Py-Px*Pz)", "Px*Py+Pz", "Px*Py-Pz*Px", "Px-Py*Pz+Px*Px*Py",
    // Turbulence, a sky with a sun, and a function that calls itself.
    "abs(fnoise3(Px,Py,Pz))+abs(fnoise3(2*Px,2*Py,2*Pz))/2+abs(fnoise3(4*Px,4*Py,4*Pz))/4",
    "(.91+10*exp(-3*acos(.3*Dx+.6*Dy+.74*Dz))+.45*Dz*Dz)*(1-exp(-.32/(abs(Dz)+.01)))",
    "series(12,Px/10)"};
constexpr const char* kDefinitions =
    "abs(x) = if(x, x, -x); series(n,x) = if(n-.5, x*series(n-1,x)/n+1, 1);"
    "degrees(x) = x / (PI/180);";

/// Directions all over the sphere, and points near and far that no memory of the last one helps.
std::vector<ChannelValues> rays() {
    std::vector<ChannelValues> all(kPoints);
    for (std::size_t i = 0; i < all.size(); ++i) {
        // Arithmetic alone, no library function: the same points wherever this runs.
        const auto t = static_cast<double>(i);
        const double u = 2 * std::abs(t * .6180339887 - std::floor(t * .6180339887)) - 1;
        const double v = 2 * std::abs(t * .7548776662 - std::floor(t * .7548776662)) - 1;
        const double w = 2 * std::abs(t * .5698402910 - std::floor(t * .5698402910)) - 1;
        const double length = std::sqrt(u * u + v * v + w * w);
        const std::array<double, 9> values{u / length, v / length, w / length, 0,      0,
                                           1,          17.3 * w,   10.7 * u,   3.1 * v};
        for (std::size_t c = 0; c < values.size(); ++c) all[i][c + 1] = values[c];
    }
    return all;
}

void print_values() {
    FunctionEnvironment environment;
    environment.load("values.cal", kDefinitions);
    const std::vector<ChannelValues> channels = rays();
    for (const std::string& expression : kExpressions) {
        const std::array<ExpressionRequest, 1> request{{{expression, -1}}};
        const Program program =
            environment.compile("values.cal", request, {}, 0, {"print_values", 1});
        const char* name = expression.c_str();
        EvalState state;
        for (std::size_t i = 0; i < channels.size(); ++i) {
            program.begin(state, channels[i]);
            state.clear_error();
            std::printf("%s %zu %a\n", name, i, program.evaluate(0, state));
        }
        if (!program.has_lanes()) continue;
        for (std::size_t i = 0; i + kLanes <= channels.size(); i += kLanes) {
            const LaneValues lanes =
                program.evaluate_lanes(0, std::span(channels).subspan(i, kLanes), state);
            for (std::size_t k = 0; k < kLanes; ++k) {
                if (lanes.has(k))
                    std::printf("%s %zu side by side %a\n", name, i + k, lanes.lanes.value[k]);
            }
        }
    }
}

}  // namespace
}  // namespace lightwalk

int main() {
    lightwalk::print_values();
}
