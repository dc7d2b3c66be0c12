#include "core/cloud/sparse_hits.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/test_scene.h"

using namespace lightwalk;
using lightwalk::test::TestScene;

namespace {

constexpr int kPixels = 64;  // a side of the picture

/// Through a pixel's middle, from the origin along y, forty-five degrees wide.
RaySegment ray_through(const PixelPlace& place) {
    const double side = 2 * std::tan(kPi / 8);
    const double x = (place.x + 0.5) / kPixels - 0.5, z = (place.y + 0.5) / kPixels - 0.5;
    return {{0, 0, 0}, normalize(Vec3{side * x, 1, side * z}), kHuge};
}

std::vector<Hit> sparse_hits(const Geometry& geometry, const std::vector<PixelPlace>& places,
                             int spacing) {
    SparseHits sparse;
    std::vector<RaySegment> rays;
    for (const PixelPlace& place : places) rays.push_back(ray_through(place));
    for (const PixelPlace& corner : sparse.corners(places, spacing))
        rays.push_back(ray_through(corner));
    std::vector<Hit> hits(rays.size());
    sparse.find(geometry, rays, hits);
    hits.resize(places.size());
    return hits;
}

/// Square by square, those for which `chosen` holds.
template <class Choose>
std::vector<PixelPlace> pixels(Choose chosen) {
    std::vector<PixelPlace> places;
    for (int v = 0; v < kPixels; v += SparseHits::kSide)
        for (int u = 0; u < kPixels; u += SparseHits::kSide)
            for (int y = v; y < v + SparseHits::kSide; ++y)
                for (int x = u; x < u + SparseHits::kSide; ++x)
                    if (chosen(x, y)) places.push_back({x, y});
    return places;
}

/// The number of pixels whose surface is another than the one that their own ray meets; all others
/// must lie where their rays meet it.
std::size_t wrong_surfaces(const Geometry& geometry, const std::vector<PixelPlace>& places,
                           int spacing) {
    const std::vector<Hit> hits = sparse_hits(geometry, places, spacing);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const RaySegment ray = ray_through(places[i]);
        const Hit own = geometry.intersect(ray);
        CAPTURE(places[i].x);
        CAPTURE(places[i].y);
        if (hits[i].surface != own.surface) {
            ++wrong;
            continue;
        }
        REQUIRE(hits[i].exists() == own.exists());
        if (!own.exists()) continue;
        REQUIRE(hits[i].t == doctest::Approx(own.t).epsilon(1e-9));
        REQUIRE(length(hits[i].position - own.position) < 1e-9 * own.t);
        REQUIRE(hits[i].cos_out == doctest::Approx(own.cos_out).epsilon(1e-9));
        REQUIRE(hits[i].normal == own.normal);
        REQUIRE(hits[i].modifier == own.modifier);
    }
    return wrong;
}

const auto all = [](int, int) { return true; };

// A slanted wall, a lamp and a box in front of it, and nothing above; a pixel is .0129 of the
// distance.
const std::string kRoom = R"(
void plastic grey 0 0 5 .5 .5 .5 0 0
void plastic red 0 0 5 .5 .1 .1 0 0
grey polygon wall 0 0 12  -9 4 -9  9 6 -9  9 6 1  -9 4 1
red sphere lamp 0 0 4  -.5 3 -.5 .3
red polygon picture 0 0 12  .2 3 -.4  .7 3 -.4  .7 3 .2  .2 3 .2
)";

}  // namespace

TEST_CASE("sparse hits: what is wider than the spacing is seen by every pixel, to the pixel") {
    const TestScene room(kRoom);
    for (const int spacing : {2, 4}) {
        CAPTURE(spacing);
        CHECK(wrong_surfaces(room.scene.geometry(), pixels(all), spacing) == 0);
    }
}

TEST_CASE("sparse hits: where few pixels of a square are asked for each has a ray of its own") {
    // A wire that is thinner than a cell.
    const TestScene room(kRoom +
                         "red polygon wire 0 0 12 .055 2 -1  .08 2 -1  .08 2 1  .055 2 1\n");
    const auto few = pixels([](int x, int y) { return (x + 3 * y) % 5 == 0; });
    CHECK(wrong_surfaces(room.scene.geometry(), few, 4) == 0);
    CHECK(wrong_surfaces(room.scene.geometry(), pixels(all), 4) > 0);  // else this tests nothing
    CHECK(wrong_surfaces(room.scene.geometry(), pixels(all), 1) == 0);
}

TEST_CASE("sparse hits: pixels that are missing in a square change nothing for the others") {
    const TestScene room(kRoom);
    for (const int missing : {2, 3, 5}) {
        CAPTURE(missing);
        const auto others = pixels([&](int x, int y) { return (x + y) % missing != 0; });
        CHECK(wrong_surfaces(room.scene.geometry(), others, 4) == 0);
    }
}

TEST_CASE("sparse hits: coplanar surfaces of one name are told apart, curved ones are cast") {
    const TestScene floor(R"(
void plastic grey 0 0 5 .5 .5 .5 0 0
grey polygon left 0 0 12  -9 4 -9  0 4 -9  0 4 9  -9 4 9
grey polygon right 0 0 12  0 4 -9  9 4 -9  9 4 9  0 4 9
grey cylinder pipe 0 0 7  -9 2 .3  9 2 .3  .2
)");
    CHECK(wrong_surfaces(floor.scene.geometry(), pixels(all), 4) == 0);
}
