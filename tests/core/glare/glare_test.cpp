#include "core/glare/glare.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/glare/dgp.h"
#include "core/glare/glare_indices.h"
#include "tests/core/glare/fisheye_picture.h"
#include "tests/one_thread.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using test::about_numbers;
using test::direction_of;
using test::disc_picture;
using test::fisheye_view;
using test::LightDisc;
using test::within;

namespace {

constexpr int kSize = 200;

GlareReport report_of(char type, double background, const std::vector<LightDisc>& discs) {
    const View view = fisheye_view(type);
    const std::vector<Rgb> picture = disc_picture(kSize, view, background, discs);
    return analyse_glare({kSize, kSize, picture}, view);
}

double degrees_between(const Vec3& a, const Vec3& b) {
    return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / kPi;
}

/// A picture and what the reference program says of it.
struct ReferenceCase {
    const char* name;
    char type;
    double background;  ///< [cd/m²]
    std::vector<LightDisc> discs;
    double dgp, ev;
    std::size_t sources;
    double mean_luminance, solid_angle;  ///< of all sources
};

// evalglare 3.06 -d on the picture that disc_picture() makes, 200 x 200, written as RGBE with its
// view: the columns dgp, E_v, lum_sources and omega_sources of the last line, and the number of
// sources with pixels.
const std::vector<ReferenceCase> kReferenceCases{
    {"no source", 'a', 300, {}, 0.214318, 942.380348, 0, 0, 0},
    {"bright without a source", 'a', 1500, {}, 0.436491, 4727.278575, 0, 0, 0},
    {"a lamp above to the right",
     'a',
     100,
     {{30, 20, 5, 10000}},
     0.246934,
     508.730469,
     1,
     10001.625000,
     0.024217},
    {"a patch of sun below to the left",
     'a',
     200,
     {{-40, -30, 6, 20000}},
     0.293134,
     1067.588348,
     1,
     20003.250000,
     0.034411},
    {"on the line of sight, in the dark",
     'a',
     20,
     {{0, 0, 3, 8000}},
     0.330164,
     125.604591,
     1,
     7987.875000,
     0.007894},
    {"at the rim", 'a', 150, {{80, 10, 7, 6000}}, 0.196418, 516.288189, 1, 6018.875000, 0.047165},
    {"straight above",
     'a',
     300,
     {{0, 60, 8, 30000}},
     0.273798,
     1850.103661,
     1,
     29982.500000,
     0.061500},
    {"two lamps near each other: one source",
     'a',
     150,
     {{-4, 10, 2, 9000}, {4, 10, 2, 9000}},
     0.241029,
     539.560247,
     1,
     9017.125000,
     0.007849},
    {"two lamps apart",
     'a',
     150,
     {{-6, 10, 2, 9000}, {6, 10, 2, 9000}},
     0.240806,
     535.028279,
     2,
     9017.125000,
     0.007351},
    {"the sun in a window",
     'a',
     250,
     {{15, 15, 12, 5000}, {17, 16, 2, 1e+06}},
     0.632905,
     4674.497341,
     2,
     30817.202351,
     0.138628},
    {"a dim window fills a quarter",
     'a',
     400,
     {{20, 0, 40, 3000}},
     0.454213,
     4441.497528,
     1,
     3009.437500,
     1.469596},
    {"many",
     'a',
     80,
     {{10, 10, 3, 5000},
      {-20, 25, 4, 12000},
      {50, -10, 2, 60000},
      {-60, 5, 6, 4000},
      {5, -45, 5, 9000},
      {30, 40, 3, 2500}},
     0.307545,
     814.295666,
     6,
     8729.321748,
     0.093956},
    {"hemispherical: many",
     'h',
     80,
     {{10, 10, 3, 5000},
      {-20, 25, 4, 12000},
      {50, -10, 2, 60000},
      {-60, 5, 6, 4000},
      {5, -45, 5, 9000},
      {30, 40, 3, 2500}},
     0.308418,
     819.110798,
     6,
     8816.140278,
     0.094232},
    {"hemispherical: a lamp low to the right",
     'h',
     500,
     {{55, -20, 5, 15000}},
     0.276899,
     1726.046186,
     1,
     14991.250000,
     0.023247},
};

}  // namespace

