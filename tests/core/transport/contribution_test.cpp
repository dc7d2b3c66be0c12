#include "core/transport/contribution.h"

#include <doctest/doctest.h>

#include <map>
#include <string>

#include "parallel/fibers/context_fibers.h"
#include "tests/every_material.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

/// Adds the terms up, by the emitter's modifier; coefficients only where something is sent.
class ModifierSums final : public ContributionSink {
  public:
    struct Sum {
        Rgb coefficient, value;
    };
    explicit ModifierSums(const Scene& scene) : scene_(scene) {}
    void add(const Contribution& term) override {
        Sum& sum = sums[term.modifier == kVoid ? "void" : scene_.modifier(term.modifier).name];
        if (term.value != Rgb{}) sum.coefficient += term.coefficient;
        sum.value += term.value;
    }
    [[nodiscard]] Rgb total() const {
        Rgb total;
        for (const auto& [name, sum] : sums) total += sum.value;
        return total;
    }
    std::map<std::string, Sum> sums;

  private:
    const Scene& scene_;
};

/// A room with most that can happen on the way to a lamp, of which `lamp` sends so much.
std::string room(double lamp = 10) {
    return "void light lamp 0 0 3 " + std::to_string(lamp) + " " + std::to_string(2 * lamp) + " " +
           std::to_string(3 * lamp) + R"(
lamp polygon l1 0 0 12 -.5 -.5 3 -.5 .5 3 .5 .5 3 .5 -.5 3
void brightfunc stripes 2 .5+.4*sin(9*Px) . 0 0
stripes light striped 0 0 3 4 5 6
striped sphere l2 0 0 4 2 0 3 .2
void light bulb 0 0 3 7 8 9
bulb sphere l5 0 0 4 2 -2 2 .1
void spotlight spot 0 0 7 50 60 70 70 0 0 -1
spot sphere l3 0 0 4 -2 1 2.9 .05
void light sun 0 0 3 900 800 700
sun source s 0 0 4 .3 .2 1 .5
void brightfunc gradient 2 1+Dz . 0 0
gradient glow sky 0 0 4 1 2 3 0
sky source skyd 0 0 4 0 0 1 180
void glow near 0 0 4 3 3 2 1.5
near sphere l4 0 0 4 1 2 .5 .1
)" + std::string(lightwalk::test::kEveryMaterial) +
           R"(void mist fog 1 sun 0 7 .05 .05 .05 .6 .6 .6 .3
fog sphere cloud 0 0 4 1 -2 1 .8
)";
}

RenderOptions told_options() {
    RenderOptions options = TestScene::exact();
    options.redirections = 2;
    options.source_jitter = 0;
    options.ambient_accuracy = 0;
    options.ambient_super_samples = 0;
    options.ambient_divisions = 64;
    options.ambient_value = {0.1f, 0.2f, 0.3f};
    options.specular_samples = 4;
    options.specular_threshold = 0;
    options.weight_limit = 1e-3;
    return options;
}

/// Rays from one place to all sides.
std::vector<Vec3> fan() {
    std::vector<Vec3> directions;
    for (int i = 0; i < 60; ++i) {
        const double z = 1 - 2 * (i + 0.5) / 60, r = std::sqrt(1 - z * z), turn = 2.4 * i;
        directions.push_back({r * std::cos(turn), r * std::sin(turn), z});
    }
    return directions;
}

Ray traced(TestScene& scene, const Vec3& direction, int i) {
    Ray ray = scene.tracer.primary({0.1, 0.2, 1.3}, direction, 0,
                                   RandomStream::of_pixel(3, static_cast<std::uint32_t>(i), 0, 0));
    scene.tracer.trace(ray, scene.context);
    return ray;
}

void check_close(const Rgb& a, const Rgb& b) {
    for (std::size_t k = 0; k < 3; ++k) {
        CAPTURE(k);
        CHECK(static_cast<double>(a[k]) ==
              doctest::Approx(static_cast<double>(b[k])).epsilon(3e-5));
    }
}

}  // namespace

