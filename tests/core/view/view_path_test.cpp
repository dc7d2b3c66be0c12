#include "core/view/view_path.h"

#include <doctest/doctest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "core/error.h"

using namespace lightwalk;

namespace {

View view_at(double x) {
    View view;
    view.position = {x, 2 * x, 1};
    return view;
}

}  // namespace

TEST_CASE("view path: it passes through its keys, and evenly where these are even") {
    const ViewPath path({{1, view_at(0)}, {2, view_at(3)}, {4, view_at(9)}, {5, view_at(12)}});
    CHECK(path.begin() == 1);
    CHECK(path.end() == 5);
    for (const auto& [time, x] :
         {std::pair{1.0, 0.0}, std::pair{2.0, 3.0}, std::pair{4.0, 9.0}, std::pair{5.0, 12.0}})
        CHECK(path.at(time).position == Vec3{x, 2 * x, 1});
    CHECK(path.at(2.7).position.x == doctest::Approx(5.1));
    CHECK(path.at(0) == view_at(0));
    CHECK(path.at(9) == view_at(12));
}

TEST_CASE("view path: no jump of speed at a key") {
    const ViewPath path({{0, view_at(0)}, {1, view_at(5)}, {3, view_at(2)}, {4, view_at(8)}});
    constexpr double h = 1e-6;
    for (const double t : {1.0, 3.0}) {
        const double x = path.at(t).position.x;
        const double before = (x - path.at(t - h).position.x) / h;
        const double after = (path.at(t + h).position.x - x) / h;
        CHECK(before == doctest::Approx(after).epsilon(1e-4));
    }
}

TEST_CASE("view path: what is no path is told") {
    CHECK_THROWS_WITH_AS(ViewPath({}), "a path needs a view", InputError);
    CHECK_THROWS_WITH_AS(ViewPath({{1, view_at(0)}, {1, view_at(1)}}),
                         "the times of a path must rise", InputError);
    View other = view_at(1);
    other.type = 'h';
    CHECK_THROWS_WITH_AS(ViewPath({{1, view_at(0)}, {2, other}}),
                         "the views of a path are of one type", InputError);
}

TEST_CASE("walk: a step to the side shifts what lies at the distance by its share of the picture") {
    View view;
    view.direction = {0, 3, 0};
    const Vec3 middle{0, 5, 0};
    for (const auto& [move, expected] :
         {std::pair{WalkMove::right, 0.5 - 0.03}, std::pair{WalkMove::left, 0.5 + 0.03}}) {
        const Camera camera(walked_view(view, move, 3, 0.01, 5));
        CHECK(camera.locate(middle).h == doctest::Approx(expected));
    }
    const Vec3 on = walked_view(view, WalkMove::forward, 3, 0.01, 5).position;
    CHECK(on.y == doctest::Approx(walked_view(view, WalkMove::right, 3, 0.01, 5).position.x));
    CHECK(walked_view(view, WalkMove::backward, 3, 0.01, 5).position == -on);
}

TEST_CASE(
    "walk: a turn keeps the angle to the axis, and a hundred steps turn by the field of view") {
    View view;
    view.direction = {0, 1, -0.5};
    view.horizontal = 60;
    const View turned = walked_view(view, WalkMove::turn, 100, 0.01, 5);
    CHECK(turned.direction.z == doctest::Approx(-0.5));
    CHECK(turned.direction.x == doctest::Approx(std::sin(kPi / 3)));  // to the right
    CHECK(turned.direction.y == doctest::Approx(std::cos(kPi / 3)));
    CHECK(turned_view(view, 360).direction.y == doctest::Approx(1));
}
