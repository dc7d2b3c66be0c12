// Do 95 % intervals hold the truth 95 times in 100? Over 1,000 seeds, for direct light from lamps
// whose places are random, and for indirect light without and with a cache. Each test finds
// intervals that are too narrow: half as wide, or of answers that are not independent.
#include <doctest/doctest.h>

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/session/replications.h"
#include "core/math/student_t.h"
#include "parallel/executor.h"
#include "tests/core/theory/formulas.h"
#include "tests/core/trace/white_room.h"
#include "tests/one_thread.h"
#include "tests/test_scene.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

constexpr int kSeeds = 1000;
constexpr double kLeast = .93, kMost = .97;
/// Of seeds that no test asks for: those of long runs.
constexpr std::uint64_t kTruthSeeds = 1 << 20;

/// Irradiance at sensors that face up, of the green channel [W/m2].
struct Question {
    LoadedScene scene;
    RendererOptions options;
    std::vector<RayQuery> sensors;
};

Question question_of(const std::string& text, const std::vector<Vec3>& sensors) {
    SceneSource source;
    source.bytes = text;
    source.threads = 1;
    Question question{LoadedScene(source), {}, {}};
    question.options.threads = 1;
    question.options.executor = ExecutorKind::serial;
    question.options.rays.sensor = true;
    question.options.light = TestScene::exact();
    // Thousands of renderers answer a few rays each: stacks for batches would cost more than rays.
    question.options.light.ablation.batches = false;
    for (const Vec3& at : sensors) question.sensors.push_back({at, {0, 0, 1}});
    return question;
}

/// Answers to a question by `count` renderers, of each sensor as many numbers.
std::vector<std::vector<double>> answers_to(const Question& question, std::uint64_t seed,
                                            int count) {
    RendererOptions options = question.options;
    options.light.seed = seed;
    std::vector<Renderer> renderers = open_replications(question.scene.compiled(), options, count);
    std::vector<std::vector<double>> answers(question.sensors.size());
    const auto all = answer_by_all(renderers, {question.sensors});
    REQUIRE(all.has_value());
    for (const RayBytes& one : *all) {
        const std::vector<RayResult> found = one.answers();
        for (std::size_t i = 0; i < found.size(); ++i)
            answers[i].push_back(static_cast<double>(found[i].radiance.g));
    }
    return answers;
}

/// The means of 8 * `runs` answers of the same kind.
std::vector<double> long_run(const Question& question, int runs) {
    std::vector<double> means(question.sensors.size());
    for (int run = 0; run < runs; ++run) {
        const auto answers = answers_to(question, kTruthSeeds + static_cast<std::uint64_t>(run), 8);
        for (std::size_t i = 0; i < means.size(); ++i)
            means[i] += mean_interval(answers[i]).mean / runs;
    }
    return means;
}

/// Shares of the intervals that hold the truth.
struct Held {
    double whole = 0;      ///< as they are
    double half = 0;       ///< half as wide
    double dependent = 0;  ///< of answers each of which is counted four times
    double width = 0;      ///< mean half-width, in parts of the truth
};

Held intervals_held(const Question& question, const std::vector<double>& truth, int count) {
    Held held;
    const double one = 1.0 / kSeeds / static_cast<double>(truth.size());
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
        const std::vector<std::vector<double>> answers = answers_to(question, seed, count);
        for (std::size_t i = 0; i < truth.size(); ++i) {
            const MeanInterval interval = mean_interval(answers[i]);
            std::vector<double> repeated;
            for (int k = 0; k < 4; ++k)
                repeated.insert(repeated.end(), answers[i].begin(), answers[i].end());
            const double off = std::abs(interval.mean - truth[i]);
            held.whole += off <= interval.half_width ? one : 0;
            held.half += off <= interval.half_width / 2 ? one : 0;
            held.dependent += off <= mean_interval(repeated).half_width ? one : 0;
            held.width += interval.half_width / truth[i] * one;
        }
    }
    return held;
}

void check_held(const Held& held) {
    CAPTURE(held.whole);
    CAPTURE(held.half);
    CAPTURE(held.dependent);
    CAPTURE(held.width);
    CHECK(held.whole > kLeast);
    CHECK(held.whole < kMost);
    CHECK(held.half < kLeast);
    CHECK(held.dependent < kLeast);
}

std::string numbers_of(const std::vector<Vec3>& corners) {
    std::string text = " 0 0 " + std::to_string(3 * corners.size());
    for (const Vec3& c : corners)
        for (const double v : {c.x, c.y, c.z}) text += ' ' + std::to_string(v);
    return text + '\n';
}

/// In a white room, where two bounces are followed.
Question indirect_question(double accuracy, int samples) {
    Question question = question_of(kWhiteRoom, {{.8, .3, .5}, {-1.2, -1, .9}});
    RenderOptions& light = question.options.light;
    light.ambient_bounces = 2;
    light.ambient_accuracy = accuracy;
    light.ambient_divisions = samples;
    light.ambient_super_samples = 0;
    return question;
}

}  // namespace

TEST_CASE("intervals: of direct light by jitter, 95 % hold what Lambert's formula says" *
          one_thread) {
    // Two lamps; a board under one of them covers a part of it.
    const auto panel = rectangle({-1, -1, 3}, {0, 2, 0}, {2, 0, 0});
    const auto strip = rectangle({2, -1, 2}, {0, 2, 0}, {.5, 0, 0});
    const auto board = rectangle({-.5, -.4, 1}, {.4, 0, 0}, {0, 1, 0});
    const std::vector<Vec3> sensors{{0, 0, 0}, {.5, .3, 0}, {3, 2, 0}};
    Question question = question_of(
        "void light lamp 0 0 3 1 1 1\nvoid plastic black 0 0 5 0 0 0 0 0\nlamp polygon panel" +
            numbers_of(panel) + "lamp polygon strip" + numbers_of(strip) + "black polygon board" +
            numbers_of(board),
        sensors);
    question.options.light.source_jitter = 1;
    question.options.light.source_subdivision = .4;
    std::vector<double> truth;
    for (const Vec3& at : sensors) {
        const Vec3 up{0, 0, 1};
        // What the board hides of the panel: its shadow there, seen from the sensor.
        const auto shadow = [&](const Vec3& corner) { return at + 3 * (corner - at); };
        Vec3 lower = shadow(board[0]), upper = shadow(board[2]);
        lower = {std::max(lower.x, -1.0), std::max(lower.y, -1.0), 3};
        upper = {std::min(upper.x, 1.0), std::min(upper.y, 1.0), 3};
        double hidden = 0;
        if (lower.x < upper.x && lower.y < upper.y)
            hidden = lambert_factor(
                at, up, rectangle(lower, {0, upper.y - lower.y, 0}, {upper.x - lower.x, 0, 0}));
        truth.push_back(kPi *
                        (lambert_factor(at, up, panel) + lambert_factor(at, up, strip) - hidden));
    }
    check_held(intervals_held(question, truth, 8));
}

TEST_CASE("intervals: of two bounces without a cache, 95 % hold the mean of a long run" *
          one_thread) {
    const Question question = indirect_question(0, 9);
    check_held(intervals_held(question, long_run(question, 1000), 4));
}

TEST_CASE("intervals: of two bounces with a cache, 95 % hold the mean of such caches" *
          one_thread) {
    // What values are interpolated over is off by as much in all of them, which no spread of
    // answers can show: the truth is that of the same method.
    const Question question = indirect_question(1.5, 9);
    check_held(intervals_held(question, long_run(question, 60), 3));
}
