// What rough materials show of a lamp is the integral of their lobe over it, whether directions are
// sampled from the lobe or on the lamp.
#include <doctest/doctest.h>

#include <functional>
#include <string>
#include <vector>

#include "core/material/lobes.h"
#include "tests/core/chi_square.h"
#include "tests/core/material/surroundings.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const LobeFrame kUpright{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/// A panel near the mirror direction, or, for a side of -1, below the surface.
struct Panel {
    double side = 1;
    Vec3 corner{1.2, -0.3, 1.1 * side}, u{-0.3, 0, 0.3 * side}, v{0, 1, 0};

    [[nodiscard]] std::string text() const {
        std::string corners;
        const Vec3 first = side > 0 ? u : v, last = side > 0 ? v : u;  // it faces the origin
        for (const Vec3& p : {corner, corner + first, corner + u + v, corner + last})
            for (std::size_t k = 0; k < 3; ++k) corners += " " + std::to_string(p[k]);
        return "bright polygon panel 0 0 12" + corners + "\n";
    }
    /// Integral of a function of direction over the panel's solid angle, as the origin sees it.
    [[nodiscard]] double integral(const std::function<double(const Vec3&)>& f) const {
        const Vec3 area = cross(u, v);
        return integrate(
            [&](double x, double y) {
                const Vec3 way = corner + u * x + v * y, wi = normalize(way);
                return f(wi) * std::abs(dot(area, wi)) / length_squared(way);
            },
            0, 1, 0, 1, 1e-9);
    }
};

struct Mean {
    double value = 0, error = 0;
};

/// What the origin shows of a bright panel on average: of a light, which is sampled directly, or of
/// a glow, which only rays of the lobe see.
Mean shown(const std::string& material, const Panel& panel, const Vec3& wo, bool light) {
    RenderOptions options = TestScene::exact();
    options.specular_threshold = 0;
    options.weight_limit = 1e-9;
    options.specular_samples = 1500;
    options.source_jitter = 1;
    options.source_subdivision = 0.05;
    const std::string bright =
        light ? "void light bright 0 0 3 1 1 1\n" : "void glow bright 0 0 4 1 1 1 0\n";
    TestScene scene(bright + panel.text() + material + sheet("floor"), options);
    constexpr int kTraces = 40;
    double sum = 0, squares = 0;
    for (std::uint32_t i = 0; i < kTraces; ++i) {
        const auto value = static_cast<double>(scene.trace(wo, -wo, i).value.g);
        sum += value;
        squares += value * value;
    }
    const double mean = sum / kTraces;
    return {mean, std::sqrt((squares / kTraces - mean * mean) / (kTraces - 1))};
}

void check(const Mean& found, double expected) {
    CAPTURE(found.value);
    CAPTURE(expected);
    REQUIRE(found.error < 0.03 * expected);
    CHECK(std::abs(found.value - expected) < 4 * found.error + 1e-5 * expected);
}

/// Seen from 40 degrees, and from 67, where some of the lobe lies below the surface.
const std::vector<Vec3> kEyes{normalize(Vec3{-0.6, 0.2, 0.75}), normalize(Vec3{-0.92, 0.1, 0.4})};

}  // namespace

TEST_CASE(
    "highlights: Ward's lobe, isotropic and brushed, sampled from the lobe or from the lamp") {
    const Panel panel;
    for (const Vec3& wo : kEyes) {
        for (const auto& [material, alpha_u, alpha_v] :
             {std::tuple{"void metal m 0 0 5 1 1 1 1 .3\n", 0.3, 0.3},
              {"void metal2 m 4 1 0 0 . 0 6 1 1 1 1 .15 .4\n", 0.15, 0.4}}) {
            CAPTURE(std::string(material));
            const WardReflection lobe{wo, kUpright, alpha_u, alpha_v};
            const double expected =
                panel.integral([&](const Vec3& wi) { return lobe.eval(wi) * wi.z; });
            check(shown(material, panel, wo, true), expected);
            check(shown(material, panel, wo, false), expected);
        }
    }
}

TEST_CASE("highlights: the Ashikhmin-Shirley lobe, whose samples weigh 1") {
    const Panel panel;
    const char* material = "void ashik2 m 4 1 0 0 . 0 8 0 0 0 1 1 1 12 30\n";
    for (const Vec3& wo : kEyes) {
        const AshikhminReflection lobe{wo, wo.z, kUpright, 12, 30};
        check(shown(material, panel, wo, true),
              panel.integral([&](const Vec3& wi) { return lobe.eval(wi) * wi.z; }));
        // Rejected trials are drawn again.
        const double accepted =
            sphere_integral(DirectionCells{{0, 0, 1}, 1, 30, 30},
                            [&](const Vec3& wi) { return wi.z > 0 ? lobe.pdf(wi) : 0; });
        check(shown(material, panel, wo, false),
              panel.integral([&](const Vec3& wi) { return lobe.pdf(wi); }) / accepted);
    }
}

TEST_CASE("highlights: Ward's transmitted lobe, whose samples weigh 1") {
    const Panel panel{-1};
    for (const Vec3& wo : {kEyes[0], normalize(Vec3{-0.8, 0.1, 0.65})}) {
        for (const auto& [material, alpha_u, alpha_v] :
             {std::tuple{"void trans m 0 0 7 1 1 1 0 .3 1 1\n", 0.3, 0.3},
              {"void trans2 m 4 1 0 0 . 0 8 1 1 1 0 .25 .5 1 1\n", 0.25, 0.5}}) {
            CAPTURE(std::string(material));
            const WardTransmission lobe{-wo, wo.z, kUpright, alpha_u, alpha_v};
            check(shown(material, panel, wo, false),
                  panel.integral([&](const Vec3& wi) { return lobe.pdf(wi); }));
        }
    }
}