TEST_CASE("glare: what evalglare finds in the same pictures") {
    for (const ReferenceCase& c : kReferenceCases) {
        CAPTURE(c.name);
        const GlareReport report = report_of(c.type, c.background, c.discs);
        // Its constants are rounded, 0.092 and 0.159 for 0.0918 and 0.16 (its answers to pictures
        // without sources, and with); it looks sources' position indices up at whole pixels.
        CHECK(report.dgp == test::Near{c.dgp, 0.002, 0});
        // Of a hemispherical picture it leaves out the outermost pixels.
        CHECK(report.vertical_illuminance == within(c.type == 'h' ? 0.015 : 1e-3, c.ev));
        CHECK(report.sources.size() == c.sources);
        double flux = 0, solid_angle = 0;
        for (const GlareSource& source : report.sources) {
            flux += source.luminance * source.solid_angle;
            solid_angle += source.solid_angle;
        }
        if (c.sources == 0) continue;
        // It takes a pixel's solid angle at the centre.
        CHECK(solid_angle == within(2e-3, c.solid_angle));
        CHECK(flux / solid_angle == within(2e-3, c.mean_luminance));
    }
}

TEST_CASE("glare: a source is where it is, as bright and as large as it is") {
    const LightDisc disc{30, 20, 5, 10000};
    const GlareReport report = report_of('a', 100, {disc});
    REQUIRE(report.sources.size() == 1);
    const GlareSource& source = report.sources[0];
    // The edge's pixels count whole or not at all, as many too many as too few.
    CHECK(source.solid_angle == within(0.02, 2 * kPi * (1 - std::cos(5 * kPi / 180))));
    CHECK(source.luminance == within(1. / 128, 10000));  // the step of a stored pixel
    CHECK(degrees_between(source.direction, direction_of(disc)) < 0.1 * 180 / kSize);
    CHECK(source.position_index == position_index(source.direction, Camera(fisheye_view('a'))));
    CHECK(source.glare == test::rounded(source.luminance * source.luminance * source.solid_angle /
                                        (source.position_index * source.position_index)));
    CHECK_FALSE(source.peak);
    CHECK(source.outline.size() >= 8);
    for (const Vec3& p : source.outline)
        CHECK(std::abs(degrees_between(p, direction_of(disc)) - 5) < 180. / kSize);
    CHECK(report.dgp == daylight_glare_probability(report.vertical_illuminance, source.glare));
}

TEST_CASE("glare: a wide source lights the eye by all its pixels, not by its middle") {
    // Half the field, L above the line of sight: π L / 2 of illuminance, at 180 / π degrees a mean
    // direction that would tell another. What is below is the background.
    const View view = fisheye_view('a');
    std::vector<Rgb> picture = disc_picture(kSize, view, 300, {});
    for (std::size_t i = 0; i < picture.size() / 2; ++i)
        if (picture[i].g > 0) picture[i] = test::stored_grey(3000);
    const GlareReport report = analyse_glare({kSize, kSize, picture}, view);
    REQUIRE(report.sources.size() == 1);
    CHECK(report.sources[0].illuminance == within(1e-2, kPi * 3000 / 2));
    const GlareIndices indices = glare_indices(report, Camera(view).forward());
    const double background = 300. / 2;  // half of the field
    CHECK(indices.ugr == within(2e-3, 8 * std::log10(0.25 / background * report.sources[0].glare)));
    CHECK(indices.vcp < 50);
    // Its veil, of a place 10 degrees off: 10 E / theta².
    const GlareReport disc = report_of('a', 100, {{10, 0, 2, 10000}});
    const double E = disc.sources[0].illuminance;
    CHECK(glare_indices(disc, Camera(view).forward()).veiling_luminance ==
          within(3e-2, E / 10));  // its pixels are .9 degrees
}

