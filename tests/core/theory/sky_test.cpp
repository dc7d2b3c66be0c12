// Daylight through openings, as CIE 171:2006 tests it (Maamari, Andersen, de Boer, Carroll,
// Dumortier & Greenup, "Experimental validation of simulation methods for bi-directional
// transmission properties at the daylighting performance level", Energy and Buildings 38, 2006,
// tell the cases). Skies: uniform; Moon & Spencer, "Illumination from a non-uniform sky",
// Illuminating Engineering 37 (1942); CIE S 011/E:2003, of Perez, Seals & Michalsky (1993) and
// Kittler, Darula & Perez (1998).
#include <doctest/doctest.h>

#include <sstream>

#include "tests/core/theory/measure.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

constexpr int kSkyRays = 90000;
const Vec3 kUpright{0, 0, 1};

/// One of the fifteen skies of CIE S 011: gradation a, b and indicatrix c, d, e.
struct GeneralSky {
    int type;
    double a, b, c, d, e;
};
constexpr std::array<GeneralSky, 15> kSkies{{{1, 4, -.7, 0, -1, 0},
                                             {2, 4, -.7, 2, -1.5, .15},
                                             {3, 1.1, -.8, 0, -1, 0},
                                             {4, 1.1, -.8, 2, -1.5, .15},
                                             {5, 0, -1, 0, -1, 0},
                                             {6, 0, -1, 2, -1.5, .15},
                                             {7, 0, -1, 5, -2.5, .3},
                                             {8, 0, -1, 10, -3, .45},
                                             {9, -1, -.55, 2, -1.5, .15},
                                             {10, -1, -.55, 5, -2.5, .3},
                                             {11, -1, -.55, 10, -3, .45},
                                             {12, -1, -.32, 10, -3, .45},
                                             {13, -1, -.32, 16, -3, .3},
                                             {14, -1, -.15, 16, -3, .3},
                                             {15, -1, -.15, 24, -2.8, .15}}};
/// The sun that they turn about, whose own disk is not there.
const Vec3 kSunWay = normalize(Vec3{0.6, -0.5, 0.65});

/// Luminance over that of the zenith.
double radiance_of(const GeneralSky& sky, const Vec3& way) {
    const auto gradation = [&](double cosine) {
        return 1 + sky.a * std::exp(sky.b / std::max(cosine, 1e-6));
    };
    const auto scattered = [&](double cosine) {
        const double angle = std::acos(std::clamp(cosine, -1., 1.));
        return 1 + sky.c * (std::exp(sky.d * angle) - std::exp(sky.d * kPi / 2)) +
               sky.e * cosine * cosine;
    };
    return scattered(dot(way, kSunWay)) * gradation(way.z) / (scattered(kSunWay.z) * gradation(1));
}

/// The formula once more, as a pattern that the renderer evaluates.
MemoryResources formula_of(const GeneralSky& sky) {
    std::ostringstream text;
    text.precision(15);
    text << "grad(c) : 1 + " << sky.a << " * exp(" << sky.b << " / if(c - 1e-6, c, 1e-6));\n"
         << "around(c) : 1 + " << sky.c << " * (exp(" << sky.d << " * acos(c)) - exp(" << sky.d
         << " * PI / 2)) + " << sky.e << " * c * c;\n"
         << "bound(c) : if(c - 1, 1, if(-1 - c, -1, c));\n"
         << "sky = around(bound(Dx * " << kSunWay.x << " + Dy * (" << kSunWay.y << ") + Dz * "
         << kSunWay.z << ")) * grad(Dz) / (around(" << kSunWay.z << ") * grad(1));\n";
    MemoryResources files;
    files.functions["sky.cal"] = text.str();
    return files;
}
const std::string kSkyGlow =
    "void brightfunc shape 2 sky sky.cal 0 0\nshape glow air 0 0 4 1 1 1 0\n"
    "air source above 0 0 4 0 0 1 180\n";
