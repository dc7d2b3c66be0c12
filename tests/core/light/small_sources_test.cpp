#include "core/light/small_sources.h"

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <string>

#include "tests/test_scene.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const std::string kSpeck =
    "void light lamp\n0\n0\n3 100 50 25\nlamp polygon speck\n0\n0\n"
    "12 -.013 10 -.02  .017 10 -.02  .017 10 .018  -.013 10 .018\n"
    "void plastic white\n0\n0\n5 .5 .5 .5 0 0\nwhite polygon wall\n0\n0\n12 -9 11 -9  9 11 -9  9 "
    "11 9  -9 11 9\n";

Camera camera(double degrees = 4) {
    View view;
    view.horizontal = view.vertical = degrees;
    return Camera(view);
}

using Coverage = std::map<std::pair<int, int>, SourcePixel>;

Coverage draw(TestScene& scene, const Camera& eye, int size, int spacing,
              const PixelRectangle& area) {
    Coverage drawn;
    SmallSources(scene.tracer, eye, size, size, spacing)
        .draw(area, scene.context, [&](const SourcePixel& p) {
            drawn[{p.x, p.y}] = p;
        });
    return drawn;
}

double total(const Coverage& drawn) {
    double sum = 0;
    for (const auto& [at, pixel] : drawn) sum += static_cast<double>(pixel.coverage);
    return sum;
}

}  // namespace

TEST_CASE("a small panel covers its projected area, shared by the pixels it touches") {
    TestScene scene(kSpeck);
    const Camera eye = camera();
    const double pixel = 2 * std::tan(2 * kPi / 180) * 10 / 8;  // [m] at the panel
    const Coverage drawn = draw(scene, eye, 8, 1, {0, 0, 8, 8});
    REQUIRE(drawn.size() == 4);
    CHECK(total(drawn) == float_rounded(0.03 * 0.038 / (pixel * pixel)));
    CHECK(drawn.at({4, 3}).coverage == rounded(0.017 * 0.02 / (pixel * pixel)));
    CHECK(drawn.at({3, 4}).radiance == Rgb{100, 50, 25});
    // Along the ray to a point of the pixel, not to its centre: up to 1/cos of 0.3 degrees more.
    CHECK(drawn.at({3, 4}).distance == within(1.4e-5, 10));
}

TEST_CASE("what a pixel gets does not depend on the rectangle") {
    TestScene scene(kSpeck);
    const Camera eye = camera();
    const Coverage whole = draw(scene, eye, 8, 1, {0, 0, 8, 8});
    for (const auto& [at, pixel] : whole) {
        const Coverage one =
            draw(scene, eye, 8, 1, {at.first, at.second, at.first + 1, at.second + 1});
        REQUIRE(one.size() == 1);
        CHECK(one.begin()->second.coverage == pixel.coverage);
        CHECK(one.begin()->second.radiance == pixel.radiance);
    }
    CHECK(draw(scene, eye, 8, 1, {0, 0, 3, 8}).empty());
}

TEST_CASE("sources that the pixel grid cannot miss are not drawn") {
    TestScene scene(kSpeck);
    const Camera eye = camera(), near = camera(0.3);
    CHECK(SmallSources(scene.tracer, eye, 8, 8, 1).size() == 1);
    CHECK(SmallSources(scene.tracer, near, 64, 64, 1).empty());  // many pixels wide
    CHECK(SmallSources(scene.tracer, near, 64, 64, 40).size() == 1);
    CHECK(SmallSources(scene.tracer, camera(0.15), 64, 64, 40).empty());  // not whole inside
    View behind;
    behind.position = {0, 10.5, 0};
    behind.direction = {0, -1, 0};
    CHECK(SmallSources(scene.tracer, Camera(behind), 8, 8, 1).empty());  // faces away
    RenderOptions invisible = TestScene::exact();
    invisible.sources_visible = false;
    TestScene hidden(kSpeck, invisible);
    CHECK(SmallSources(hidden.tracer, eye, 8, 8, 1).empty());
}

TEST_CASE("a sphere's outline is that of its sampling box, a sun's its cone") {
    TestScene ball("void light lamp\n0\n0\n3 100 50 25\nlamp sphere s\n0\n0\n4 0 10 0 .01\n");
    const Camera eye = camera();
    const double pixel = 2 * std::tan(2 * kPi / 180) * 10 / 8;
    // The box is not flat, and not quite square to the view.
    CHECK(total(draw(ball, eye, 8, 1, {0, 0, 8, 8})) ==
          within(0.01, 4 * kSphereBox * kSphereBox * 1e-4 / (pixel * pixel)));
    TestScene sun("void light lamp\n0\n0\n3 100 50 25\nlamp source s\n0\n0\n4 .001 1 .002 .2\n");
    const double omega = 2 * kPi * (1 - std::cos(0.1 * kPi / 180));
    // A polygon stands for the disk.
    CHECK(total(draw(sun, eye, 8, 1, {0, 0, 8, 8})) == within(0.01, omega * 100 / (pixel * pixel)));
    View parallel;
    parallel.type = 'l';
    CHECK(SmallSources(sun.tracer, Camera(parallel), 8, 8, 1).empty());
}

