// Diffuse reflection, as CIE 171:2006 tests it: a lit surface as a source, something in the way,
// closed rooms, and colours that go from one surface to the next.
#include <doctest/doctest.h>

#include "tests/core/theory/measure.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const Vec3 kUpward{0, 0, 1}, kDownward{0, 0, -1};
/// A sun in the zenith; its irradiance is measured beside each scene.
const std::string kZenithSun = "void light sun 0 0 3 1e5 1e5 1e5\nsun source s 0 0 4 0 0 1 .1\n";
constexpr int kReflectionRays = 90000;

std::string matte(const std::string& name, double r, double g, double b) {
    return "void plastic " + name + " 0 0 5 " + std::to_string(r) + ' ' + std::to_string(g) + ' ' +
           std::to_string(b) + " 0 0\n";
}

/// A sphere of radius 2 about the origin, of reflectance `rho` but for black caps of this half
/// angle about the axes x and -y: ports.
std::string ported_sphere(double rho, double degrees) {
    return matte("paint", rho, rho, rho) + kBlack + "void mixfunc wall 4 black paint port " +
           (degrees > 0 ? "ports.cal" : "whole.cal") + " 0 0\nwall bubble ball 0 0 4 0 0 0 2\n";
}
MemoryResources ports(double degrees) {
    MemoryResources files;
    const std::string edge = std::to_string(2 * std::cos(degrees * kPi / 180));
    files.functions["ports.cal"] = "port = if(Px-" + edge + ",1,if(-Py-" + edge + ",1,0));";
    files.functions["whole.cal"] = "port = 0;";
    return files;
}

}  // namespace

TEST_CASE("reflection: a matte floor in the sun lights wall and ceiling by its form factor") {
    // 5.6 of CIE 171: E = ρ E_floor F.
    const auto floor = rectangle({0, 0, 0}, {4, 0, 0}, {0, 3, 0});
    TestScene scene(kZenithSun + matte("white", .8, .5, .3) + polygon("white", "floor", floor),
                    indirect(1, kReflectionRays));
    const double sun = measured(scene, {-5, 0, 0}, kUpward);
    REQUIRE(sun > 0);
    for (const double t : {.1, .5, 1., 2., 2.9}) {
        for (const auto& [point, normal] : {std::pair{Vec3{0, 1.2, t}, Vec3{1, 0, 0}},
                                            {Vec3{1, t, 3}, kDownward},
                                            {Vec3{t, 3.5, 1}, Vec3{0, -1, 0}}}) {
            const double factor = lambert_factor(point, normal, floor);
            const Rgb E = irradiance_rgb(scene, point, normal);
            CAPTURE(factor);
            CHECK(static_cast<double>(E.r) == within(kCase, .8 * sun * factor));
            CHECK(static_cast<double>(E.g) == within(kCase, .5 * sun * factor));
            CHECK(static_cast<double>(E.b) == within(kCase, .3 * sun * factor));
        }
    }
}

TEST_CASE("reflection: a black screen in the way hides what Lambert's polygon leaves out") {
    // 5.7 of CIE 171. The screen stands on the floor at y = 2, endless, of height 1; the sun casts
    // no shadow of it.
    TestScene scene(kZenithSun + matte("white", .6, .6, .6) + kBlack +
                        polygon("white", "floor", rectangle({0, 1, 0}, {4, 0, 0}, {0, 4, 0})) +
                        polygon("black", "screen", rectangle({-99, 2, 0}, {200, 0, 0}, {0, 0, 1})),
                    indirect(1, kReflectionRays));
    const double sun = measured(scene, {-5, 0, 0}, kUpward);
    for (const double z : {.5, 1.5, 2., 3.}) {
        const Vec3 point{1.5, 0, z}, normal{0, 1, 0};
        // Behind the screen the floor is seen from where the line over its edge meets it.
        const double behind = z > 1 ? std::min(5., 2 * z / (z - 1)) : 5;
        const double factor =
            lambert_factor(point, normal, rectangle({0, 1, 0}, {4, 0, 0}, {0, 1, 0})) +
            (behind < 5 ? lambert_factor(point, normal,
                                         rectangle({0, behind, 0}, {4, 0, 0}, {0, 5 - behind, 0}))
                        : 0);
        CAPTURE(z);
        CHECK(measured(scene, point, normal) == within(kCase, .6 * sun * factor));
    }
}

