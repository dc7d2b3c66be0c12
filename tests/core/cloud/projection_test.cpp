#include "core/cloud/projection.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "core/math/random.h"

using namespace lightwalk;

namespace {

View view_of_type(char type) {
    View view;
    view.type = type;
    view.position = {1, -2, 0.5};
    view.direction = {0.3, 1, 0.2};
    view.horizontal = type == 'l' ? 8 : 100;
    view.vertical = type == 'l' ? 6 : 70;
    view.fore = 0.25;
    view.shift = 0.1;
    view.lift = -0.2;
    return view;
}

CloudPoint point_at(const Vec3& place, PointKind kind = PointKind::plain) {
    CloudPoint point;
    point.position = {static_cast<float>(place.x), static_cast<float>(place.y),
                      static_cast<float>(place.z)};
    point.kind = kind;
    return point;
}

constexpr int kProjectionWidth = 64, kProjectionHeight = 48;

}  // namespace

TEST_CASE("cloud: a point on a pixel's ray is projected onto that place, in every type of view") {
    for (const char type : std::string("vlchas")) {
        CAPTURE(type);
        const Camera camera(view_of_type(type));
        const PointProjector project(camera, kProjectionWidth, kProjectionHeight);
        RandomStream random(7);
        int shown = 0;
        for (int i = 0; i < 500; ++i) {
            const double h = random.next(), v = random.next();
            const auto ray = camera.ray(h, v);
            if (!ray) continue;
            ++shown;
            const double distance = 0.5 + 20 * random.next();
            const ImagePlace place = project(ray->origin + ray->direction * distance);
            // Single precision of a coordinate of at most 64 pixels, and of twenty metres.
            CHECK(static_cast<double>(place.x) ==
                  doctest::Approx(h * kProjectionWidth).epsilon(1e-5));
            CHECK(static_cast<double>(place.y) ==
                  doctest::Approx(v * kProjectionHeight).epsilon(1e-5));
            CHECK(static_cast<double>(place.distance) == doctest::Approx(distance).epsilon(1e-5));
        }
        CHECK(shown > 100);
    }
}

TEST_CASE(
    "cloud: what lies behind the eye, before the fore plane or beside the picture is not shown") {
    const Camera camera(view_of_type('v'));
    const PointProjector project(camera, kProjectionWidth, kProjectionHeight);
    const Vec3 eye = camera.view().position;
    CHECK(project(eye - camera.forward() * 3).distance == 0);
    CHECK(project(eye + camera.forward() * 0.2).distance == 0);
    CHECK(project(eye + camera.forward() + camera.right() * 9).distance == 0);
}

TEST_CASE("cloud: many points are projected to the places of each, what is gone to none") {
    for (const char type : std::string("vl")) {
        for (const double aft : {0.0, 4.0}) {
            CAPTURE(type);
            CAPTURE(aft);
            View view = view_of_type(type);
            view.aft = aft;
            const Camera camera(view);
            const PointProjector project(camera, kProjectionWidth, kProjectionHeight);
            RandomStream random(5);
            std::vector<CloudPoint> points(333);  // no multiple of what is taken at a time
            for (CloudPoint& point : points) {
                const Vec3 off{random.next() - 0.5, random.next() - 0.5, random.next() - 0.5};
                point = point_at(view.position + camera.forward() * 2.0 + off * 6.0);
            }
            points[7].kind = PointKind::gone;
            std::vector<ImagePlace> places(points.size());
            project(points, places);
            std::ptrdiff_t shown = 0;
            for (std::size_t i = 0; i < points.size(); ++i) {
                const ImagePlace one = i == 7 ? ImagePlace{} : project(points[i].place());
                CHECK(places[i].x == one.x);
                CHECK(places[i].y == one.y);
                CHECK(places[i].distance == one.distance);
                shown += one.distance > 0;
            }
            CHECK(shown > 20);
            CHECK(shown < std::ssize(points) - 20);
        }
    }
}

