// Direct light on surfaces of a scene.
#include <doctest/doctest.h>

#include <cmath>
#include <sstream>
#include <string>

#include "core/light/light_scratch.h"
#include "core/light/light_sources.h"
#include "tests/test_scene.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const std::string kLitFloor =
    "void plastic grey\n0\n0\n5 .5 .5 .5 0 0\ngrey polygon floor\n0\n0\n12 -50 -50 0 50 -50 0 50 "
    "50 0 -50 50 0\n";
const std::string kLamp = "void light lamp\n0\n0\n3 100 50 25\n";
const std::string kPanel =
    kLamp + "lamp polygon panel\n0\n0\n12 -.5 -.5 1  -.5 .5 1  .5 .5 1  .5 -.5 1\n";

/// Radiance of the floor at (x, y).
Rgb floor_at(TestScene& scene, double x, double y, std::uint32_t sample = 0) {
    return scene.trace({x, y, 0.5}, {0, 0, -1}, sample).value;
}

/// Sum of the floor's red over a square grid of points around the origin.
double floor_sum(TestScene& scene, int points, double step) {
    double sum = 0;
    for (int i = 0; i < points; ++i) {
        for (int k = 0; k < points; ++k)
            sum += static_cast<double>(floor_at(scene, -3 + step * i, -3 + step * k).r);
    }
    return sum;
}

/// A grid of small lamps over the floor, each dimmer than the one before, with a wall among
/// them.
std::string many_lamps(int count) {
    std::ostringstream text;
    text << kLitFloor << "grey polygon wall\n0\n0\n12 .2 -1 .6  .2 -1 1.5  .2 1 1.5  .2 1 .6\n";
    double radiance = 1000;
    for (int i = 0; i < count; ++i) {
        text << "void light l" << i << "\n0\n0\n3 " << radiance << ' ' << radiance << ' '
             << radiance << "\nl" << i << " sphere s" << i << "\n0\n0\n4 "
             << (i * 7 % 11) * 0.3 - 1.5 << ' ' << (i * 5 % 9) * 0.3 - 1.2 << " 3 .05\n";
        radiance *= 0.8;
    }
    return text.str();
}

}  // namespace

TEST_CASE("direct light of a sphere: radiance · solid angle · cosine · reflectance / π") {
    TestScene scene(kLitFloor + kLamp + "lamp sphere s\n0\n0\n4 0 0 4 .25\n");
    CHECK(floor_at(scene, 0, 0).r == rounded(0.5 * 100 * 0.0625 / 16));
    const Rgb aside = floor_at(scene, 3, 0);
    CHECK(aside.r == rounded(0.5 * 100 * 0.0625 / 25 * 0.8));
    CHECK(aside.g == rounded(0.5 * static_cast<double>(aside.r)));
    CHECK(aside.b == rounded(0.25 * static_cast<double>(aside.r)));
}

TEST_CASE(
    "direct light of a panel: one sample without -ds, the form factor of the rectangle with it") {
    TestScene coarse(kLitFloor + kPanel);
    CHECK(floor_at(coarse, 0, 0).r == rounded(0.5 * 100 / kPi));
    RenderOptions options = TestScene::exact();
    options.source_subdivision = 0.1;
    TestScene fine(kLitFloor + kPanel, options);
    const double root = std::sqrt(1.25),
                 factor = 4 * (0.5 / root * std::atan(0.5 / root));  // times L: irradiance
    // The midpoint rule of 8 x 8 parts gives 0.30 % more than the integral.
    CHECK(floor_at(fine, 0, 0).r == within(0.0001, 1.00298 * 0.5 * 100 / kPi * factor));
    CHECK(floor_at(fine, 0, 0).r < 0.9f * floor_at(coarse, 0, 0).r);
}

TEST_CASE("a panel lights its front only, a wide sun with the cosine of its centre") {
    TestScene above(kLitFloor + kLamp +
                    "lamp polygon panel\n0\n0\n12 -.5 -.5 1  .5 -.5 1  .5 .5 1  -.5 .5 1\n");
    CHECK(floor_at(above, 0, 0) == Rgb{});
    TestScene sun(kLitFloor + kLamp + "lamp source sun\n0\n0\n4 0 3 4 10\n");
    const double omega = 2 * kPi * (1 - std::cos(5 * kPi / 180));
    CHECK(floor_at(sun, 3, 3).r == rounded(0.5 * 100 / kPi * omega * 0.8));
}

