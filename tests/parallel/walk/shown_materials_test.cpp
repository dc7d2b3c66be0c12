#include "core/cloud/shown_materials.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "parallel/walk/scene_caster.h"
#include "tests/one_thread.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using lightwalk::test::one_thread;
using lightwalk::test::TestScene;

namespace {

constexpr int kShownSide = 96;

/// A mirror, a pane, a floor that may be polished, and a surface with another one's name (an
/// alias). One of the materials is redder.
std::string coloured_room(const std::string& changed, bool polished) {
    const auto red = [&](const char* name) { return changed == name ? ".9" : ".3"; };
    std::string text = "void light lamp 0 0 3 40 40 40\n";
    for (const char* name : {"wall", "ball", "post"})
        text += std::string("void plastic ") + name + " 0 0 5 " + red(name) + " .3 .3 0 0\n";
    return text + "void alias rail post\nvoid plastic tiles 0 0 5 " + red("tiles") + " .4 .5 " +
           (polished ? ".06" : "0") +
           " 0\nvoid mirror silver 0 0 3 .9 .9 .9\nvoid glass pane 0 0 3 .9 .9 .9\n" +
           R"(
wall polygon back 0 0 12  -4 6 0  4 6 0  4 6 3  -4 6 3
wall polygon left 0 0 12  -4 -6 0  -4 6 0  -4 6 3  -4 -6 3
tiles polygon floor 0 0 12  -4 -6 0  4 -6 0  4 6 0  -4 6 0
silver polygon mirror 0 0 12  -2 5.99 .5  1 5.99 .5  1 5.99 2.5  -2 5.99 2.5
pane polygon window 0 0 12  1.5 3 0  3.5 3 0  3.5 3 2.5  1.5 3 2.5
ball sphere ball 0 0 4 -1.5 2 .7 .7
post cylinder post 0 0 7 .8 1 0 .8 1 3 .1
rail cylinder rail 0 0 7 2.5 5 0 2.5 5 3 .1
lamp polygon panel 0 0 12  -1 -1 2.99  -1 1 2.99  1 1 2.99  1 -1 2.99
)";
}

std::vector<TracedPixel> traced_pixels_of(TestScene& scene) {
    const VisibilityProbe visibility(scene.tracer);
    WorkerContexts contexts(scene.tracer, scene.warnings, 1);
    View view;
    view.position = {0, -4, 1.5};
    view.direction = {0.1, 1, -0.05};
    view.horizontal = view.vertical = 60;
    const Camera camera(view);
    FrameOptions options;
    options.width = options.height = kShownSide;
    options.pixels.spacing = 1;
    const StopFlag stop;
    SceneCaster caster(scene.tracer, visibility, camera, options, contexts, stop);
    std::vector<PixelPlace> places;
    for (int y = 0; y < kShownSide; ++y)
        for (int x = 0; x < kShownSide; ++x) places.push_back({x, y});
    std::vector<TracedPixel> pixels(places.size());
    caster.trace(places, pixels, 0, 0);
    return pixels;
}

ShownMaterials shown_materials_of(const Scene& scene, const std::string& name) {
    std::vector<bool> wanted(scene.modifier_count());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const std::string& own = scene.modifier(ModifierId{static_cast<std::int32_t>(i)}).name;
        wanted[i] = own == name || (name == "post" && own == "rail");
    }
    return {scene, wanted};
}

bool is_another(const Rgb& a, const Rgb& b) {
    return std::abs(a[0] - b[0]) > 1e-5f * std::max(a[0], b[0]);
}

}  // namespace

TEST_CASE("shown materials: the points that another colour changes are found, and hardly others" *
          one_thread) {
    const std::vector<std::pair<std::string, bool>> cases{
        {"wall", false}, {"ball", false}, {"post", false}, {"tiles", false}, {"ball", true}};
    for (const auto& [name, polished] : cases) {
        CAPTURE(name);
        CAPTURE(polished);
        TestScene built(coloured_room("", polished));
        const std::vector<TracedPixel> before = traced_pixels_of(built);
        TestScene changed(coloured_room(name, polished));
        const std::vector<TracedPixel> after = traced_pixels_of(changed);
        const ShownMaterials materials = shown_materials_of(built.scene, name);
        std::size_t found = 0, missed = 0, vain = 0;
        for (std::size_t i = 0; i < before.size(); ++i) {
            const PixelPoints was = points_of(before[i], 0.02), is = points_of(after[i], 0.02);
            REQUIRE(was.count == is.count);
            for (std::size_t k = 0; k < was.count; ++k) {
                const bool other = is_another(was.points[k].radiance, is.points[k].radiance);
                const bool says = materials.may_show(was.points[k]);
                found += other && says ? 1 : 0;
                missed += other && !says ? 1 : 0;
                vain += !other && says ? 1 : 0;
            }
        }
        CHECK(found > 20);
        // Of a pane that is seen in a mirror, or of a polished floor behind a pane, reflections are
        // no points of their own.
        CHECK(100 * missed <= found);
        CHECK(vain < before.size() / 10);
    }
}

TEST_CASE("shown materials: points are dropped with what light groups add to them") {
    const TestScene scene(coloured_room("", true));
    const ShownMaterials none(scene.scene, {});
    std::vector<CloudPoint> points(3);
    std::vector<Rgb> groups(6);
    for (std::size_t i = 0; i < points.size(); ++i) {
        points[i].surface = static_cast<std::uint32_t>(i) << 8;
        groups[2 * i] = groups[2 * i + 1] = Rgb::grey(static_cast<float>(i));
    }
    const ShownMaterials walls = shown_materials_of(scene.scene, "wall");
    for (std::uint32_t bits = 0; bits <= kMaterialBits; ++bits) {
        points[1].surface = bits;
        CHECK_FALSE(none.may_show(points[1]));
        if (walls.may_show(points[1])) break;
    }
    REQUIRE(walls.may_show(points[1]));
    REQUIRE_FALSE(walls.may_show(points[0]));
    drop_points(walls, points, groups);
    REQUIRE(points.size() == 2);
    CHECK(points[1].surface == 2u << 8);
    CHECK(groups == std::vector<Rgb>{{}, {}, {2, 2, 2}, {2, 2, 2}});
}

TEST_CASE("shown materials: another process that has their flags says the same of all points") {
    const TestScene scene(coloured_room("", true));
    const ShownMaterials walls = shown_materials_of(scene.scene, "wall");
    const ShownMaterials copy(walls.flags());
    std::size_t shown = 0;
    for (int kind = 0; kind < kPointKinds; ++kind) {
        CloudPoint point;
        point.kind = static_cast<PointKind>(kind);
        for (point.surface = 0; point.surface <= kMaterialBits; ++point.surface) {
            CHECK(copy.may_show(point) == walls.may_show(point));
            shown += walls.may_show(point) ? 1 : 0;
        }
    }
    CHECK(shown > 0);
    std::vector<std::uint8_t> few = walls.flags();
    few.pop_back();
    CHECK_THROWS_AS(ShownMaterials{few}, InputError);
}