TEST_CASE("cloud: a cell keeps the nearest point, whoever comes first") {
    DepthGrid grid(PixelRectangle{0, 0, 4, 2});
    CHECK(grid.winner(3, 1) == kNoPoint);
    grid.offer(3, 1, 2.0f, 0.1f, 5);
    grid.offer(3, 1, 1.0f, 0.4f, 9);
    grid.offer(3, 1, 3.0f, 0, 1);
    CHECK(grid.winner(3, 1) == 9);
    SUBCASE("of about equally near ones the one nearest to the pixel's centre") {
        grid.offer(3, 1, 1.001f, 0.2f, 10);
        CHECK(grid.winner(3, 1) == 10);
    }
    SUBCASE("of equals the one with the lowest index") {
        grid.offer(3, 1, 1.0f, 0.4f, 7);
        grid.offer(3, 1, 1.0f, 0.4f, 8);
        CHECK(grid.winner(3, 1) == 7);
    }
    grid.clear(0, grid.size());
    CHECK(grid.winner(3, 1) == kNoPoint);
}

TEST_CASE("cloud: the winners do not depend on how the points are divided") {
    const Camera camera(view_of_type('v'));
    const PointProjector project(camera, kProjectionWidth, kProjectionHeight);
    RandomStream random(3);
    std::vector<CloudPoint> points;
    for (int i = 0; i < 5000; ++i) {
        const auto ray = camera.ray(random.next(), random.next());
        points.push_back(point_at(ray->origin + ray->direction * (1 + 4 * random.next()),
                                  i % 3 == 0 ? PointKind::mirrored : PointKind::plain));
    }
    std::vector<ImagePlace> places(points.size());
    const PixelRectangle all{0, 0, kProjectionWidth, kProjectionHeight};
    CloudGrids whole(all), parts(all);
    project_points(project, points, 0, points.size(), whole, places);
    for (std::size_t last = points.size(); last > 0;) {  // backwards
        const std::size_t first = last > 700 ? last - 700 : 0;
        project_points(project, points, first, last, parts, places);
        last = first;
    }
    for (int y = 0; y < kProjectionHeight; ++y) {
        for (int x = 0; x < kProjectionWidth; ++x) {
            CHECK(whole.ahead.winner(x, y) == parts.ahead.winner(x, y));
            CHECK(whole.mirrored.winner(x, y) == parts.mirrored.winner(x, y));
        }
    }
}

TEST_CASE("cloud: surroundings are what the nine cells around each pixel hold") {
    constexpr int kWide = 13, kHigh = 11;
    DepthGrid grid(PixelRectangle{2, 3, 2 + kWide, 3 + kHigh});
    RandomStream random(5);
    std::vector<int> depths(std::size_t{kWide} * kHigh, -1);
    for (int i = 0; i < kWide * kHigh; ++i) {
        if (random.next() < 0.4) continue;
        const int step = static_cast<int>(100 * random.next());  // of the keys' seven bits
        depths[static_cast<std::size_t>(i)] = step;
        grid.offer(2 + i % kWide, 3 + i / kWide, 1 + static_cast<float>(step) / 128, 0, 7);
    }
    for (const PixelPlace corner : {PixelPlace{0, 0}, PixelPlace{8, 0}, PixelPlace{8, 8}}) {
        const auto found = grid.surroundings(corner);
        for (int i = 0; i < 64; ++i) {
            const int x = corner.x + i % 8, y = corner.y + i / 8;
            if (!grid.area().contains({x, y})) continue;
            int known = 0, least = 1000, most = -1;
            for (int v = y - 1; v <= y + 1; ++v) {
                for (int u = x - 1; u <= x + 1; ++u) {
                    if (!grid.area().contains({u, v})) continue;
                    const int depth = depths[static_cast<std::size_t>((v - 3) * kWide + u - 2)];
                    if (depth < 0) continue;
                    ++known;
                    least = std::min(least, depth);
                    most = std::max(most, depth);
                }
            }
            CHECK(found.known[static_cast<std::size_t>(i)] == known);
            if (known > 0) CHECK(found.spread[static_cast<std::size_t>(i)] == most - least);
        }
    }
}

TEST_CASE("cloud: a square is empty when neither its cells nor those around it hold a point") {
    const PixelPlace corner{8, 8};
    for (int y = 5; y < 20; ++y) {
        for (int x = 5; x < 20; ++x) {
            DepthGrid grid(PixelRectangle{5, 5, 20, 20});
            CHECK(grid.is_empty(corner));
            grid.offer(x, y, 1, 0, 7);
            const bool beside = x >= 7 && x <= 16 && y >= 7 && y <= 16;
            CHECK(grid.is_empty(corner) == !beside);
        }
    }
}