TEST_CASE(
    "shadows: opaque surfaces block, wherever they stand, what is behind the light does not") {
    const std::string base = kLitFloor + kLamp + "lamp sphere s\n0\n0\n4 0 0 4 .25\n";
    const std::string wall = "grey ring w\n0\n0\n8 0 0 ";
    for (const char* height : {"3.7", "2", "0.6"}) {
        TestScene scene(base + wall + height + " 0 0 1 0 .1\n");
        CHECK(floor_at(scene, 0, 0) == Rgb{});
        CHECK(floor_at(scene, 3, 0).r > 0);
    }
    TestScene behind(base + wall + "4.5 0 0 1 0 .1\n");
    CHECK(floor_at(behind, 0, 0).r == rounded(0.5 * 100 * 0.0625 / 16));
    TestScene void_wall(base + "void ring w\n0\n0\n8 0 0 2 0 0 1 0 .1\n");
    CHECK(floor_at(void_wall, 0, 0).r == rounded(0.5 * 100 * 0.0625 / 16));
    TestScene other_light(base + "lamp ring w\n0\n0\n8 0 0 2 0 0 1 0 .01\n");
    CHECK(floor_at(other_light, 0, 0) == Rgb{});
}

TEST_CASE("glass in the way: the pane's transmittance, squared for two, nothing with a wall") {
    const std::string base = kLitFloor + "void glass pane\n0\n0\n3 .96 .96 .96\n" + kLamp +
                             "lamp sphere s\n0\n0\n4 0 0 4 .25\n";
    const std::string pane = "pane ring g\n0\n0\n8 0 0 2 0 0 1 0 1\n",
                      second = "pane ring h\n0\n0\n8 0 0 3 0 0 1 0 1\n";
    const double clear = 0.5 * 100 * 0.0625 / 16,
                 transmittance = 0.881460;  // at normal incidence, to 6 digits
    TestScene one(base + pane), two(base + pane + second);
    CHECK(floor_at(one, 0, 0).r == within(1e-6, clear * transmittance));
    CHECK(floor_at(two, 0, 0).r == within(2e-6, clear * transmittance * transmittance));
    TestScene blocked(base + pane + "grey ring w\n0\n0\n8 0 0 3 0 0 1 0 1\n");
    CHECK(floor_at(blocked, 0, 0) == Rgb{});
}

TEST_CASE("a medium absorbs on the way from the light") {
    RenderOptions options = TestScene::exact();
    options.extinction = {0.1f, 0.1f, 0.1f};
    TestScene scene(kLitFloor + kLamp + "lamp sphere s\n0\n0\n4 0 0 4 .25\n", options);
    CHECK(floor_at(scene, 0, 0).r ==
          rounded(0.5 * 100 * 0.0625 / 16 * std::exp(-0.1 * 3.75) * std::exp(-0.1 * 0.5)));
}

TEST_CASE("many lamps at once give what single lamps give") {
    TestScene all(many_lamps(40));
    for (const double x : {-0.7, 0.0, 0.9}) {
        double sum = 0;
        const std::string text = many_lamps(40);
        for (int i = 0; i < 40; ++i) {
            // The same scene with all other lamps' materials black: they still cast shadows.
            std::string one = text;
            for (int k = 0; k < 40; ++k) {
                if (k == i) continue;
                const std::string head = "void light l" + std::to_string(k) + "\n0\n0\n3 ";
                const std::size_t at = one.find(head) + head.size();
                one.replace(at, one.find('\n', at) - at, "0 0 0");
            }
            TestScene single(one);
            sum += static_cast<double>(floor_at(single, x, 0.1).r);
        }
        CHECK(static_cast<double>(floor_at(all, x, 0.1).r) ==
              within(40 * 0x1p-24, sum)  // forty sums in floats
        );
    }
}

TEST_CASE(
    "-dt: fewer shadow rays, the same mean within half a percent, no memory of earlier rays") {
    RenderOptions options = TestScene::exact();
    options.shadow_threshold = 0.05;
    options.shadow_certainty = 0.5;
    TestScene exact(many_lamps(40)), quick(many_lamps(40), options), again(many_lamps(40), options);
    const double exact_sum = floor_sum(exact, 60, 0.1), quick_sum = floor_sum(quick, 60, 0.1);
    CHECK(quick.context.counters.rays.shadow < exact.context.counters.rays.shadow);
    // Half a percent is what -dt may cost in the mean, by our own promise: untested lamps count by
    // their measured hit rates.
    CHECK(quick_sum / exact_sum == within(0.005, 1));
    CHECK(floor_at(quick, 0.3, 0.2) == floor_at(again, 0.3, 0.2));
}

