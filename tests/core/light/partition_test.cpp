#include "core/light/partition.h"

#include <doctest/doctest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "tests/core/light/source_examples.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

int part_count(const LightSource& source, const Vec3& point, double subdivision,
               double weight = 1) {
    SourceParts parts;
    Partition{source}(point, partition_size(subdivision, weight), parts);
    return parts.count;
}

/// Irradiance per unit radiance at `point` on a floor facing up: the sum of ω cosθ over all
/// samples.
double irradiance(const LightSource& source, const Vec3& point, double subdivision) {
    RandomStream random(1);
    SourceParts parts;
    Partition{source}(point, partition_size(subdivision, 1), parts);
    double sum = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(parts.count); ++i) {
        if (const auto s = sample_part(source, parts.part[i], parts.count, point, 0, random))
            sum += s->solid_angle * s->direction.z;
    }
    return sum;
}

/// The same exactly, for a rectangle |x| <= a, |y| <= b at height h over the origin; Siegel &
/// Howell, "Thermal Radiation Heat Transfer", configuration factor of a parallel rectangle with a
/// corner over the point, times 4.
double exact_irradiance(double a, double b, double h) {
    const double x = a / h, y = b / h;
    const double rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
    return 4 * 0.5 * (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry));
}

}  // namespace

TEST_CASE("parts of a panel: sizes add up to the whole, and each is small for its distance") {
    for (const double ds : {0.0, 0.2, 0.5, 1.0, 3.0}) {
        CAPTURE(ds);
        const LightSource source = panel(1);
        SourceParts parts;
        Partition{source}({0.3, 0.1, 0}, partition_size(ds, 1), parts);
        double area = 0;
        for (int i = 0; i < parts.count; ++i) {
            const SourcePart& part = parts.part[static_cast<std::size_t>(i)];
            area += part.size.x * part.size.y;
            const Vec3 center = source.center + source.u * part.center.x + source.v * part.center.y;
            const double side = 2 * std::max(part.size.x, part.size.y);
            const bool small = side <= ds * length(center - Vec3{0.3, 0.1, 0});
            CHECK((small || parts.count == 1 || part.size.x * part.size.y == rounded(1.0 / 64)));
        }
        CHECK(area == rounded(1));
    }
}

TEST_CASE("parts of a panel: the count follows size over distance and the ray's weight") {
    CHECK(part_count(panel(0.1), {0, 0, 0}, 0.25) == 1);  // 0.2 m at 1 m
    CHECK(part_count(panel(0.1), {0, 0, 0}, 0.19) == 4);
    CHECK(part_count(panel(1), {0, 0, 0}, 0.05) == kMaxParts);
    CHECK(part_count(panel(0.1), {0, 0, 0}, 0.19, 0.9) == 1);  // faint rays need less
    CHECK(part_count(panel(1), {0, 0, 0}, 0) == 1);
    CHECK(part_count(panel(1), {0, 0, 2}, 0.2) == 0);  // behind
    // A long panel is cut along its length only.
    LightSource strip = panel(1);
    strip.v = {0, 0.01, 0};
    SourceParts parts;
    Partition{strip}({0, 0, 0}, 1.0, parts);
    CHECK(parts.count == 2);
    CHECK(parts.part[0].center.x == -0.5);  // the lower half first
    CHECK(parts.part[1].center.x == 0.5);
    CHECK(parts.part[0].size == Vec3{0.5, 1, 1});
}

TEST_CASE("parts of a tube: along the axis, one when near its surface, none inside") {
    CHECK(part_count(tube(1, 0.02), {0, 0, 0}, 4) == 1);
    CHECK(part_count(tube(1, 0.02), {0, 0, 0}, 1.5) == 2);
    CHECK(part_count(tube(1, 0.02), {0, 0, 0}, 0.01) == kMaxParts);
    CHECK(part_count(tube(1, 0.02), {0.5, 0, 0.97}, 0.2) == 1);
    CHECK(part_count(tube(1, 0.02), {0.5, 0, 0.99}, 0.2) == 0);
}

TEST_CASE("a partitioned panel gives the form factor of the rectangle") {
    const double exact = exact_irradiance(0.5, 0.5, 1);
    CHECK(irradiance(panel(0.5), {0, 0, 0}, 0) == rounded(1.0));  // A cos²/d², far from exact
    // The midpoint rule of 8 x 8 parts gives 0.30 % more than the integral.
    CHECK(irradiance(panel(0.5), {0, 0, 0}, 0.1) == within(0.0001, 1.00298 * exact));
    CHECK(std::abs(irradiance(panel(0.5), {0, 0, 0}, 0.1) - exact) <
          std::abs(irradiance(panel(0.5), {0, 0, 0}, 0.6) - exact));
}