TEST_CASE("colour bleeding: a red plate tints a white one, and the white one the red") {
    // The sun shines along the white wall, so that all of its light comes from the red floor; what
    // the floor gets back is ρ of the wall times an integral over it (Goral, Torrance, Greenberg &
    // Battaile, "Modeling the interaction of light between diffuse surfaces", SIGGRAPH 1984).
    const Vec3 wall_normal{1, 0, 0};
    const auto floor = rectangle({0, 0, 0}, {2, 0, 0}, {0, 2, 0});
    TestScene scene(kZenithSun + matte("red", .8, .2, .1) + matte("white", .7, .7, .7) +
                        polygon("red", "floor", floor) +
                        polygon("white", "wall", rectangle({0, 0, 0}, {0, 2, 0}, {0, 0, 2})),
                    indirect(2, 16000));
    const double sun = measured(scene, {-5, 0, 0}, kUpward);
    const auto wall_share = [&](double y, double z) {
        return lambert_factor({0, y, z}, wall_normal, floor);
    };
    for (const double z : {.2, .8, 1.7}) {
        const Rgb E = irradiance_rgb(scene, {0, .9, z}, wall_normal);
        CAPTURE(z);
        CHECK(static_cast<double>(E.r) == within(kCase, .8 * sun * wall_share(.9, z)));
        CHECK(static_cast<double>(E.r / E.g) == within(1e-5, 4));
        CHECK(static_cast<double>(E.r / E.b) == within(1e-5, 8));
    }
    // Back on the floor: the direct sun, and ∫ of the wall's radiosity.
    const GaussRule rule(24);
    for (const double x : {.25, .5}) {
        double back = 0;
        for (std::size_t i = 0; i < rule.at.size(); ++i)
            for (std::size_t k = 0; k < rule.at.size(); ++k) {
                const double y = 2 * rule.at[i], z = 2 * rule.at[k];
                const double squared = x * x + (y - 1) * (y - 1) + z * z;
                back += 4 * rule.weight[i] * rule.weight[k] * wall_share(y, z) * x * z /
                        (kPi * squared * squared);
            }
        const Rgb E = irradiance_rgb(scene, {x, 1, 0}, kUpward, 30);
        CHECK((static_cast<double>(E.r) - sun) == within(kCase, .8 * .7 * sun * back));
        CHECK((static_cast<double>(E.b) - sun) == within(kCase, .1 * .7 * sun * back));
    }
}