TEST_CASE("glare: the angular and the hemispherical picture of a room agree") {
    const std::vector<LightDisc> discs{{10, 20, 8, 6000}, {-45, -10, 4, 30000}};
    const GlareReport a = report_of('a', 200, discs), h = report_of('h', 200, discs);
    REQUIRE(a.sources.size() == h.sources.size());
    CHECK(h.dgp == test::Near{a.dgp, 0.002, 0});
    // Half of it comes from discs of 18 and 9 pixels across, whose edges are pixels of other sizes.
    CHECK(h.vertical_illuminance == within(0.02, a.vertical_illuminance));
    CHECK(h.average_luminance == within(0.03, a.average_luminance));
    for (std::size_t i = 0; i < a.sources.size(); ++i)
        CHECK(degrees_between(a.sources[i].direction, h.sources[i].direction) < 180. / kSize);
}

TEST_CASE("glare: the worst source comes first") {
    const GlareReport report =
        report_of('a', 100, {{60, 0, 3, 5000}, {0, 10, 3, 20000}, {-40, -30, 3, 8000}});
    REQUIRE(report.sources.size() == 3);
    CHECK(report.sources[0].luminance > 19000);
    CHECK(report.sources[0].glare > report.sources[1].glare);
    CHECK(report.sources[1].glare > report.sources[2].glare);
}

TEST_CASE("glare: brighter, larger and nearer to the line of sight is worse") {
    const auto dgp = [](const LightDisc& disc) { return report_of('a', 150, {disc}).dgp; };
    const LightDisc disc{40, 15, 3, 10000};
    CHECK(dgp({40, 15, 3, 20000}) > dgp(disc));
    CHECK(dgp({40, 15, 6, 10000}) > dgp(disc));
    CHECK(dgp({20, 7, 3, 10000}) > dgp(disc));
    CHECK(dgp(disc) > report_of('a', 150, {}).dgp);
}

TEST_CASE("glare: the sun in a window is a source of its own, the window's rest another") {
    const GlareReport report = report_of('a', 100, {{10, 10, 12, 5000}, {12, 10, 2, 1e6}});
    REQUIRE(report.sources.size() == 2);
    CHECK(report.sources[0].peak);
    CHECK(report.sources[0].luminance == within(1. / 128, 1e6));
    CHECK_FALSE(report.sources[1].peak);
    CHECK(report.sources[1].luminance == within(1. / 128, 5000));
}

TEST_CASE("glare: sources are sought in a perspective, too") {
    View view;
    view.horizontal = 90, view.vertical = 90;
    const LightDisc disc{20, -10, 4, 10000};
    const std::vector<Rgb> picture = disc_picture(kSize, view, 100, {disc});
    const std::vector<GlareSource> sources =
        find_glare_sources({kSize, kSize, picture}, Camera(view));
    REQUIRE(sources.size() == 1);
    CHECK(degrees_between(sources[0].direction, direction_of(disc)) < 0.2);
    CHECK(sources[0].solid_angle == within(0.02, 2 * kPi * (1 - std::cos(4 * kPi / 180))));
    CHECK(sources[0].position_index ==
          within(0.01, report_of('a', 100, {disc}).sources.at(0).position_index));
    CHECK_THROWS_WITH_AS((void)analyse_glare({kSize, kSize, picture}, view),
                         "glare: daylight glare probability needs a fisheye, -vta or -vth -vh 180 "
                         "-vv 180, not a view of type 'v', 90.000000 by 90.000000 degrees",
                         InputError);
}

