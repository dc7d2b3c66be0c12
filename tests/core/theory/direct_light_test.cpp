// Light sources, as CIE 171:2006 tests them: point and area sources, conservation of flux, panes,
// mirrors, the sun's disk through a slit. Sources of the formulas are named in formulas.h; the
// cases are described in Maamari & Fontoynont, Lighting Research & Technology 35 (2003), with the
// errata of Ashdown ("Photometry and photorealism", 2007).
#include <doctest/doctest.h>

#include <sstream>

#include "tests/core/theory/measure.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const Vec3 kUp{0, 0, 1}, kDown{0, 0, -1};

/// A panel, whose front is where its corners run counterclockwise.
std::string lamp_panel(const std::vector<Vec3>& corners) {
    return "void light lamp 0 0 3 1 1 1\n" + polygon("lamp", "panel", corners);
}
/// Of panels that are divided, into parts this small for their distance.
RenderOptions divided(double share = 0.15) {
    RenderOptions options = TestScene::exact();
    options.source_subdivision = share;
    return options;
}
/// Of samples that fill their sources.
RenderOptions jittered() {
    RenderOptions options = TestScene::exact();
    options.source_jitter = 1;
    return options;
}

/// Mean over a rectangle of what arrives there.
double mean_over(const TestScene& scene, const Vec3& corner, const Vec3& u, const Vec3& v,
                 const Vec3& normal, int points) {
    const GaussRule rule(points);
    double sum = 0;
    for (std::size_t i = 0; i < rule.at.size(); ++i)
        for (std::size_t k = 0; k < rule.at.size(); ++k)
            sum += rule.weight[i] * rule.weight[k] *
                   measured(scene, corner + u * rule.at[i] + v * rule.at[k], normal);
    return sum;
}

/// Flux into the six walls of a room from -1 to 1 along each axis.
double flux_into_walls(const TestScene& scene) {
    double flux = 0;
    for (const Vec3& n : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
        const Vec3 u = perpendicular(n), v = cross(n, u);
        for (const double side : {-1., 1.})
            flux += 4 * mean_over(scene, n * side - u - v, u * 2, v * 2, n * -side, 10);
    }
    return flux;
}

}  // namespace

TEST_CASE("point source: E = I(direction) cosθ / d² for any distribution of intensity") {
    // 5.2 of CIE 171. A small ball of L has the intensity L π r² to all sides; a pattern makes it
    // I0 cos²γ about the vertical, or that of a wall washer.
    struct Distribution {
        std::string pattern;
        std::function<double(const Vec3&)> share;  ///< by the direction from the lamp
    };
    const std::vector<Distribution> all{
        {"void brightfunc d 2 1 . 0 0\n", [](const Vec3&) { return 1.; }},
        {"void brightfunc d 2 Dz*Dz . 0 0\n", [](const Vec3& d) { return d.z * d.z; }},
        {"void brightfunc d 2 if(Dx,0,.5-.5*Dx) . 0 0\n",  // D: towards the lamp
         [](const Vec3& d) { return d.x > 0 ? .5 + .5 * d.x : 0; }}};
    const Vec3 lamp{0, 0, 3};
    for (const Distribution& distribution : all) {
        TestScene scene(distribution.pattern +
                        "d light lamp 0 0 3 1000 1000 1000\nlamp sphere s 0 0 4 0 0 3 .01\n");
        for (const double x : {0.1, 0.5, 1.0, 2.0, 3.0, 4.0}) {
            for (const Vec3& normal : {kUp, Vec3{-1, 0, 0}, normalize(Vec3{-1, 1, 1})}) {
                const Vec3 point{x, .3, 0}, way = lamp - point;
                const double d = length(way), I = 1000 * kPi * 1e-4 * distribution.share(way / -d);
                // Sensors stand a tenth of a millimetre before their places.
                CHECK(measured(scene, point, normal) ==
                      within(2e-3, I * std::max(0., dot(way, normal)) / (d * d * d)));
            }
        }
    }
}

