#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/math/random.h"
#include "io/generators/perez_sky.h"
#include "io/generators/solar.h"
#include "tests/io/generators/library_file.h"
#include "tests/shared_data.h"
#include "tests/tolerance.h"

namespace lightwalk {
namespace {

using test::LibraryFile;
using test::own_library_file;
using test::RayValues;
using test::rounded;
using test::within;
using Names = std::vector<std::string>;
using Reals = std::vector<double>;

/// Rays and arguments that the functions are compared at.
class Draws {
  public:
    double next(double low, double high) { return low + (high - low) * random_.next(); }
    Vec3 direction() {
        const double z = next(-1, 1);
        const double phi = next(0, 2 * kPi);
        const double r = std::sqrt(1 - z * z);
        return {r * std::cos(phi), r * std::sin(phi), z};
    }
    RayValues ray() {
        RayValues result;
        result.direction = direction();
        result.normal = direction();
        result.position = {next(-3, 3), next(-3, 3), next(-3, 3)};
        result.distance = next(1, 10);
        return result;
    }
    Reals reals(std::size_t count, double low, double high) {
        Reals result;
        for (std::size_t i = 0; i < count; ++i) result.push_back(next(low, high));
        return result;
    }

  private:
    RandomStream random_ = RandomStream::of_pixel(11, 0, 0, 0);
};

constexpr int kDraws = 40;

void add(Reals& reals, const Vec3& v) {
    reals.insert(reals.end(), {v.x, v.y, v.z});
}

/// skybr's arguments for a sky of that model.
Reals sky_arguments(int model, Draws& draws) {
    const double altitude = draws.next(0.05, 1.5);
    Reals reals = {static_cast<double>(model), draws.next(1, 40), draws.next(1, 20)};
    if (model == 2 || model == 3) return reals;
    reals.push_back(model == 1 ? clear_sky_zenith(altitude).shape
                               : intermediate_sky_zenith(altitude).shape);
    add(reals, solar_direction({altitude, draws.next(-3, 3)}));
    return reals;
}

/// perezlum.cal's arguments for some weather, and the distribution and sun they hold.
struct PerezArguments {
    Reals reals;
    PerezDistribution distribution;
    Vec3 sun;
    double clearness;
};

PerezArguments perez_arguments(Draws& draws) {
    const double altitude = draws.next(0.1, 1.4);
    const SkyCondition condition{draws.next(1, 12), draws.next(0.05, 0.4)};
    PerezArguments result;
    result.distribution = *perez_distribution(condition, kPi / 2 - altitude);
    result.sun = solar_direction({altitude, draws.next(-3, 3)});
    result.clearness = condition.clearness;
    const PerezDistribution& f = result.distribution;
    result.reals = {draws.next(1, 10), draws.next(1, 20), f.a, f.b, f.c, f.d, f.e};
    add(result.reals, result.sun);
    return result;
}

double blend(double sky, double ground, double dz) {
    const double w = std::pow(dz + 1.01, 10);
    return (w * sky + ground / w) / (w + 1 / w);
}

/// Our file and Radiance's own, at the same rays.
template <class MakeReals>
void compare(const std::string& reference, const std::string& own, const Names& variables,
             double tolerance, const MakeReals& make_reals) {
    const LibraryFile expected(reference);
    const LibraryFile library = own_library_file(own);
    Draws draws;
    for (int i = 0; i < kDraws; ++i) {
        const RayValues ray = draws.ray();
        const Reals reals = make_reals(i, draws);
        const Reals a = library.values(variables, reals, ray);
        const Reals b = expected.values(variables, reals, ray);
        for (std::size_t k = 0; k < variables.size(); ++k) {
            CAPTURE(variables[k]);
            CHECK(std::abs(a[k] - b[k]) <= tolerance * std::max(1.0, std::abs(b[k])));
        }
    }
}

}  // namespace

TEST_CASE("surf.cal: bilinear in the two coordinates that follow the axis") {
    const LibraryFile library = own_library_file("surf.cal");
    const Names variables = {"surf_dx", "surf_dy", "surf_dz"};
    Draws draws;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const RayValues ray = draws.ray();
        Reals reals = draws.reals(13, -2, 2);
        reals[0] = static_cast<double>(axis);
        const double u = ray.position[(axis + 1) % 3];
        const double v = ray.position[(axis + 2) % 3];
        const Reals d = library.values(variables, reals, ray);
        for (std::size_t k = 0; k < 3; ++k) {
            CHECK(d[k] == rounded(reals[1 + k] * u * v + reals[4 + k] * u + reals[7 + k] * v +
                                  reals[10 + k]));
        }
    }
}

