#include "parallel/walk/views_around.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "core/math/vec3.h"

using namespace lightwalk;

namespace {

View looking_north() {
    View view;
    view.position = {1, 2, 1.5};
    view.direction = {0, 1, -0.1};
    view.horizontal = 62;
    view.vertical = 48;
    return view;
}

/// Of a view to the right of north [degrees].
double bearing(const View& view) {
    return std::atan2(view.direction.x, view.direction.y) * (180 / kPi);
}

/// The views of a round, where each is all known once it is drawn.
std::vector<ViewAside> round_of(ViewsAround& around, bool done) {
    std::vector<ViewAside> views;
    while (const std::optional<ViewAside> aside = around.next(1, done)) {
        if (!views.empty() && aside->share != views.back().share) break;
        views.push_back(*aside);
        around.record(0, 0.01);
    }
    return views;
}

}  // namespace

TEST_CASE("views around one that rests hold all directions that an eye can turn to") {
    const View home = looking_north();
    ViewsAround around(home);
    const std::vector<ViewAside> views = round_of(around, false);
    for (double to = -180; to < 180; to += 1) {
        bool seen = std::abs(to) < home.horizontal / 2;
        for (const ViewAside& aside : views) {
            CHECK(aside.view.position == home.position);
            CHECK(aside.view.direction.z == doctest::Approx(home.direction.z));
            const double off = std::remainder(bearing(aside.view) - to, 360);
            seen = seen || std::abs(off) < home.horizontal / 2;
        }
        CHECK(seen);
    }
    REQUIRE(views.size() >= 2);
    CHECK(bearing(views[0].view) == doctest::Approx(-bearing(views[1].view)));
    CHECK(std::abs(bearing(views[0].view)) < home.horizontal);
}

TEST_CASE("views around come twice: roughly at once, and better when the picture is all there") {
    ViewsAround around(looking_north());
    CHECK_FALSE(around.next(0.01, false));
    REQUIRE(around.next(0.2, false));
    const std::vector<ViewAside> rough = round_of(around, false);
    CHECK_FALSE(around.next(1, false));
    const std::vector<ViewAside> better = round_of(around, true);
    CHECK(better.size() == rough.size());
    CHECK(better[0].share > rough[0].share);
    CHECK_FALSE(around.next(1, true));
}

TEST_CASE("a view aside is drawn until it is known, but not for ever") {
    ViewsAround around(looking_north());
    const double first = bearing(around.next(1, false)->view);
    around.record(0.5, 0.1);
    CHECK(bearing(around.next(1, false)->view) == first);
    around.record(0.001, 0.1);
    CHECK(bearing(around.next(1, false)->view) != first);
    double seconds = 0;
    while (around.next(1, true)) {
        around.record(1, 0.1);
        seconds += 0.1;
        REQUIRE(seconds < 60);
    }
}

TEST_CASE("what was seen around a place is known of all views from there that are as high") {
    const ViewsAround around(looking_north());
    View view = looking_north();
    view.direction = {-1, 0.2, -0.15};
    CHECK(around.hold(view));
    view.direction = {-1, 0.2, 0.9};
    CHECK_FALSE(around.hold(view));
    view = looking_north();
    view.position.x += 0.01;
    CHECK_FALSE(around.hold(view));
    view = looking_north();
    view.horizontal = 90;
    CHECK_FALSE(around.hold(view));
    CHECK_FALSE(ViewsAround().hold(looking_north()));
}

TEST_CASE("of a view as narrow as a needle's eye only what lies beside it is looked at") {
    for (const double horizontal : {5.0, 1e-9, 1e-300}) {
        View view = looking_north();
        view.horizontal = horizontal;
        ViewsAround around(view);
        const std::vector<ViewAside> views = round_of(around, false);
        CHECK(views.size() >= 2);
        CHECK(views.size() < 20);
    }
}

TEST_CASE("of views whose points do not outlive a turn none are drawn aside") {
    View view = looking_north();
    view.type = 'h';
    CHECK_FALSE(ViewsAround(view).next(1, true));
}
