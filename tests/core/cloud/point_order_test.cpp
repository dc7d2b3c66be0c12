#include "core/cloud/point_order.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "core/cloud/depth_grid.h"
#include "core/cloud/projection.h"
#include "core/math/random.h"

using namespace lightwalk;

TEST_CASE("cloud: points are told apart by any of their parts") {
    const CloudPoint point;
    std::vector<CloudPoint> others(6, point);
    others[0].position[2] = 1;
    others[1].radiance.b = 1;
    others[2].surface = 1;
    others[3].direction = 1;
    others[4].old = 1;
    others[5].paired = true;
    CHECK(!precedes(point, point));
    for (const CloudPoint& other : others) {
        CHECK(precedes(point, other) != precedes(other, point));
        CHECK(lot(point, 7) != lot(other, 7));
        CHECK(lot(other, 7) != lot(other, 8));
    }
}

TEST_CASE("cloud: of points as near as each other the same one wins, whatever their order") {
    View view;
    view.direction = {0, 1, 0};
    view.horizontal = view.vertical = 40;
    const Camera camera(view);
    const PixelRectangle area{0, 0, 4, 4};
    const PointProjector project(camera, 4, 4);
    std::vector<CloudPoint> points(64);
    for (std::size_t i = 0; i < points.size(); ++i) {
        points[i].position = {0, 2, 0};
        points[i].surface = static_cast<std::uint32_t>(i * 7919 % 64);
    }
    std::vector<ImagePlace> places(points.size());
    const auto winner = [&] {
        CloudGrids grids(area);
        project_points(project, points, 0, points.size(), grids, places);
        return points[grids.ahead.winner(2, 2)].surface;
    };
    const std::uint32_t first = winner();
    std::reverse(points.begin(), points.end());
    CHECK(winner() == first);
    std::rotate(points.begin(), points.begin() + 17, points.end());
    CHECK(winner() == first);
}

TEST_CASE("cloud: a grid that is a part of the picture holds what the whole one does there") {
    View view;
    view.direction = {0, 1, 0};
    view.horizontal = view.vertical = 40;
    const Camera camera(view);
    const PointProjector project(camera, 40, 40);
    RandomStream random(5);
    std::vector<CloudPoint> points(3000);
    for (CloudPoint& point : points) {
        const double depth = 2 + random.next();
        point.position = {static_cast<float>(depth * (random.next() - 0.5)),
                          static_cast<float>(depth),
                          static_cast<float>(depth * (random.next() - 0.5))};
    }
    std::vector<ImagePlace> places(points.size()), again(points.size());
    CloudGrids whole(PixelRectangle{0, 0, 40, 40}), part(PixelRectangle{10, 20, 25, 40});
    project_points(project, points, 0, points.size(), whole, places);
    project_points(project, points, 0, points.size(), part, again);
    for (int y = 20; y < 40; ++y)
        for (int x = 10; x < 25; ++x) CHECK(whole.ahead.winner(x, y) == part.ahead.winner(x, y));
    for (std::size_t i = 0; i < places.size(); ++i) CHECK(places[i].x == again[i].x);
}