TEST_CASE("many lamps at once give what single lamps give, on both sides and in the lobe") {
    const auto lamp = [](int i) {
        const std::string n = std::to_string(i), above = i % 2 == 0 ? "3" : "-2";
        return "lamp sphere s" + n + "\n0\n0\n4 " + std::to_string(0.1 * i - 1) + " " +
               std::to_string(0.05 * (i % 7)) + " " + above + " .05\n";
    };
    for (const std::string material :
         {"void plastic m\n0\n0\n5 .5 .4 .3 .05 .2\n", "void plastic m\n0\n0\n5 .5 .4 .3 .2 0\n",
          "void metal m\n0\n0\n5 .5 .4 .3 .9 .3\n", "void trans m\n0\n0\n7 .5 .4 .3 .05 .2 .6 .3\n",
          "void trans m\n0\n0\n7 .5 .4 .3 .05 0 1 .3\n"}) {
        CAPTURE(material);
        const std::string sheet =
            material + "m polygon sheet\n0\n0\n12 -9 -9 0 9 -9 0 9 9 0 -9 9 0\n" + kLamp;
        std::string all = sheet;
        Rgb sum;
        for (int i = 0; i < 21; ++i) {
            all += lamp(i);
            TestScene one(sheet + lamp(i));
            sum += floor_at(one, 0.1, 0.2);
        }
        TestScene together(all);
        const Rgb value = floor_at(together, 0.1, 0.2);
        REQUIRE(sum.r > 0);
        for (std::size_t c = 0; c < 3; ++c) CHECK(value[c] == within(1e-5, sum[c]));
    }
}

TEST_CASE("-dt: lamps with patterns bring half of what they bring without, few or many") {
    RenderOptions options = TestScene::exact();
    options.shadow_threshold = 0.05;
    options.shadow_certainty = 0.5;
    test::MemoryResources files;
    files.functions["half.cal"] = "half = if(Dz, .5, .25);";
    for (const int count : {3, 15, 40}) {  // of which all are tested, all, and some
        const std::string plain = many_lamps(count);
        std::string patterned = "void brightfunc half\n2 half half.cal\n0\n0\n" + plain;
        for (std::size_t at = 0; (at = patterned.find("void light", at)) != std::string::npos;)
            patterned.replace(at, 4, "half");
        TestScene exact(plain), quick(patterned, options, files);
        const double exact_sum = floor_sum(exact, 40, 0.15), quick_sum = floor_sum(quick, 40, 0.15);
        const std::uint64_t tested = quick.context.counters.rays.shadow,
                            all = exact.context.counters.rays.shadow;
        CHECK((count < 20 ? tested == all : tested < all));
        // Where all are tested but for rounding, else as above.
        CHECK(quick_sum / exact_sum == within(count < 20 ? kFloatRounding : 0.005, 0.5));
    }
}

TEST_CASE("a source brings its pattern's value in the direction of the ray, however it is built") {
    const std::string pattern = " brightfunc slope\n2 Dx .\n0\n0\n";
    const std::string panel = " polygon panel\n0\n0\n12 .5 -.1 .8  .5 .1 .8  .7 .1 .8  .7 -.1 .8\n";
    const std::string disk = " ring disk\n0\n0\n8 .6 0 .8 0 0 -1 0 .1\n";
    const std::string ball = " sphere ball\n0\n0\n4 .6 0 .8 .1\n";
    const std::string sun = " source sun\n0\n0\n4 .6 0 .8 1\n";
    const std::string spot = " spotlight lamp\n0\n0\n7 100 50 25 90 -.6 0 -.8\n";
    const std::string light = " light lamp\n0\n0\n3 100 50 25\n";
    const std::string illum = " illum lamp\n0\n0\n3 100 50 25\n";
    const std::string glow = " glow lamp\n0\n0\n4 100 50 25 9\n";
    const auto check = [&](const std::string& material, const std::string& shape) {
        CAPTURE(material);
        CAPTURE(shape);
        TestScene even(kLitFloor + "void" + material + "lamp" + shape);
        TestScene below(kLitFloor + "void" + pattern + "slope" + material + "lamp" + shape);
        TestScene between(kLitFloor + "void" + material + "lamp" + pattern + "slope" + shape);
        const Rgb expected = floor_at(even, 0, 0) * 0.6f;
        CHECK(expected.r > 0);
        for (TestScene* patterned : {&below, &between}) {
            const Rgb found = floor_at(*patterned, 0, 0);
            CHECK(found.r == rounded(expected.r));
            CHECK(found.b == rounded(expected.b));
        }
    };
    for (const std::string& material : {light, illum, glow, spot}) {
        for (const std::string& shape : {panel, disk, ball}) check(material, shape);
    }
    check(light, sun);
}

