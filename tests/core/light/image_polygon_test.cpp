#include "core/light/image_polygon.h"

#include <doctest/doctest.h>

#include <initializer_list>

#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

ImagePolygon polygon(std::initializer_list<ImagePoint> corners) {
    ImagePolygon made;
    for (const ImagePoint& p : corners) made.add(p);
    return made;
}

}  // namespace

TEST_CASE("image polygon: area, centre and width") {
    const ImagePolygon box = polygon({{1, 1}, {4, 1}, {4, 2}, {1, 2}});
    CHECK(box.area() == 3);
    CHECK(box.center().x == 2.5);
    CHECK(box.width(1) == rounded(1));
    CHECK(box.width(10) == rounded(3));
    CHECK(polygon({{0, 0}, {3, 0}, {0, 4}}).width(1) ==
          rounded(12.0 / 5));  // height over the hypotenuse
}

TEST_CASE("image polygon: the cells share its area") {
    const ImagePolygon slanted = polygon({{0.3, 0.4}, {2.7, 1.1}, {1.9, 2.6}, {0.2, 1.7}});
    double sum = 0;
    for (int y = 0; y < 3; ++y) {
        for (int x = 0; x < 3; ++x) {
            const double area = slanted.clip_to_cell(x, y).area();
            CHECK(area <= 1 + kRounding);
            sum += area;
        }
    }
    CHECK(sum == rounded(slanted.area()));
    CHECK(slanted.clip_to_cell(5, 5).size() == 0);
    CHECK(polygon({{-9, -9}, {9, -9}, {9, 9}, {-9, 9}}).clip_to_cell(2, 3).area() == rounded(1));
}

TEST_CASE("image polygon: corners inside the outline go") {
    ImagePolygon dented = polygon({{0, 0}, {2, 0}, {2, 2}, {1, 0.5}, {0, 2}});
    dented.make_convex();
    CHECK(dented.size() == 4);
    CHECK(dented.area() == rounded(4));
    ImagePolygon triangle = polygon({{0, 0}, {1, 0}, {0, 1}});
    triangle.make_convex();
    CHECK(triangle.size() == 3);
}