const std::string kUniformSky = "void glow air 0 0 4 1 1 1 0\nair source above 0 0 4 0 0 1 180\n";

/// Moon & Spencer: L = Lz (1 + 2 sinγ) / 3.
double overcast_of(const Vec3& way) {
    return (1 + 2 * way.z) / 3;
}
MemoryResources overcast_formula() {
    MemoryResources files;
    files.functions["sky.cal"] = "sky = (1 + 2 * Dz) / 3;";
    return files;
}

/// Black walls of a room, `size` from a corner, without that at the place `without` (0 to 5: west,
/// east, south, north, below, above).
std::string black_walls(const Vec3& corner, const Vec3& size, int without) {
    const Vec3 x{size.x, 0, 0}, y{0, size.y, 0}, z{0, 0, size.z};
    const std::array<std::vector<Vec3>, 6> walls{
        rectangle(corner, y, z),     rectangle(corner + x, y, z), rectangle(corner, x, z),
        rectangle(corner + y, x, z), rectangle(corner, x, y),     rectangle(corner + z, x, y)};
    std::string text = kBlack;
    for (int i = 0; i < 6; ++i)
        if (i != without)
            text +=
                polygon("black", "wall" + std::to_string(i), walls[static_cast<std::size_t>(i)]);
    return text;
}

/// A black room whose roof at height 3 has an opening of 1 x 2 about (.5, 1).
const std::string kRoof = black_walls({-4, -4, -1}, {10, 10, 4}, 5) +
                          polygon("black", "a", rectangle({-9, -9, 3}, {9, 0, 0}, {0, 20, 0})) +
                          polygon("black", "b", rectangle({1, -9, 3}, {9, 0, 0}, {0, 20, 0})) +
                          polygon("black", "c", rectangle({0, -9, 3}, {1, 0, 0}, {0, 9, 0})) +
                          polygon("black", "d", rectangle({0, 2, 3}, {1, 0, 0}, {0, 9, 0}));

double through_roof(const Vec3& point, const Vec3& normal,
                    const std::function<double(const Vec3&)>& radiance) {
    return irradiance_through(point, normal, {0, 0, 3}, {1, 0, 0}, {0, 2, 0}, radiance);
}

/// A black room where y > 0, whose facade y = 0 has a window from x = 0 to 2 and z = 1 to 2.5.
const std::string kFacade = black_walls({-3, 0, 0}, {8, 6, 3.5}, 2) +
                            polygon("black", "a", rectangle({-9, 0, -9}, {9, 0, 0}, {0, 0, 18})) +
                            polygon("black", "b", rectangle({2, 0, -9}, {9, 0, 0}, {0, 0, 18})) +
                            polygon("black", "c", rectangle({0, 0, -9}, {2, 0, 0}, {0, 0, 10})) +
                            polygon("black", "d", rectangle({0, 0, 2.5}, {2, 0, 0}, {0, 0, 9}));

/// Through the window's part between two heights.
double through_window(const Vec3& point, const Vec3& normal, double from, double to,
                      const std::function<double(const Vec3&)>& radiance) {
    from = std::clamp(from, 1., 2.5);
    to = std::clamp(to, 1., 2.5);
    return irradiance_through(point, normal, {0, 0, from}, {2, 0, 0}, {0, 0, to - from}, radiance);
}

const std::vector<std::pair<Vec3, Vec3>> kInRoom{{{1, 1, .8}, kUpright},
                                                 {{.4, 2.5, .8}, kUpright},
                                                 {{1.5, 3, 1.6}, {0, -1, 0}},
                                                 {{2.8, 2, .9}, {-1, 0, 0}}};

}  // namespace