TEST_CASE("the contributions of all emitters add up to the radiance that is seen without asking") {
    for (const int bounces : {0, 1, 2}) {
        for (const bool medium : {false, true}) {
            for (const bool batches : {false, true}) {
                if (batches && bounces == 0) continue;
                CAPTURE(bounces);
                CAPTURE(medium);
                CAPTURE(batches);
                RenderOptions options = told_options();
                options.ambient_bounces = bounces;
                if (bounces == 2) options.ambient_divisions = 25;
                if (medium) {
                    options.extinction = {0.02f, 0.04f, 0.08f};
                    options.albedo = {0.3f, 0.2f, 0.1f};
                }
                TestScene plain(room(), options), told(room(), options);
                ModifierSums sums(told.scene);
                told.context.contributions = &sums;
                if (batches) told.context.batches.make_fibers = make_context_fibers;
                const std::vector<Vec3> directions = fan();
                for (int i = 0; i < static_cast<int>(directions.size()); ++i) {
                    CAPTURE(i);
                    sums.sums.clear();
                    const Vec3& direction = directions[static_cast<std::size_t>(i)];
                    const Rgb expected = traced(plain, direction, i).value;
                    const Ray ray = traced(told, direction, i);
                    check_close(ray.value, expected);
                    check_close(sums.total(), expected);
                }
            }
        }
    }
}

TEST_CASE("every emitter of the room is told of, by the modifier of its surface") {
    RenderOptions options = told_options();
    options.ambient_bounces = 1;
    TestScene told(room(), options);
    ModifierSums sums(told.scene);
    told.context.contributions = &sums;
    const std::vector<Vec3> directions = fan();
    for (int i = 0; i < static_cast<int>(directions.size()); ++i)
        (void)traced(told, directions[static_cast<std::size_t>(i)], i);
    for (const char* name : {"lamp", "striped", "bulb", "spot", "sun", "sky", "near", "void"}) {
        CAPTURE(name);
        CHECK(brightness(sums.sums[name].value) > 0);
    }
    CHECK(sums.sums.size() == 8);
}

TEST_CASE("a coefficient does not depend on what the emitter sends, and times that is its value") {
    TestScene faint(room(1), told_options()), bright(room(1000), told_options());
    ModifierSums faint_sums(faint.scene), bright_sums(bright.scene);
    faint.context.contributions = &faint_sums;
    bright.context.contributions = &bright_sums;
    const std::vector<Vec3> directions = fan();
    for (int i = 0; i < static_cast<int>(directions.size()); ++i) {
        (void)traced(faint, directions[static_cast<std::size_t>(i)], i);
        (void)traced(bright, directions[static_cast<std::size_t>(i)], i);
    }
    const ModifierSums::Sum a = faint_sums.sums["lamp"], b = bright_sums.sums["lamp"];
    REQUIRE(brightness(a.coefficient) > 0);
    check_close(a.coefficient, b.coefficient);
    check_close(a.value, a.coefficient * Rgb{1, 2, 3});
    check_close(b.value, b.coefficient * Rgb{1000, 2000, 3000});
    const std::map<std::string, Rgb> others{
        {"bulb", {7, 8, 9}}, {"spot", {50, 60, 70}}, {"sun", {900, 800, 700}}, {"near", {3, 3, 2}}};
    for (const auto& [name, radiance] : others) {
        CAPTURE(name);
        REQUIRE(brightness(faint_sums.sums[name].value) > 0);
        check_close(faint_sums.sums[name].value, faint_sums.sums[name].coefficient * radiance);
    }
    check_close(faint_sums.sums["sky"].value, bright_sums.sums["sky"].value);
}

TEST_CASE("a term says where and from which side its emitter is met") {
    class Last final : public ContributionSink {
      public:
        void add(const Contribution& term) override {
            ++count;
            position = term.position;
            direction = term.direction;
        }
        int count = 0;
        Vec3 position, direction;
    };
    TestScene scene(
        "void light lamp 0 0 3 1 1 1\nlamp ring l 0 0 8 0 0 3 0 0 -1 0 .1\n"
        "void plastic paint 0 0 5 .5 .5 .5 0 0\npaint ring f 0 0 8 0 0 0 0 0 1 0 9\n");
    Last last;
    scene.context.contributions = &last;
    Ray ray = scene.tracer.primary({0, 4, 4}, {0, -1, -1}, 0, RandomStream(1));
    scene.tracer.trace(ray, scene.context);
    CHECK(last.count == 1);
    CHECK(length(last.direction - Vec3{0, 0, 1}) < 0.05);
    CHECK(length(last.position - Vec3{0, 0, 3}) < 0.1);
    SUBCASE("the back of a light has a coefficient, but no value") {
        Ray up = scene.tracer.primary({0, 0, 5}, {0, 0, -1}, 0, RandomStream(1));
        scene.tracer.trace(up, scene.context);
        CHECK(last.count == 2);
        CHECK(length(last.direction - Vec3{0, 0, -1}) == 0);
        CHECK(up.value == Rgb{});
    }
}
