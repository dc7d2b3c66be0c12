// Time of one evaluation of the function language: what a hit costs a pattern.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/function/environment.h"
#include "core/function/program.h"

namespace lightwalk {
namespace {

std::optional<std::string> library_file(const std::string& name) {
    std::ifstream in(std::string(LIGHTWALK_SHARED) + "/scenes/lib/" + name);
    if (!in) return std::nullopt;
    return std::string(std::istreambuf_iterator<char>(in), {});
}

/// Directions all over the sphere, and points that jump about: nothing can be remembered, and
/// branches vary. With `stride` [m] the points are those of neighbouring pixels instead.
std::vector<ChannelValues> rays(double stride) {
    std::vector<ChannelValues> all(1024);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const double t = static_cast<double>(i);
        const double azimuth = 2.399963 * t, z = std::sin(0.7 * t), r = std::sqrt(1 - z * z);
        const std::array<double, 9> values{
            r * std::cos(azimuth), r * std::sin(azimuth),    z,       0, 0, 1,
            10.37 * std::cos(t),   7.91 * std::sin(1.3 * t), 0.61 * t};
        for (std::size_t c = 0; c < values.size(); ++c) all[i][c + 1] = values[c];
        if (stride <= 0) continue;
        all[i][7] = stride * t;
        all[i][8] = 3.7 + stride * .3 * t;
        all[i][9] = 1.3;
    }
    return all;
}

void evaluate(benchmark::State& state, const std::string& file, const std::string& text,
              const std::vector<std::string>& expressions, const std::vector<double>& reals,
              double stride = 0) {
    FunctionEnvironment environment;
    environment.load(file, text);
    std::vector<ExpressionRequest> requests;
    requests.reserve(expressions.size());
    for (const std::string& e : expressions) requests.push_back({e, -1});
    const Program program = environment.compile(file, requests, reals, 0, {"bench.rad", 1});
    const std::vector<ChannelValues> channels = rays(stride);
    EvalState eval;
    std::size_t i = 0;
    for ([[maybe_unused]] auto _ : state) {
        program.begin(eval, channels[i++ & 1023u]);
        eval.clear_error();
        double sum = 0;
        for (std::size_t k = 0; k < expressions.size(); ++k) sum += program.evaluate(k, eval);
        benchmark::DoNotOptimize(sum);
    }
}

void evaluate_file(benchmark::State& state, const std::string& file, const std::string& expression,
                   const std::vector<double>& reals, double stride = 0) {
    const std::optional<std::string> text = library_file(file);
    if (!text) {
        state.SkipWithError("the reference library is not here");
        return;
    }
    evaluate(state, file, *text, {expression}, reals, stride);
}

// A clear sky of 21 June, as gensky writes it.
const std::vector<double> kSky{1, 9.77, 6.08, 0.638, -0.0687, -0.299, 0.9519};

const std::vector<ExpressionRequest> kSkyRequest{{"skybr", -1}};

/// The sky's file, loaded; nothing, and the benchmark is skipped, where it is missing.
std::optional<FunctionEnvironment> sky_file(benchmark::State& state) {
    const std::optional<std::string> text = library_file("skybright.cal");
    if (!text) {
        state.SkipWithError("the reference library is not here");
        return std::nullopt;
    }
    std::optional<FunctionEnvironment> environment(std::in_place);
    environment->load("skybright.cal", *text);
    return environment;
}

Program compiled_sky(FunctionEnvironment& environment) {
    return environment.compile("skybright.cal", kSkyRequest, kSky, 0, {"bench.rad", 1});
}

void clear_sky(benchmark::State& state) {
    evaluate_file(state, "skybright.cal", "skybr", kSky);
}
/// The sky for windows that all look upwards: so many at a time side by side; 0: one after the
/// other. The time is that of one value.
void clear_sky_upwards(benchmark::State& state) {
    std::optional<FunctionEnvironment> environment = sky_file(state);
    if (!environment) return;
    const Program program = compiled_sky(*environment);
    std::vector<ChannelValues> channels = rays(0);
    for (ChannelValues& c : channels) c[3] = 0.02 + 0.9 * std::abs(c[3]);
    const auto side_by_side = static_cast<std::size_t>(state.range(0));
    const std::size_t step = std::max<std::size_t>(side_by_side, 1);
    EvalState eval;
    std::size_t i = 0;
    while (state.KeepRunningBatch(static_cast<benchmark::IterationCount>(step))) {
        if (side_by_side == 0) {
            program.begin(eval, channels[i]);
            eval.clear_error();
            benchmark::DoNotOptimize(program.evaluate(0, eval));
        } else {
            auto values = program.evaluate_lanes(0, std::span(channels).subspan(i, step), eval);
            if (values.done != (1U << step) - 1) state.SkipWithError("the lanes parted");
            benchmark::DoNotOptimize(values);
        }
        i = (i + step) % 1000;
    }
}
void wood_zgrain(benchmark::State& state) {
    evaluate_file(state, "woodpat.cal", "zgrain", {.3});
}
void wood_xgrain(benchmark::State& state) {
    evaluate_file(state, "woodpat.cal", "xgrain", {.3});
}
void wood_neighbours(benchmark::State& state) {
    evaluate_file(state, "woodpat.cal", "zgrain", {.3}, .05);  // 3 mm on the cabin's wall
}
void marble(benchmark::State& state) {
    evaluate_file(state, "marble.cal", "marble", {.5});
}
void constant(benchmark::State& state) {
    evaluate(state, "t.cal", "", {"1"}, {});
}
void arithmetic(benchmark::State& state) {
    evaluate(state, "t.cal", "", {"Px*Py+Pz"}, {});
}
void noise(benchmark::State& state) {
    evaluate(state, "t.cal", "", {"noise3(Px,Py,Pz)"}, {});
}
void fractal_noise(benchmark::State& state) {
    evaluate(state, "t.cal", "", {"fnoise3(Px,Py,Pz)"}, {});
}
void noise_texture(benchmark::State& state) {
    const std::string text =
        "dx = .1*noise3x(Px,Py,Pz); dy = .1*noise3y(Px,Py,Pz); dz = .1*noise3z(Px,Py,Pz);";
    evaluate(state, "t.cal", text, {"dx", "dy", "dz"}, {});
}
void recursion(benchmark::State& state) {
    evaluate(state, "t.cal", "f(n,x) = if(n-.5, x*f(n-1,x)+1, 1);", {"f(Pz/Pz*10,Px)"}, {});
}
void compile_sky(benchmark::State& state) {
    std::optional<FunctionEnvironment> environment = sky_file(state);
    if (!environment) return;
    for ([[maybe_unused]] auto _ : state)
        benchmark::DoNotOptimize(compiled_sky(*environment).outputs());
}
void load_initial_definitions(benchmark::State& state) {
    for ([[maybe_unused]] auto _ : state) {
        const FunctionEnvironment environment;
        benchmark::DoNotOptimize(environment.is_function("", "Acos"));
    }
}

BENCHMARK(constant);
BENCHMARK(arithmetic);
BENCHMARK(noise);
BENCHMARK(fractal_noise);
BENCHMARK(noise_texture);
BENCHMARK(clear_sky);
BENCHMARK(clear_sky_upwards)->Arg(0)->Arg(2)->Arg(kLanes);
BENCHMARK(wood_zgrain);
BENCHMARK(wood_xgrain);
BENCHMARK(wood_neighbours);
BENCHMARK(marble);
BENCHMARK(recursion);
BENCHMARK(compile_sky);
BENCHMARK(load_initial_definitions);

}  // namespace
}  // namespace lightwalk

BENCHMARK_MAIN();