TEST_CASE("many sources with patterns give what single ones give: alike or not, with errors") {
    // The third is not a number in the west; the last has no lanes.
    const std::string patterns =
        "void brightfunc veil\n2 .5+.5*Rdot .\n0\n0\n"
        "veil brightfunc pattern0\n2 exp(Dx)*(Dz+1.01)^10/100 .\n0\n0\n"
        "void brightfunc pattern1\n2 if(Dx,1+Dx,2-Dy) .\n0\n0\n"
        "void brightfunc pattern2\n2 2+log(Dx) .\n0\n0\n"
        "void brightfunc pattern3\n2 noise3(Dx,Dy,Dz)+2 .\n0\n0\n";
    const auto panel = [&](int i) {
        std::ostringstream text;
        const double x = (i * 7 % 11) * 0.6 - 3, y = (i * 5 % 13) * 0.5 - 3;
        text << "pattern" << i / 7 % 4 << " light lamp" << i << "\n0\n0\n3 9 8 7\nlamp" << i
             << " polygon panel" << i << "\n0\n0\n12 " << x << ' ' << y << " 2  " << x << ' '
             << y + 0.2 << " 2  " << x + 0.2 << ' ' << y + 0.2 << " 2  " << x + 0.2 << ' ' << y
             << " 2\n";
        return text.str();
    };
    constexpr int kPanels = 30;
    std::string together = kLitFloor + patterns;
    double sum = 0;
    for (int i = 0; i < kPanels; ++i) {
        together += panel(i);
        TestScene alone(kLitFloor + patterns + panel(i));
        sum += static_cast<double>(floor_at(alone, 0.1, 0.2).g);
    }
    CHECK(sum > 0.1);
    for (const double threshold : {0.0, 1e-9}) {  // as gathered; brightest first
        RenderOptions options = TestScene::exact();
        options.shadow_threshold = threshold;
        TestScene all(together, options);
        CHECK(floor_at(all, 0.1, 0.2).g == rounded(sum));
    }
}

TEST_CASE("shadow rays are counted") {
    TestScene scene(many_lamps(10));
    (void)floor_at(scene, 0, 0);
    CHECK(scene.context.counters.rays.shadow == 10);
}

TEST_CASE("-dj 1: in the mean over many samples a half hidden panel gives half its light") {
    RenderOptions options = TestScene::exact();
    options.source_jitter = 1;
    TestScene scene(
        kLitFloor + kLamp +
            "lamp polygon panel\n0\n0\n12 -.05 -.05 2  -.05 .05 2  .05 .05 2  .05 -.05 2\n" +
            "grey polygon half\n0\n0\n12 0 -1 1.99  0 1 1.99  1 1 1.99  1 -1 1.99\n",
        options);
    double sum = 0;
    constexpr int kSamples = 4000;
    for (std::uint32_t i = 0; i < kSamples; ++i)
        sum += static_cast<double>(floor_at(scene, 0, 0, i).r) / kSamples;
    const double all = 0.5 * 100 * 0.01 / 4 / kPi;
    CHECK(std::abs(sum / all - 0.5) < 4 * 0.5 / std::sqrt(kSamples));
}

TEST_CASE("hit rates are measured where no source reaches the points") {
    RenderOptions options = TestScene::exact();
    options.shadow_threshold = 0.05;
    options.source_subdivision = 0.02;
    TestScene scene(kLitFloor +
                        "void glow ember\n0\n0\n4 9 3 1 .5\n"
                        "ember polygon panel\n0\n0\n12 -.5 -.5 2  -.5 .5 2  .5 .5 2  .5 -.5 2\n",
                    options);
    CHECK(floor_at(scene, 0, 0) == Rgb{});
}

TEST_CASE("the scratch memory is free after every calculation, and used again") {
    TestScene scene(many_lamps(12));
    for (int i = 0; i < 3; ++i) (void)floor_at(scene, 0.1 * i, 0);
    CHECK(scene.context.light->open == 0);
    CHECK(scene.context.light->nested.size() == 1);
}