TEST_CASE("two parallel plates: each reflection as the integral equation has it") {
    // Plates that glow 1 - ρ and reflect ρ, 2 x 2 at distance 1.5: radiance by Love's equation,
    // L = Le + ρ/π ∫ L cos cos / r² dA, one more term of its Neumann series for each bounce, by
    // Gauss's quadrature (Nyström).
    constexpr double kRho = .7, kGap = 1.5;
    constexpr std::size_t kNodes = 10;
    const GaussRule rule(kNodes);
    const auto kernel = [&](double x, double y, double X, double Y) {
        const double squared = (x - X) * (x - X) + (y - Y) * (y - Y) + kGap * kGap;
        return kGap * kGap / (kPi * squared * squared);
    };
    const auto place = [&](std::size_t i) { return 2 * rule.at[i] - 1; };
    MemoryResources files;
    files.functions["plate.cal"] = "share = " + std::to_string(kRho) + ";";
    const std::string text =
        "void glow hot 0 0 4 1 1 1 0\n" + matte("white", 1, 1, 1) +
        "void mixfunc plate 4 white hot share plate.cal 0 0\n" +
        polygon("plate", "low", rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0})) +
        polygon("plate", "high", rectangle({-1, -1, kGap}, {0, 2, 0}, {2, 0, 0}));
    std::vector<double> L(kNodes * kNodes, 1 - kRho);
    for (int bounces = 1; bounces <= 3; ++bounces) {
        // What a sensor on either plate gets of the other's radiance after so many reflections.
        const auto gathered = [&](double x, double y) {
            double sum = 0;
            for (std::size_t i = 0; i < kNodes; ++i)
                for (std::size_t k = 0; k < kNodes; ++k)
                    sum += 4 * rule.weight[i] * rule.weight[k] * L[i * kNodes + k] *
                           kernel(x, y, place(i), place(k));
            return sum;
        };
        TestScene scene(text, indirect(bounces, 4000), files);
        for (const Vec3& at : {Vec3{0, 0, 0}, Vec3{.8, -.3, 0}}) {
            CAPTURE(bounces);
            CHECK(measured(scene, at + kUpward * 1e-6, kUpward, 2) ==
                  within(kCase, kPi * gathered(at.x, at.y)));
        }
        std::vector<double> next;
        for (std::size_t i = 0; i < kNodes; ++i)
            for (std::size_t k = 0; k < kNodes; ++k)
                next.push_back(1 - kRho + kRho * gathered(place(i), place(k)));
        L = next;
    }
}

TEST_CASE("integrating sphere: E = Φ ρ / (A (1 - ρ (1 - f))), ports of any share") {
    // 5.8 of CIE 171, and Labsphere's "Integrating Sphere Theory and Applications": f is the ports'
    // share of the surface. A lamp in the middle lights all of the wall alike, ports as well, so
    // that Φ (1 - f) is what the wall reflects first.
    const double area = 4 * kPi * 4, flux = 4 * kPi * kPi * 1e-4 * 1000;
    for (const double rho : {.3, .6}) {
        for (const double degrees : {0., 20., 40.}) {
            const double f = 1 - std::cos(degrees * kPi / 180);  // of two caps
            const double q = rho * (1 - f);
            constexpr int kBounces = 5;
            // After so many reflections: the rest is ρ^n of it, which the series says, too.
            TestScene scene(ported_sphere(rho, degrees) +
                                "void light lamp 0 0 3 1000 1000 1000\nlamp sphere l 0 0 4 0 0 0 "
                                ".01\n",
                            indirect(kBounces, 6000), ports(degrees));
            const double direct = flux / area;
            const double reflected = flux * q / (area * (1 - q)) * (1 - std::pow(q, kBounces));
            CAPTURE(rho);
            CAPTURE(degrees);
            CHECK(measured(scene, {0, 0, -1.9999}, kUpward) == within(kCase, direct + reflected));
            CHECK(measured(scene, {0, 1.9999, 0}, {0, -1, 0}) == within(kCase, direct + reflected));
        }
    }
}

TEST_CASE("integrating sphere: a beam onto one patch lights all of the rest alike") {
    // A spotlight of 40 degrees downwards; sensors elsewhere see no lamp, only reflected light.
    const double rho = .5, area = 4 * kPi * 4;
    const double omega = 2 * kPi * (1 - std::cos(20 * kPi / 180));
    const double flux = 1e5 * kPi * 1e-6 * omega;
    TestScene scene(ported_sphere(rho, 0) +
                        "void spotlight lamp 0 0 7 1e5 1e5 1e5 40 0 0 -1e-6\n"  // no focal length
                        "lamp sphere l 0 0 4 0 0 0 .001\n",
                    indirect(3, 20000), ports(0));
    const double reflected = flux * rho / (area * (1 - rho)) * (1 - std::pow(rho, 3));
    for (const Vec3& n : {Vec3{0, 0, 1}, Vec3{1, 0, 0}, normalize(Vec3{-1, 2, 1})})
        CHECK(measured(scene, n * 1.9999, n * -1) == within(kCase, reflected));
}
