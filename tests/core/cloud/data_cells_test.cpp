#include "core/cloud/data_cells.h"

#include <doctest/doctest.h>

#include <cmath>
#include <set>
#include <string>

#include "core/cloud/visibility_probe.h"
#include "tests/core/material/bsdf_files.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

constexpr const char* kPane = "void aBSDF m 5 a.xml 0 0 1 . 0 0\n";

/// A window of material m in the plane y = 0, whose normal is towards -y, and a wall behind it.
TestScene room_with(const std::string& material) {
    return TestScene(material +
                         "void plastic grey 0 0 5 .5 .5 .5 0 0\n"
                         "m polygon window 0 0 12  -9 0 -9  9 0 -9  9 0 9  -9 0 9\n"
                         "grey polygon wall 0 0 12  -9 2 -9  9 2 -9  9 2 9  -9 2 9\n",
                     TestScene::exact(), with_file(bsdf_of(quarter(0.1 / kPi, 0.5), {})));
}

/// The cells of directions that are so far from the window's normal, from the front or from behind.
std::set<std::uint32_t> cells_at(const TestScene& room, double degrees, bool front) {
    const DataCells cells(room.scene);
    const double polar = degrees * kPi / 180;
    std::set<std::uint32_t> found;
    for (int k = 0; k < 360; ++k) {
        const double azimuth = (k + 0.5) * kPi / 180;
        const Vec3 direction{std::sin(polar) * std::cos(azimuth),
                             front ? std::cos(polar) : -std::cos(polar),
                             std::sin(polar) * std::sin(azimuth)};
        const Hit hit =
            room.scene.geometry().intersect({Vec3{0, 0, 0} - direction, direction, kHuge});
        REQUIRE(hit.exists());
        found.insert(cells.find(hit, direction));
    }
    return found;
}

/// What the probe says of the wall's middle, seen from a point before the window.
std::uint32_t middle_from(const TestScene& room, const Vec3& eye) {
    const VisibilityProbe probe(room.tracer);
    const RaySegment ray{eye, normalize(Vec3{0, 2, 0} - eye), kHuge};
    const Hit hit = room.scene.geometry().intersect(ray);
    PixelVisibility seen;
    seen.ray = true;
    VisibilityProbe::Scratch scratch;
    probe.find({&ray, 1}, {&hit, 1}, {}, {&seen, 1}, scratch);
    REQUIRE(seen.ahead.seen);
    CHECK(seen.ahead.kind == PointKind::through);
    return seen.ahead.surface;
}

}  // namespace

TEST_CASE("a pane of data is seen in as many cells as its basis has patches") {
    const TestScene room = room_with(kPane);
    for (const bool front : {true, false}) {
        CAPTURE(front);
        CHECK(cells_at(room, 5, front).size() == 1);
        CHECK(cells_at(room, 18, front).size() == 8);
        CHECK(cells_at(room, 36, front).size() == 12);
        CHECK(cells_at(room, 18, front).count(0) == 0);
    }
    const std::string computed = "void aBSDF m 5 a.xml 0 0 1+0 . 0 0\n";
    for (const std::string& other : {std::string("void glass m 0 0 3 .8 .8 .8\n"), computed}) {
        CAPTURE(other);
        CHECK(cells_at(room_with(other), 18, true) == std::set<std::uint32_t>{0});
    }
}

TEST_CASE("what is seen through a pane of data is another thing in each cell of the data") {
    const TestScene data = room_with(kPane), glass = room_with("void glass m 0 0 3 .8 .8 .8\n");
    const Vec3 straight{0, -3, 0}, near{0.3, -3, 0}, far{1.5, -3, 0};  // 3 and 17 degrees
    CHECK(middle_from(data, straight) == middle_from(data, near));
    CHECK(middle_from(data, straight) != middle_from(data, far));
    CHECK(middle_from(glass, straight) == middle_from(glass, far));
}