TEST_CASE("rev.cal: linear in z and in the distance from the axis") {
    const LibraryFile library = own_library_file("rev.cal");
    const Reals d = library.values(Names{"rev_dx", "rev_dy", "rev_dz"}, Reals{.5, .25, 2, -3},
                                   {.position = {3, 4, 7}});
    CHECK(d[0] == rounded(0.6 * (5 * 2 - 3)));
    CHECK(d[1] == rounded(0.8 * (5 * 2 - 3)));
    CHECK(d[2] == rounded(7 * .5 + .25));
}

TEST_CASE("tmesh.cal: a normal, or texture coordinates, over a triangle") {
    const LibraryFile library = own_library_file("tmesh.cal");
    const Reals reals = {1, .5, -1, 2, 1, 1, -.25, .3, .7, 1};
    const RayValues ray{{0, 0, 1}, {0, 1, 0}, {.4, 9, 1.5}, 0};  // axis y: u = z, v = x
    const Vec3 w{.5 * 1.5 - .4 + 2, 1.5 + .4 - .25, .3 * 1.5 + .7 * .4 + 1};
    const Reals d = library.values(Names{"dx", "dy", "dz", "u", "v"}, reals, ray);
    CHECK(length(Vec3{d[0], d[1], d[2]} - (normalize(w) - ray.normal)) < 1e-12);
    CHECK(d[3] == rounded(w.x - 2));
    CHECK(d[4] == rounded(w.y - 1));
}

TEST_CASE("skybright.cal: toward the zenith each model has the zenith's radiance") {
    const LibraryFile library = own_library_file("skybright.cal");
    Draws draws;
    for (const int model : {1, 2, 3, 4}) {
        for (int i = 0; i < 10; ++i) {
            CAPTURE(model);
            Reals reals = sky_arguments(model, draws);
            reals[2] = 0;
            // 2.326 and 0.274 are rounded, and the ground weighs 1.01^-20 of the sky.
            const double weight = blend(1, 0, 1);
            CHECK(library.value("skybr", reals, {.direction = {0, 0, 1}}) / (reals[1] * weight) ==
                  within(0.004, 1));
        }
    }
}

TEST_CASE("skybright.cal: below the horizon lies the ground") {
    const LibraryFile library = own_library_file("skybright.cal");
    Draws draws;
    for (const int model : {1, 2, 3, 4}) {
        const Reals reals = sky_arguments(model, draws);
        CHECK(library.value("skybr", reals, {.direction = {0, 0, -1}}) == rounded(reals[2]));
    }
}

TEST_CASE("perezlum.cal: the relative luminance of gendaylit's integral") {
    const LibraryFile library = own_library_file("perezlum.cal");
    Draws draws;
    for (int i = 0; i < kDraws; ++i) {
        const PerezArguments sky = perez_arguments(draws);
        Vec3 d = draws.direction();
        d.z = std::abs(d.z);
        if (d.z < 0.02) continue;
        const double gamma = std::acos(std::clamp(dot(d, sky.sun), -1.0, 1.0));
        const double relative = sky.distribution.luminance(std::acos(d.z), gamma);
        CHECK(library.value("skybright", sky.reals, {.direction = d}) ==
              rounded(blend(sky.reals[0] * relative, sky.reals[1], d.z)));
    }
}