TEST_CASE("glare: odd pictures") {
    const View view = fisheye_view('a');
    SUBCASE("black") {
        const std::vector<Rgb> black(100);
        const GlareReport report = analyse_glare({10, 10, black}, view);
        CHECK(report.dgp == test::rounded(0.16));
        CHECK(report.vertical_illuminance == 0);
        CHECK(report.average_luminance == 0);
        CHECK(report.sources.empty());
        CHECK_FALSE(report.within_assessments);
    }
    SUBCASE("a single pixel") {
        const std::vector<Rgb> one{Rgb::grey(100)};
        const GlareReport report = analyse_glare({1, 1, one}, view);
        REQUIRE(report.sources.size() == 1);
        CHECK(report.sources[0].solid_angle == test::rounded(2 * kPi));
        CHECK(report.average_luminance == test::float_rounded(17900));
        CHECK(report.dgp == 1);
        CHECK(report.sources[0].outline.size() == 4);
    }
    SUBCASE("nothing but what is no number") {
        const std::vector<Rgb> none(4, Rgb::grey(std::numeric_limits<float>::quiet_NaN()));
        const GlareReport report = analyse_glare({2, 2, none}, view);
        CHECK(report.dropped == 4);
        CHECK(report.dgp == test::rounded(0.16));
        CHECK(report.average_luminance == 0);
    }
    SUBCASE("a pixel that is no number does not spoil the others") {
        std::vector<Rgb> picture = disc_picture(kSize, view, 100, {{0, 0, 5, 10000}});
        const GlareReport whole = analyse_glare({kSize, kSize, picture}, view);
        picture[kSize * kSize / 2 + 10].g = std::numeric_limits<float>::infinity();
        const GlareReport holed = analyse_glare({kSize, kSize, picture}, view);
        CHECK(holed.dropped == 1);
        CHECK(holed.average_luminance == within(1e-3, whole.average_luminance));
        CHECK(holed.dgp == test::Near{whole.dgp, 1e-3, 0});
    }
    SUBCASE("brighter than anything") {
        const std::vector<Rgb> bright(2500, Rgb::grey(1e30f));
        const GlareReport report = analyse_glare({50, 50, bright}, view);
        CHECK(report.dgp == 1);
        CHECK(report.sources.size() == 1);
    }
}

TEST_CASE("glare: settings that mean nothing are refused") {
    const std::vector<Rgb> one(1);
    const View view = fisheye_view('a');
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const GlareParams& params : {GlareParams{.threshold = 0}, GlareParams{.threshold = nan},
                                      GlareParams{.merge_angle = -1}, GlareParams{.merge_angle = 2},
                                      GlareParams{.peak = 0}, GlareParams{.outline_points = 3}})
        CHECK_THROWS_AS((void)analyse_glare({1, 1, one}, view, params), InputError);
    View upright = view;
    upright.up = upright.direction;
    CHECK_THROWS_AS((void)analyse_glare({1, 1, one}, upright), InputError);
}

TEST_CASE("glare shares: dgp follows the luminance of a pixel as they say, of a source and beside" *
          about_numbers) {
    constexpr int kSide = 100;
    for (const char type : {'a', 'h'}) {
        CAPTURE(type);
        const View view = fisheye_view(type);
        std::vector<Rgb> picture =
            disc_picture(kSide, view, 300, {{20, 30, 8, 9000}, {-30, -10, 6, 80000}});
        const FieldPicture field{kSide, kSide, picture};
        const std::vector<GlareShare> shares = glare_shares(field, view);
        const auto dgp = [&] { return analyse_glare(field, view).dgp; };
        double largest = 0;
        for (std::size_t i = 0; i < shares.size(); i += 53) {
            const GlareShare& share = shares[i];
            Rgb& pixel = picture[static_cast<std::size_t>((kSide - 1 - share.place.y) * kSide +
                                                          share.place.x)];
            const Rgb before = pixel;
            constexpr float kStep = .01f;
            pixel = (1 + kStep) * before;
            const double more = dgp();
            pixel = (1 - kStep) * before;
            const double less = dgp();
            pixel = before;
            const double slope = (more - less) / (2 * double{kStep} * share.luminance);
            // Sources move a little with their light, which moves the position index.
            CHECK(std::abs(share.slope - slope) < .1 * std::abs(slope) + 2e-12);
            largest = std::max(largest, share.slope);
        }
        CHECK(largest > 1e-9);  // sources are among them
    }
}