TEST_CASE("skies: on open ground and on a wall as the closed forms have it") {
    // A uniform sky: π L, and half of it on a wall. Moon & Spencer's: 7/9 π Lz, and on a wall
    // Lz (π/6 + 4/9).
    TestScene uniform(kUniformSky, indirect(1, kSkyRays));
    CHECK(measured(uniform, {}, kUpright) == within(kCase, kPi));
    CHECK(measured(uniform, {}, {0, 1, 0}) == within(kCase, kPi / 2));
    TestScene overcast(kSkyGlow, indirect(1, kSkyRays), overcast_formula());
    CHECK(measured(overcast, {}, kUpright) == within(kCase, 7 * kPi / 9));
    CHECK(measured(overcast, {}, {0, 1, 0}) == within(kCase, kPi / 6 + 4. / 9));
}

TEST_CASE("skies: each of the fifteen general skies lights the ground by its integral") {
    const GaussRule heights(60), turns(60);
    for (const GeneralSky& sky : kSkies) {
        double expected = 0;
        for (std::size_t i = 0; i < heights.at.size(); ++i)
            for (std::size_t k = 0; k < turns.at.size(); ++k) {
                const double squared = heights.at[i], sine = std::sqrt(1 - squared);  // of cosines
                const double turn = 2 * kPi * turns.at[k];
                const Vec3 way{sine * std::cos(turn), sine * std::sin(turn), std::sqrt(squared)};
                expected += kPi * heights.weight[i] * turns.weight[k] * radiance_of(sky, way);
            }
        TestScene scene(kSkyGlow, indirect(1, kSkyRays), formula_of(sky));
        CAPTURE(sky.type);
        CHECK(measured(scene, {}, kUpright) == within(kCase, expected));
    }
}

TEST_CASE("roof opening: sky component of uniform, overcast and general skies") {
    // 5.9 of CIE 171.
    TestScene uniform(kRoof + kUniformSky, indirect(1, kSkyRays));
    TestScene overcast(kRoof + kSkyGlow, indirect(1, kSkyRays), overcast_formula());
    const auto opening = rectangle({0, 0, 3}, {1, 0, 0}, {0, 2, 0});
    for (const auto& [point, normal] : {std::pair{Vec3{.5, 1, 0}, kUpright},
                                        {Vec3{2, 1, 0}, kUpright},
                                        {Vec3{2.5, .5, 1}, Vec3{-1, 0, 0}}}) {
        CHECK(measured(uniform, point, normal) ==
              within(kCase, kPi * lambert_factor(point, normal, opening)));
        CHECK(measured(overcast, point, normal) ==
              within(kCase, through_roof(point, normal, overcast_of)));
        for (const GeneralSky& sky : kSkies) {
            TestScene scene(kRoof + kSkyGlow, indirect(1, kSkyRays), formula_of(sky));
            CAPTURE(sky.type);
            CHECK(measured(scene, point, normal) ==
                  within(kCase, through_roof(point, normal, [&](const Vec3& way) {
                             return radiance_of(sky, way);
                         })));
        }
    }
}

TEST_CASE("roof opening: as a light source it sends what the sky behind it does") {
    for (const GeneralSky& sky : {kSkies[0], kSkies[7], kSkies[11]}) {
        // The window's pattern is that of the sky; its front looks down.
        TestScene lamp(
            "void brightfunc shape 2 sky sky.cal 0 0\nshape illum pane 0 0 3 1 1 1\n" +
                polygon("pane", "window", rectangle({0, 0, 3}, {0, 2, 0}, {1, 0, 0})),
            [] {
                RenderOptions options = TestScene::exact();
                options.source_subdivision = .12;
                return options;
            }(),
            formula_of(sky));
        for (const Vec3& point : {Vec3{.5, 1, 0}, Vec3{2, 1, .5}, Vec3{4, -1, 0}}) {
            CAPTURE(sky.type);
            CHECK(measured(lamp, point, kUpright) ==
                  within(kCase, through_roof(point, kUpright, [&](const Vec3& way) {
                             return radiance_of(sky, way);
                         })));
        }
    }
}