TEST_CASE("area source: Lambert's formula, from parts of the panel and from random places on it") {
    // 5.3 of CIE 171: on the floor and on a wall under a square and a long luminaire.
    const std::vector<std::vector<Vec3>> panels{rectangle({-.5, -.5, 3}, {0, 1, 0}, {1, 0, 0}),
                                                rectangle({-1, -.25, 3}, {0, .5, 0}, {2, 0, 0})};
    for (const std::vector<Vec3>& panel : panels) {
        TestScene parts(lamp_panel(panel), divided()), random(lamp_panel(panel), jittered());
        for (const double x : {0.0, 0.5, 1.0, 1.5, 1.9}) {
            const Vec3 floor{x, .2, 0}, wall{2, .2, x}, inward{-1, 0, 0};
            for (const auto& [point, normal] : {std::pair{floor, kUp}, {wall, inward}}) {
                const double E = kPi * lambert_factor(point, normal, panel);
                CHECK(measured(parts, point, normal) == within(kCase, E));
                CHECK(measured(random, point, normal, 4000) == within(kCase, E));
            }
        }
    }
}

TEST_CASE("area source: a lamp of any shape sends what its area and its outline say") {
    // A triangle is sampled in a square, of which its share counts; far away its shape is all one.
    const std::vector<Vec3> triangle{{0, 0, 9}, {0, .6, 9}, {.8, 0, 9}};
    TestScene far(lamp_panel(triangle));
    CHECK(measured(far, {1, 1, 0}, kUp) ==
          within(kCase, kPi * lambert_factor({1, 1, 0}, kUp, triangle)));
    // A disk, as its closed form, and a ball: (r / d)².
    RenderOptions options = divided(.1);
    TestScene disk("void light lamp 0 0 3 1 1 1\nlamp ring d 0 0 8 0 0 2 0 0 -1 0 .5\n", options);
    CHECK(measured(disk, {}, kUp) == within(kCase, kPi * .25 / (4 + .25)));
}

TEST_CASE("flux: what a source sends arrives on the walls, all of it") {
    // 5.4 of CIE 171: π L A of a panel, one half space; 4 π² r² L of a ball; L A Ω of a beam.
    TestScene panel(lamp_panel(rectangle({-.2, -.15, .1}, {0, .3, 0}, {.4, 0, 0})), divided());
    CHECK(flux_into_walls(panel) == within(kCase, kPi * .12));
    TestScene ball("void light lamp 0 0 3 1 1 1\nlamp sphere s 0 0 4 .1 -.2 .05 .03\n");
    CHECK(flux_into_walls(ball) == within(kCase, 4 * kPi * kPi * 9e-4));
    // An occluder takes what falls on it, and leaves the rest: a black disk under the ball.
    TestScene shaded(kBlack +
                     "void light lamp 0 0 3 1 1 1\nlamp sphere s 0 0 4 0 0 0 .01\n"
                     "black ring lid 0 0 8 0 0 .01 0 0 1 0 50\n");
    CHECK(flux_into_walls(shaded) == within(kCase, 2 * kPi * kPi * 1e-4));
}

TEST_CASE("panes: the sun through clear glass, by Fresnel's equations at every angle") {
    // 5.5 of CIE 171: transmittances of a 6 mm pane from 0 to 85 degrees. The transmissivity that a
    // scene states is what one crossing leaves (Radiance's `glass`), not the transmittance.
    for (const double internal : {1.0, 0.96, 0.5}) {
        for (const double index : {1.52, 1.3, 2.0}) {
            for (const double degrees : {0., 10., 30., 50., 60., 70., 80., 85.}) {
                const double angle = degrees * kPi / 180;
                std::ostringstream text;
                text.precision(12);
                text << "void light sun 0 0 3 1e6 1e6 1e6\nsun source s 0 0 4 " << std::sin(angle)
                     << " 0 " << std::cos(angle) << " .1\n";
                TestScene open(text.str());
                text << "void glass pane 0 0 4 " << internal << ' ' << internal << ' ' << internal
                     << ' ' << index << "\npane ring p 0 0 8 0 0 1 0 0 1 0 99\n";
                TestScene glazed(text.str());
                CAPTURE(degrees);
                CHECK(measured(glazed, {}, kUp) / measured(open, {}, kUp) ==
                      within(1e-4, pane_transmittance_of(std::cos(angle), index, internal)));
            }
        }
    }
}

TEST_CASE("panes: a transmissivity for each transmittance at normal incidence") {
    // The reference manual's formula for index 1.52.
    for (const double t : {0.2, 0.5, 0.88}) {
        const double tn =
            (std::sqrt(.8402528435 + .0072522239 * t * t) - .9166530661) / .0036261119 / t;
        CHECK(pane_transmittance_of(1, 1.52, tn) == within(1e-4, t));
    }
}

