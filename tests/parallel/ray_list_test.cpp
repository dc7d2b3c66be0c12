#include "parallel/ray_list.h"

#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "tests/test_scene.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const std::string kFloor = R"(
void plastic grey 0 0 5 .5 .5 .5 .05 .2
void light lamp 0 0 3 10 10 10
grey polygon floor 0 0 12  -9 -9 0  9 -9 0  9 9 0  -9 9 0
lamp sphere bulb 0 0 4 0 0 5 .2
)";

struct Answer {
    Rgb value;
    double distance = 0;
    Vec3 point;
    bool hit = false;
    friend bool operator==(const Answer&, const Answer&) = default;
};

std::vector<Answer> trace(TestScene& scene, const std::vector<RayQuery>& queries,
                          const RayListOptions& options, ExecutorKind kind = ExecutorKind::serial,
                          int workers = 1, std::uint64_t first = 0) {
    const std::unique_ptr<Executor> executor = make_executor(kind, workers);
    WorkerContexts contexts(scene.tracer, scene.warnings, executor->concurrency());
    std::vector<Answer> answers(queries.size());
    trace_ray_list(scene.tracer, contexts, queries, first, options, *executor, kRaysPerTask,
                   [&](std::size_t i, int, const Ray& ray, const Hit&) {
                       answers[i] = {ray.value, ray.hit.t, ray.hit.position, ray.hit.exists()};
                   });
    return answers;
}

RenderOptions noisy_rays() {
    RenderOptions options = TestScene::exact();
    options.source_jitter = 1;
    options.specular_samples = 1;
    options.specular_threshold = 0;
    return options;
}

}  // namespace

TEST_CASE("answers come in order and do not depend on the workers") {
    TestScene scene(kFloor, noisy_rays());
    std::vector<RayQuery> queries;
    for (int i = 0; i < 1000; ++i) queries.push_back({{0.01 * i - 5, 0, 3}, {0, 0.001 * i, -1}});
    const std::vector<Answer> expected = trace(scene, queries, {});
    for (const ExecutorKind kind : {ExecutorKind::threads, kDefaultExecutor}) {
        CHECK(trace(scene, queries, {}, kind, 5) == expected);
    }
    // Batches do not show either: rays 500... of the input are the same in a list of their own.
    const std::vector<RayQuery> rest(queries.begin() + 500, queries.end());
    CHECK(trace(scene, rest, {}, ExecutorKind::serial, 1, 500) ==
          std::vector<Answer>(expected.begin() + 500, expected.end()));
}

TEST_CASE("equal rays of one input draw different random numbers, unless nothing is sampled") {
    const std::vector<RayQuery> same(8, RayQuery{{0, 0, 3}, {0.1, 0, -1}});
    TestScene random(kFloor, noisy_rays());
    const std::vector<Answer> a = trace(random, same, {});
    CHECK_FALSE(a[0] == a[1]);
    TestScene exact(kFloor);
    const std::vector<Answer> b = trace(exact, same, {});
    CHECK(b[0] == b[1]);
}

TEST_CASE("a zero direction answers like a ray that hits nothing") {
    TestScene scene(kFloor);
    const std::vector<Answer> answers = trace(scene, {{{1, 2, 3}, {0, 0, 0}}}, {});
    CHECK_FALSE(answers[0].hit);
    CHECK(answers[0].value == Rgb(0, 0, 0));
    CHECK(answers[0].point == Vec3{1, 2, 3});
    CHECK(answers[0].distance == 1e10);
}

TEST_CASE("a direction's length can limit its ray: beyond it is nothing, at the end point") {
    TestScene scene(kFloor);
    RayListOptions limited;
    limited.limit_by_length = true;
    const std::vector<Answer> answers =
        trace(scene, {{{2, 0, 3}, {0, 0, -2}}, {{2, 0, 3}, {0, 0, -4}}}, limited);
    CHECK_FALSE(answers[0].hit);
    CHECK(answers[0].point == Vec3{2, 0, 1});
    CHECK(answers[1].hit);
    CHECK(answers[1].distance == rounded(3));
}

TEST_CASE("without shading the nearest hit alone is found") {
    TestScene scene(kFloor);
    RayListOptions cast;
    cast.shade = false;
    const std::vector<Answer> answers =
        trace(scene, {{{2, 0, 3}, {0, 0, -1}}, {{2, 0, 3}, {0, 0, 1}}}, cast);
    CHECK(answers[0].hit);
    CHECK(answers[0].distance == rounded(3));
    CHECK(answers[0].value == Rgb(0, 0, 0));
    CHECK_FALSE(answers[1].hit);
}

TEST_CASE(
    "a sensor facing a small sun of radiance L and solid angle W receives L W, facing away "
    "nothing") {
    TestScene scene("void light sun 0 0 3 7 7 7\nsun source s 0 0 4 0 0 1 2\n");
    RayListOptions sensor;
    sensor.sensor = true;
    const std::vector<Answer> answers =
        trace(scene, {{{0, 0, 0}, {0, 0, 3}}, {{0, 0, 0}, {0, 0, -1}}}, sensor);
    const double omega = 2 * kPi * (1 - std::cos(kPi / 180));  // the sun's two degrees
    CHECK(static_cast<double>(answers[0].value.g) == float_rounded(7 * omega));
    CHECK(answers[1].value.g == 0);
}