TEST_CASE("roof opening with a pane: the sky times what Fresnel's equations leave of it") {
    // 5.10 of CIE 171.
    const std::string pane = "void glass clear 0 0 3 .96 .96 .96\n" +
                             polygon("clear", "pane", rectangle({0, 0, 3}, {1, 0, 0}, {0, 2, 0}));
    for (const GeneralSky& sky : {kSkies[0], kSkies[4], kSkies[11]}) {
        TestScene scene(kRoof + pane + kSkyGlow, indirect(1, kSkyRays), formula_of(sky));
        for (const auto& [point, normal] : {std::pair{Vec3{.5, 1, 0}, kUpright},
                                            {Vec3{2, 1, 1}, kUpright},
                                            {Vec3{3, .5, 2}, Vec3{-1, 0, 0}}}) {
            CAPTURE(sky.type);
            CHECK(measured(scene, point, normal) ==
                  within(kCase, through_roof(point, normal, [&](const Vec3& way) {
                             return radiance_of(sky, way) *
                                    pane_transmittance_of(std::abs(way.z), 1.52, .96);
                         })));
        }
    }
}

TEST_CASE("window: sky above the horizon, sunlit ground below it, with a pane and without") {
    // 5.11 and 5.12 of CIE 171. The ground is a glow that stands for what it reflects, ρ E / π.
    const double ground = .3 * 7 / 9;
    const std::string outside = kSkyGlow + "void glow earth 0 0 4 " + std::to_string(ground) + ' ' +
                                std::to_string(ground) + ' ' + std::to_string(ground) +
                                " 0\nearth source below 0 0 4 0 0 -1 180\n";
    const std::string pane = "void glass clear 0 0 3 .96 .96 .96\n" +
                             polygon("clear", "pane", rectangle({0, 0, 1}, {2, 0, 0}, {0, 0, 1.5}));
    TestScene open(kFacade + outside, indirect(1, kSkyRays), overcast_formula());
    TestScene glazed(kFacade + pane + outside, indirect(1, kSkyRays), overcast_formula());
    for (const auto& [point, normal] : kInRoom) {
        // The horizon is as high as the sensor.
        const auto whole = [&](const std::function<double(const Vec3&)>& share) {
            return through_window(point, normal, point.z, 9,
                                  [&](const Vec3& w) { return overcast_of(w) * share(w); }) +
                   through_window(point, normal, 0, point.z,
                                  [&](const Vec3& w) { return ground * share(w); });
        };
        CHECK(measured(open, point, normal) ==
              within(kCase, whole([](const Vec3&) { return 1.; })));
        CHECK(measured(glazed, point, normal) == within(kCase, whole([](const Vec3& w) {
                                                            return pane_transmittance_of(
                                                                std::abs(w.y), 1.52, .96);
                                                        })));
    }
}

TEST_CASE("window with masks: an overhang and a building opposite hide what lies behind them") {
    // 5.13 and 5.14 of CIE 171: both are endless to the sides.
    const std::string overhang =
        polygon("black", "shade", rectangle({-999, -1.2, 2.6}, {2000, 0, 0}, {0, 1.2, 0}));
    const std::string building =
        "void glow front 0 0 4 .2 .2 .2 0\n" +
        polygon("front", "opposite", rectangle({-9999, -10, -5}, {0, 0, 10}, {20000, 0, 0}));
    TestScene shaded(kFacade + overhang + kSkyGlow, indirect(1, kSkyRays), overcast_formula());
    TestScene facing(kFacade + building + kSkyGlow, indirect(1, kSkyRays), overcast_formula());
    for (const auto& [point, normal] : kInRoom) {
        // Where the line from the sensor to the edge passes the window.
        const auto passes = [&p = point](double distance, double height) {
            return p.z + (height - p.z) * p.y / (p.y + distance);
        };
        CHECK(measured(shaded, point, normal) ==
              within(kCase, through_window(point, normal, point.z, passes(1.2, 2.6), overcast_of)));
        const double over = passes(10, 5);
        CHECK(measured(facing, point, normal) ==
              within(kCase,
                     through_window(point, normal, over, 9, overcast_of) +
                         through_window(point, normal, 0, over, [](const Vec3&) { return .2; })));
    }
}