TEST_CASE("perezlum_c.cal: the coloured sky is as bright, and bluer where it is clear") {
    const LibraryFile coloured = own_library_file("perezlum_c.cal");
    const LibraryFile grey = own_library_file("perezlum.cal");
    Draws draws;
    for (const double clearness : {1.02, 8.}) {
        PerezArguments sky = perez_arguments(draws);
        Reals reals = sky.reals;
        reals.insert(reals.end(), {clearness, -4.843e9, 2.5568e6, 242.82, 0.23258, -4.843e9,
                                   2.5568e6, 242.82, 0.23258, -1.2848, 1.7519, -0.093786});
        reals[0] = 1e4;  // luminances, so that the clear sky's temperature is defined
        const RayValues ray{{0.6, 0, 0.8}, {0, 0, 1}, {}, 0};
        const double Y = grey.value("skybright", Reals(reals.begin(), reals.begin() + 10), ray);
        const Reals rgb =
            coloured.values(Names{"skybright_r", "skybright_g", "skybright_b"}, reals, ray);
        // Y's row of the inverse of the map from XYZ to the renderer's primaries, to ten digits.
        constexpr double kYr = 0.2696304478;
        constexpr double kYg = 0.6729433562;
        constexpr double kYb = 0.0662129217;
        CHECK(kYr * rgb[0] + kYg * rgb[1] + kYb * rgb[2] == within(1e-9, Y));
        if (clearness > 4.5) CHECK(rgb[2] > rgb[0]);
    }
}

TEST_CASE("illum.cal: azimuths above 0 up to 2 pi, squared cosine of the hemisphere") {
    const LibraryFile library = own_library_file("illum.cal");
    const Reals axes = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    const RayValues ray{{.36, -.48, -.8}, {0, 0, 1}, {}, 0};
    const Reals v = library.values(Names{"il_alt", "il_azi", "il_alth", "il_azih"}, axes, ray);
    CHECK(v[0] == -.8);
    CHECK(v[1] == rounded(2 * kPi + std::atan2(-.48, .36)));
    CHECK(v[2] == rounded(.64));
    CHECK(v[3] == rounded(std::atan2(.48, -.36)));
    CHECK(library.value("il_azi", axes, {.direction = {1, 0, 0}}) == rounded(2 * kPi));
}

TEST_CASE("library: skybright.cal agrees with Radiance's") {
    LIGHTWALK_NEEDS_SHARED(path, "scenes/lib/skybright.cal");
    compare(path, "skybright.cal", {"skybr"}, 1e-6,
            [](int i, Draws& draws) { return sky_arguments(1 + i % 4, draws); });
}

TEST_CASE("library: perezlum.cal agrees with Radiance's") {
    LIGHTWALK_NEEDS_SHARED(path, "scenes/lib/perezlum.cal");
    compare(path, "perezlum.cal", {"skybright"}, 1e-9,
            [](int, Draws& draws) { return perez_arguments(draws).reals; });
}

TEST_CASE("library: surf.cal and rev.cal agree with Radiance's") {
    LIGHTWALK_NEEDS_SHARED(surf, "scenes/lib/surf.cal");
    LIGHTWALK_NEEDS_SHARED(rev, "scenes/lib/rev.cal");
    compare(surf, "surf.cal", {"surf_dx", "surf_dy", "surf_dz"}, 1e-12, [](int i, Draws& draws) {
        Reals reals = draws.reals(13, -2, 2);
        reals[0] = i % 3;
        return reals;
    });
    compare(rev, "rev.cal", {"rev_dx", "rev_dy", "rev_dz"}, 1e-12,
            [](int, Draws& draws) { return draws.reals(4, -2, 2); });
}

TEST_CASE("library: illum.cal agrees with Radiance's") {
    LIGHTWALK_NEEDS_SHARED(path, "scenes/lib/illum.cal");
    compare(path, "illum.cal", {"il_alt", "il_azi", "il_alth", "il_azih"}, 1e-12,
            [](int, Draws& draws) {
                Reals axes;
                const Vec3 z = draws.direction();
                const Vec3 x = perpendicular(z);
                add(axes, x);
                add(axes, cross(z, x));
                add(axes, z);
                return axes;
            });
}

TEST_CASE("library: source.cal agrees with Radiance's in its angles") {
    LIGHTWALK_NEEDS_SHARED(path, "scenes/lib/source.cal");
    compare(path, "source.cal",
            {"src_theta", "src_phi", "src_phi2", "src_phi4", "srcB_vert", "srcB_horiz",
             "srcB_vert2", "srcB_horiz2", "flatcorr(2)", "boxcorr(2)", "cylcorr(2)"},
            1e-9, [](int, Draws& draws) { return draws.reals(4, 0.5, 3); });
}

}  // namespace lightwalk