TEST_CASE("hidden sources are not drawn, those behind glass are dimmed") {
    TestScene hidden(kSpeck + "white polygon near\n0\n0\n12 -9 5 -9  9 5 -9  9 5 9  -9 5 9\n");
    const Camera eye = camera();
    CHECK(draw(hidden, eye, 8, 1, {0, 0, 8, 8}).empty());
    TestScene dimmed(kSpeck +
                     "void glass g\n0\n0\n3 .96 .96 .96\ng polygon near\n0\n0\n12 -9 5 -9  9 5 -9  "
                     "9 5 9  -9 5 9\n");
    const Coverage drawn = draw(dimmed, eye, 8, 1, {0, 0, 8, 8});
    REQUIRE(drawn.size() == 4);
    CHECK(drawn.at({4, 3}).radiance.r == printed(5, 88.146));
}

TEST_CASE("a pixel shows a source whose own ray meets it, not what is as bright") {
    TestScene scene(kSpeck);
    const Camera eye = camera();
    PixelOptions options;
    options.jitter = 0;
    const auto shown = [&](int size, int spacing, bool known, bool own_only) {
        const PixelRays rays(eye, nullptr, size, size, options, 0);
        std::map<std::pair<int, int>, ShownSource> found;
        SmallSources(scene.tracer, eye, size, size, spacing, known ? &rays : nullptr, own_only)
            .draw({0, 0, size, size}, scene.context, [&](const SourcePixel& p) {
                found[{p.x, p.y}] = p.shown;
            });
        return found;
    };
    // Eight pixels: the lamp lies about a corner of four. Nine: about the middle of one.
    const auto between = shown(8, 1, true, true), middle = shown(9, 1, true, true);
    REQUIRE(between.size() == 4);
    for (const auto& [at, how] : between) CHECK(how == ShownSource::no);
    REQUIRE(middle.size() == 1);
    CHECK(middle.at({4, 4}) == ShownSource::yes);
    CHECK(shown(9, 1, true, false).at({4, 4}) == ShownSource::by_colour);
    CHECK(shown(9, 4, true, true).at({4, 4}) == ShownSource::by_colour);
    CHECK(shown(9, 1, false, true).at({4, 4}) == ShownSource::by_colour);
    CHECK(shown(8, 4, true, true).at({3, 3}) == ShownSource::no);
    CHECK(shown(8, 1, false, true).at({3, 3}) == ShownSource::by_colour);
}

TEST_CASE("the topmost row gets nothing") {
    TestScene scene(kSpeck);
    View view;
    view.horizontal = view.vertical = 4;
    view.direction = {0, 1, -0.0305};  // lifts the lamp to the upper edge
    const Camera eye(view);
    REQUIRE(SmallSources(scene.tracer, eye, 8, 8, 1).size() == 1);
    for (const auto& [at, pixel] : draw(scene, eye, 8, 1, {0, 0, 8, 8})) CHECK(at.second < 7);
}

TEST_CASE(
    "blending: by coverage, less where the pixel's own ray met the source, by depth when known") {
    const SourcePixel source{0, 0, 0.25f, {100, 50, 25}, 10};
    Rgb dark{0.5f, 0.5f, 0.5f};
    blend_source(source, dark, nullptr);
    CHECK(dark.r == rounded(0.75 * 0.5 + 25));
    Rgb shown{102, 49, 26};
    blend_source(source, shown, nullptr);
    CHECK(shown.r == rounded(25.5));
    Rgb almost{108, 50, 25};  // 8 % off in one channel: something else
    blend_source(source, almost, nullptr);
    CHECK(almost.r == rounded(0.75 * 108 + 25));
    SourcePixel missed = source, met = source;
    missed.shown = ShownSource::no;
    met.shown = ShownSource::yes;
    Rgb as_bright{102, 49, 26}, through_ripples{60, 49, 26};
    blend_source(missed, as_bright, nullptr);
    CHECK(as_bright.r == rounded(0.75 * 102 + 25));
    blend_source(met, through_ripples, nullptr);
    CHECK(through_ripples.r == rounded(15));
    float distance = 20;
    Rgb wall{102, 49, 26};
    blend_source(source, wall, &distance);
    CHECK(wall.r == rounded(0.75 * 102 + 25));
    CHECK(distance == 10);
    blend_source(source, wall, &distance);
    CHECK(distance == 10);
}
