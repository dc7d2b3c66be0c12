#include "core/view/pixel_rays.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

View view(char type) {
    View v;
    v.type = type;
    v.position = {1, 2, 3};
    v.direction = {0, 2, 0};  // focus at 2 m
    v.horizontal = v.vertical = type == 'l' ? 4 : 60;
    return v;
}

PixelOptions options(double jitter, double aperture = 0) {
    PixelOptions o;
    o.jitter = jitter;
    o.aperture = aperture;
    return o;
}

}  // namespace

TEST_CASE("without jitter a pixel's ray goes through its centre") {
    const Camera camera(view('v'));
    const PixelRays rays(camera, nullptr, 10, 8, options(0), 0);
    const auto ray = rays(3, 6).ray;
    const auto expected = camera.ray(3.5 / 10, 6.5 / 8);
    REQUIRE(ray);
    REQUIRE(expected);
    CHECK(ray->direction == expected->direction);
    CHECK(ray->origin == expected->origin);
    CHECK(rays.pinhole());
}

TEST_CASE(
    "jitter J spreads rays uniformly over the pixel's middle J, each pixel with its own numbers") {
    const Camera camera(view('l'));  // parallel: the origin tells the place
    const int size = 100;
    const double jitter = 0.5;
    const PixelRays rays(camera, nullptr, size, size, options(jitter), 1);
    double sum = 0;
    double squares = 0;
    double widest = 0;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const auto ray = rays(x, y).ray;
            REQUIRE(ray);
            const double h = (ray->origin.x - 1) / 4 + 0.5;
            const double offset = h * size - x - 0.5;
            sum += offset;
            squares += offset * offset;
            widest = std::max(widest, std::abs(offset));
        }
    }
    const double n = size * size;
    CHECK(widest <= jitter / 2 + kRounding * size);
    // 10^4 offsets all miss the outer 2 % with a chance of e^-200.
    CHECK(widest > 0.49 * jitter);
    // Uniform over a width J: mean 0, variance J²/12, each within 5 standard errors.
    const double variance = jitter * jitter / 12;
    CHECK(std::abs(sum / n) < 5 * std::sqrt(variance / n));
    CHECK(std::abs(squares / n - variance) <
          5 * std::sqrt((jitter * jitter * jitter * jitter / 80 - variance * variance) / n));
}

TEST_CASE("a pixel's ray is the same each time, and another with another seed") {
    const Camera camera(view('v'));
    const PixelRays a(camera, nullptr, 10, 8, options(0.67), 0);
    const PixelRays b(camera, nullptr, 10, 8, options(0.67), 1);
    CHECK(a(2, 3).ray->direction == a(2, 3).ray->direction);
    CHECK_FALSE(a(2, 3).ray->direction == b(2, 3).ray->direction);
}

TEST_CASE("with several samples each goes through its place of the filter, whatever the jitter") {
    const Camera camera(view('l'));
    for (const double jitter : {0.0, 0.67}) {
        PixelOptions several = options(jitter);
        several.samples = 5;
        const PixelRays rays(camera, nullptr, 10, 8, several, 1);
        for (int s = 0; s < 5; ++s) {
            RandomStream random = RandomStream::of_pixel(1, 3, 6, static_cast<std::uint32_t>(s));
            const PixelOffset off = pixel_sample(1, 3, 6, s, 5, random.next());
            const PixelRay pixel = rays(3, 6, s);
            REQUIRE(pixel.ray);
            const auto expected = camera.ray((3.5 + off.x) / 10, (6.5 + off.y) / 8);
            CHECK(length(pixel.ray->origin - expected->origin) < 1e-12);
            RandomStream left = pixel.random;
            CHECK(left.next() == random.next());  // goes on where the place was drawn
        }
    }
}

TEST_CASE("with a lens all rays of a pixel meet in the focal plane and start on the lens") {
    for (const char type : {'v', 'l'}) {
        CAPTURE(type);
        const Camera camera(view(type));
        const double aperture = 0.2;
        const auto sharp = PixelRays(camera, nullptr, 10, 8, options(0), 0)(7, 2).ray;
        REQUIRE(sharp);
        const Vec3 target = sharp->origin + 2 / sharp->direction.y * sharp->direction;
        double farthest = 0;
        for (std::uint64_t seed = 0; seed < 200; ++seed) {
            const PixelRays rays(camera, nullptr, 10, 8, options(0, aperture), seed);
            CHECK_FALSE(rays.pinhole());
            const auto ray = rays(7, 2).ray;
            REQUIRE(ray);
            const Vec3 met =
                ray->origin + (target.y - ray->origin.y) / ray->direction.y * ray->direction;
            CHECK(length(met - target) < kRounding);
            const double off = length(ray->origin - sharp->origin);
            CHECK(off <= aperture / 2 + kRounding);
            farthest = std::max(farthest, off);
        }
        CHECK(farthest > 0.45 * aperture);  // 200 miss the outer fifth with a chance of e^-42
    }
}

TEST_CASE("motion blur lies between the views of two frames") {
    const Camera now(view('v'));
    View moved = view('v');
    moved.position.x += 1;
    const Camera before(moved);
    PixelOptions blur = options(0);
    blur.motion = 0.5;
    double least = 1e9;
    double most = -1e9;
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        const PixelRays rays(now, &before, 10, 8, blur, seed);
        CHECK_FALSE(rays.pinhole());
        const auto ray = rays(4, 4).ray;
        REQUIRE(ray);
        least = std::min(least, ray->origin.x - 1);
        most = std::max(most, ray->origin.x - 1);
        CHECK(length(ray->direction) == rounded(1));
    }
    CHECK(least >= -0.25);
    CHECK(most <= 0.25);
    CHECK(most - least > 0.45);  // 300 miss a twentieth at either end with a chance of e^-15
}
