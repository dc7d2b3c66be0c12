#include "io/rays/ray_tree.h"

#include <doctest/doctest.h>

#include <string>

#include "io/options/option_words.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using lightwalk::test::TestScene;

namespace {

/// A lamp over a floor that is seen through a pane; a mirror to the side.
const std::string kTreeScene = R"(
void plastic white 0 0 5 .5 .5 .5 0 0
void glass clear 0 0 3 .8 .8 .8
void light lamp 0 0 3 10 20 30
white polygon floor 0 0 12  -9 -9 0  9 -9 0  9 9 0  -9 9 0
clear polygon pane 0 0 12  -1 -1 1  1 -1 1  1 1 1  -1 1 1
lamp sphere bulb 0 0 4 6 0 2 .2
)";

std::string tree(TestScene& scene, const std::string& letters, const Vec3& direction,
                 const TreeSelection& selection = {}) {
    RayTree tree(parse_output_fields(letters), NumberFormat::text, ColorOutput::rgb, selection,
                 false);
    tree.watch(scene.tracer);
    scene.context.observer = &tree;
    (void)scene.trace({0, 0, 2}, direction);
    scene.context.observer = nullptr;
    return tree.take();
}

const Vec3 kStraightDown{0, 0, -1};
using Kind = TreeSelection::Kind;

}  // namespace

TEST_CASE("ray trees: t and T divide the letters, and mean nothing at their end") {
    const auto check = [](const std::string& letters, const std::string& record,
                          const std::string& rays, bool unshadowed) {
        CAPTURE(letters);
        const OutputFields fields = parse_output_fields(letters);
        CHECK(fields.record == record);
        CHECK(fields.tree == rays);
        CHECK(fields.has_tree() == !rays.empty());
        CHECK((!fields.has_tree() || fields.unshadowed == unshadowed));
    };
    check("v", "v", "", false);
    check("vt", "v", "", false);
    check("tv", "", "v", false);
    check("ovTds", "ov", "ds", true);
    check("Tvtd", "", "d", true);
    check("t", "", "", false);
    check("", "", "", false);
}

TEST_CASE(
    "ray trees: children before parents, a tab a generation, T also tells what reaches a lamp") {
    TestScene scene(kTreeScene);
    // Through the pane to the floor; the pane mirrors nothing but the sky.
    CHECK(tree(scene, "ts", kStraightDown) == "\tfloor\t\n\t*\t\npane\t\n");
    CHECK(tree(scene, "Ts", kStraightDown) == "\t\tbulb\t\n\tfloor\t\n\t*\t\npane\t\n");
    CHECK(tree(scene, "tLs", {-1, 0, 0}) == "1.000000e+10\t*\t\n");
    CHECK(scene.trace({0, 0, 2}, kStraightDown).value.g >
          0);  // and unobserved the same scene still works
}

TEST_CASE(
    "ray trees: include and exclude lists go by modifier, and leave the generations as they are") {
    TestScene scene(kTreeScene);
    TreeSelection selection;
    selection.add(Kind::exclude, {"clear"});
    CHECK(tree(scene, "Tm", kStraightDown, selection) == "\t\tlamp\t\n\twhite\t\n\t*\t\n");
    selection.add(Kind::exclude, {"lamp"});
    CHECK(tree(scene, "Tm", kStraightDown, selection) == "\twhite\t\n\t*\t\n");
    selection.add(Kind::include, {"white"});
    CHECK(tree(scene, "Tm", kStraightDown, selection) == "\twhite\t\n");
    selection.add(Kind::include, {"lamp"});
    CHECK(tree(scene, "tm", kStraightDown, selection) == "\twhite\t\n");
    CHECK(tree(scene, "Tm", kStraightDown, selection) == "\t\tlamp\t\n\twhite\t\n");
}

TEST_CASE(
    "ray trees: values times coefficients add up to the primary ray's, who watches changes none") {
    TestScene scene(kTreeScene);
    const Rgb alone = scene.trace({0, 0, 2}, kStraightDown).value;
    struct Sum final : RayObserver {
        Rgb leaves;
        Rgb primary;
        void finished(const Ray& ray, const Hit&) override {
            Rgb part = ray.value;
            for (const Ray* at = &ray; at->parent; at = at->parent) part *= at->coef;
            if (!ray.parent) primary = ray.value;
            if (ray.in(kShadow) || !ray.hit.exists()) leaves += part;
        }
    } sum;
    scene.context.observer = &sum;
    (void)scene.trace({0, 0, 2}, kStraightDown);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(sum.primary[i] == doctest::Approx(static_cast<double>(alone[i])).epsilon(1e-6));
        CHECK(sum.leaves[i] == doctest::Approx(static_cast<double>(alone[i])).epsilon(1e-6));
    }
}

TEST_CASE("ray trees: unknown letters and colours in four bytes are usage errors") {
    const auto make = [](const std::string& letters, NumberFormat format) {
        RayTree(parse_output_fields(letters), format, ColorOutput::rgb, {}, false);
    };
    CHECK_THROWS_AS(make("tq", NumberFormat::text), UsageError);
    CHECK_THROWS_AS(make("tv", NumberFormat::rgbe), UsageError);
    CHECK_NOTHROW(make("Tv~", NumberFormat::real32));
}