TEST_CASE("inverse square: a lamp's solid angle falls with the square of its distance") {
    LightSource lamp;
    lamp.size = static_cast<float>(kPi * 0.01);
    RandomStream random(1);
    for (const double d : {1.0, 2.0, 10.0}) {
        const auto sample = sample_whole(lamp, {0, d, 0}, 0, random);
        REQUIRE(sample);
        CHECK(sample->solid_angle == float_rounded(kPi * 0.01 / (d * d)));
        CHECK(sample->distance == rounded(d));
        CHECK(length(sample->direction - Vec3{0, -1, 0}) < kRounding);
    }
    CHECK_FALSE(sample_whole(lamp, {0, 0, 0}, 0, random));  // in its centre there is no direction
}

TEST_CASE("a tube's projected area falls with the sine of the angle to its axis") {
    RandomStream random(1);
    const LightSource source = tube(0.1, 0.01);
    const Vec3 point = source.center + Vec3{3, 4, 0};
    const auto sample = sample_whole(source, point, 0, random);
    REQUIRE(sample);
    CHECK(sample->solid_angle == float_rounded(0.8 * 0.004 / 25));
    CHECK_FALSE(sample_whole(source, source.center + Vec3{5, 0, 0}, 0, random));  // end on
}

TEST_CASE("a glow reaches as far as its radius: its centre for samples, its edge for the source") {
    LightSource glow = panel(0.5);
    glow.material_type = PrimitiveType::glow;
    glow.proximity = 2;
    glow.radius = 0.7f;
    RandomStream random(1);
    CHECK(sample_whole(glow, {0, 0, -0.99}, 0, random));
    CHECK_FALSE(sample_whole(glow, {0, 0, -1.01}, 0, random));
    CHECK_FALSE(out_of_reach(glow, {0, 0, -1.69}));
    CHECK(out_of_reach(glow, {0, 0, -1.71}));
}

TEST_CASE("a spotlight: nothing outside the cone, the focal length adds to the distance inside") {
    LightSource lamp = panel(0.1);
    lamp.spot = SpotShape{
        {0, 0, -1}, static_cast<float>(2 * kPi * (1 - std::cos(30 * kPi / 180))), 1, false};
    RandomStream random(1);
    const auto below = sample_whole(lamp, {0, 0, 0}, 0, random);
    REQUIRE(below);
    CHECK(below->solid_angle == float_rounded(0.04 / 4));  // distance 1 + focal length 1
    CHECK(sample_whole(lamp, {std::tan(29.9 * kPi / 180), 0, 0}, 0, random));
    CHECK_FALSE(sample_whole(lamp, {std::tan(30.1 * kPi / 180), 0, 0}, 0, random));
}

TEST_CASE("jitter: samples fill a panel's part, a disk and a sphere, and nothing beyond") {
    RandomStream random(3);
    LightSource disk = panel(0.5 * std::sqrt(kPi));
    disk.shape = PrimitiveType::ring;
    LightSource ball;
    ball.u = {kSphereBox, 0, 0};
    ball.v = {0, kSphereBox, 0};
    ball.w = {0, 0, kSphereBox};
    double farthest_disk = 0, farthest_ball = 0, mean_x = 0;
    constexpr int kSamples = 4000;
    for (int i = 0; i < kSamples; ++i) {
        const Vec3 below{0, 0, -100}, beside{0, 1e4, 0};
        const auto s = sample_whole(disk, below, 1, random);
        REQUIRE(s);
        const Vec3 hit = below + s->direction * s->distance;
        farthest_disk = std::max(farthest_disk, std::hypot(hit.x, hit.y));
        mean_x += hit.x / kSamples;
        const auto b = sample_whole(ball, beside, 1, random);
        REQUIRE(b);
        farthest_ball = std::max(farthest_ball, length(beside + b->direction * b->distance));
    }
    // Up to the edge but for the floats of size and radius; the farthest 6 % of a disk's area, 3 %
    // of a cube's, are missed by 4000 samples with a chance of e^-120.
    CHECK(farthest_disk <= 1 + kFloatRounding);
    CHECK(farthest_disk > 0.97);
    CHECK(farthest_ball <= 1 + kFloatRounding);
    CHECK(farthest_ball > 0.97);
    CHECK(std::abs(mean_x) < 5 * 0.5 / std::sqrt(kSamples));
}

TEST_CASE("without jitter no random numbers are drawn") {
    RandomStream used(5), fresh(5);
    (void)sample_whole(panel(1), {0, 0, 0}, 0, used);
    CHECK(used.next() == fresh.next());
}