TEST_CASE("mirrors: a lamp and its image send by Lambert's formula what each shows") {
    const std::vector<Vec3> panel = rectangle({-.3, -.5, 3}, {0, 1, 0}, {.6, 0, 0});
    const auto image = rectangle({4.3, -.5, 3}, {0, 1, 0}, {-.6, 0, 0});  // in the plane x = 2
    const std::string mirror = "void mirror silver 0 0 3 .8 .8 .8\n" +
                               polygon("silver", "m", rectangle({2, -9, 0}, {0, 0, 9}, {0, 18, 0}));
    RenderOptions options = divided(.1);
    options.redirections = 1;
    TestScene lamps(lamp_panel(panel) + mirror, options);
    // The same as a glow, which rays from the sensor find by way of the mirror.
    TestScene glow("void glow lamp 0 0 4 1 1 1 0\n" + polygon("lamp", "panel", panel) + mirror,
                   indirect(1, 160000));
    for (const double x : {-1., 0., 1.}) {
        const Vec3 point{x, .1, 0};
        const double E =
            kPi * (lambert_factor(point, kUp, panel) + .8 * lambert_factor(point, kUp, image));
        CHECK(measured(lamps, point, kUp) == within(kCase, E));
        CHECK(measured(glow, point, kUp) == within(kCase, E));
    }
}

TEST_CASE("the sun's disk through a slit: umbra, penumbra and all of its flux") {
    // The profile is the integral of a disk's chord over the slit, as for a pinhole camera's slit:
    // with s the offset in radii, the share of the disk beyond it is
    // (acos(s) - s sqrt(1 - s²)) / π.
    const double radius = .5 * .533 * kPi / 180, height = 10, half_slit = .02;
    const double blur = height * std::tan(radius);
    const auto beyond = [](double s) {
        s = std::clamp(s, -1., 1.);
        return (std::acos(s) - s * std::sqrt(1 - s * s)) / kPi;
    };
    const std::string slit =
        kBlack + polygon("black", "west", rectangle({-9, -9, 10}, {8.98, 0, 0}, {0, 18, 0})) +
        polygon("black", "east", rectangle({.02, -9, 10}, {8.98, 0, 0}, {0, 18, 0}));
    // Seen as a glow by rays that are aimed at it: the share of the disk that shows through.
    TestScene seen("void glow sun 0 0 4 1 1 1 0\nsun source s 0 0 4 0 0 1 .533\n" + slit);
    // As a lamp, from the sum over a line of sensors across the slit.
    const std::string sun = "void light sun 0 0 3 1e5 1e5 1e5\nsun source s 0 0 4 0 0 1 .533\n";
    TestScene open(sun), lit(sun + slit, jittered());
    const double all = measured(open, {}, kUp);
    CHECK(all == within(1e-3, 1e5 * kPi * std::pow(std::sin(radius), 2)));
    double sum = 0;
    constexpr int kSensors = 160;
    const double reach = half_slit + 1.1 * blur;
    for (int i = 0; i < kSensors; ++i) {
        const double x = reach * ((i + .5) / kSensors * 2 - 1);
        sum += measured(lit, {x, 0, 0}, kUp, 64) * 2 * reach / kSensors;
        if (i % 20 != 3) continue;
        int hits = 0, rays = 0;
        for (int a = 0; a < 200; ++a)
            for (int b = 0; b < 200; ++b) {
                const double u = (a + .5) / 100 - 1, v = (b + .5) / 100 - 1;
                if (u * u + v * v > 1) continue;
                ++rays;
                const Vec3 aim{u * std::tan(radius) * .999, v * std::tan(radius) * .999, 1};
                hits += seen.trace({x, 0, 0}, aim).value.g > 0 ? 1 : 0;
            }
        const double share = beyond((-half_slit - x) / blur) - beyond((half_slit - x) / blur);
        CAPTURE(x);
        // A grid of 31,000 rays: a hundredth of the whole disk.
        CHECK(std::abs(double(hits) / rays - share) < kCase);
    }
    CHECK(sum == within(kCase, all * 2 * half_slit));
    CHECK(measured(lit, {reach * 1.2, 0, 0}, kUp, 100) == 0);
}
