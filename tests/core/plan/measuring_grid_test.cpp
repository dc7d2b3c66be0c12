#include "core/plan/measuring_grid.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

#include "tests/backward_task_runner.h"
#include "tests/test_scene.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

constexpr double kMeasuringHeight = 1.6;  // of the eye [m]

/// Polygons in a unit, turned about the z axis.
class PlaneRoom {
  public:
    explicit PlaneRoom(double unit = 1, double turned = 0) : unit_(unit), turned_(turned) {}
    [[nodiscard]] Vec3 at(double x, double y, double z) const {
        const double c = std::cos(turned_), s = std::sin(turned_);
        return unit_ * Vec3{c * x - s * y, s * x + c * y, z};
    }
    PlaneRoom& polygon(const std::vector<Vec3>& corners, const std::string& material = "grey") {
        std::ostringstream line;
        line.precision(17);
        line << material << " polygon p" << ++count_ << " 0 0 " << 3 * corners.size();
        for (const Vec3& p : corners) line << ' ' << p.x << ' ' << p.y << ' ' << p.z;
        text_ += line.str() + '\n';
        return *this;
    }
    PlaneRoom& level(double x0, double y0, double x1, double y1, double z) {
        return polygon({at(x0, y0, z), at(x1, y0, z), at(x1, y1, z), at(x0, y1, z)});
    }
    PlaneRoom& wall(double x0, double y0, double x1, double y1, double low = 0, double high = 3,
                    const std::string& material = "grey") {
        return polygon({at(x0, y0, low), at(x1, y1, low), at(x1, y1, high), at(x0, y0, high)},
                       material);
    }
    PlaneRoom& box(double x0, double y0, double x1, double y1, double low, double high) {
        wall(x0, y0, x1, y0, low, high).wall(x1, y0, x1, y1, low, high);
        wall(x1, y1, x0, y1, low, high).wall(x0, y1, x0, y0, low, high);
        return level(x0, y0, x1, y1, low).level(x0, y0, x1, y1, high);
    }
    /// 8 by 12 by 3.
    PlaneRoom& room() { return box(-4, -6, 4, 6, 0, 3); }

    [[nodiscard]] MeasuringGrid above_floor(double height, Vec3 eye = {0, 0, kMeasuringHeight},
                                            const TaskRunner& runner = SerialTaskRunner()) const {
        return found(false, at(eye.x, eye.y, eye.z), {}, unit_ * height, runner);
    }
    [[nodiscard]] MeasuringGrid on_surface(const Vec3& position, const Vec3& normal) const {
        return found(true, at(position.x, position.y, position.z), normal, 0, SerialTaskRunner());
    }

  private:
    [[nodiscard]] MeasuringGrid found(bool surface, const Vec3& place, const Vec3& normal,
                                      double height, const TaskRunner& runner) const {
        const TestScene scene(text_);
        const PlanSight sight(scene.scene, true);
        const double unit = unit_ * kMeasuringHeight;
        MeasuringSurvey survey = surface ? MeasuringSurvey::on_surface(sight, unit, place, normal)
                                         : MeasuringSurvey::above_floor(sight, unit, place, height);
        int steps = 1;
        while (!survey.step(runner)) ++steps;
        CHECK(steps <= 7);
        return survey.grid();
    }

    double unit_, turned_;
    int count_ = 0;
    std::string text_ =
        "void plastic grey 0 0 5 .5 .5 .5 0 0\nvoid glass clear 0 0 3 .9 .9 .9\n"
        "void illum shine 0 0 3 1 1 1\n";
};

int counting(const MeasuringGrid& grid) {
    return std::accumulate(grid.counts.begin(), grid.counts.end(), 0);
}

bool is_near(const Vec3& a, const Vec3& b, double apart) {
    return length(a - b) <= apart;
}

/// Whether all points that count are of a set, and all others are not but for those within `edge`
/// of its border.
template <class Inside>
void check_points(const MeasuringGrid& grid, double edge, Inside inside) {
    int wrong = 0;
    for (int y = 0; y < grid.rows; ++y)
        for (int x = 0; x < grid.columns; ++x) {
            const Vec3 p = grid.point(x, y);
            const bool counts = grid.counts_at(x, y);
            if (counts ? !inside(p, -edge) : inside(p, edge)) ++wrong;
        }
    CHECK(wrong == 0);
}

/// Whether a place is deeper than `edge` within a rectangle.
bool inside_of(const Vec3& p, double x0, double y0, double x1, double y1, double edge) {
    return p.x > x0 + edge && p.x < x1 - edge && p.y > y0 + edge && p.y < y1 - edge;
}

}  // namespace

TEST_CASE("measuring grid: a level plane of a room goes from wall to wall, at its height") {
    const MeasuringGrid grid = PlaneRoom().room().above_floor(0.75);
    REQUIRE(grid.columns == 32);
    REQUIRE(grid.rows == 48);
    CHECK(counting(grid) == 32 * 48);
    CHECK(is_near(grid.point(0, 0), {-3.875, -5.875, 0.75}, 1e-9));
    CHECK(is_near(grid.point(31, 47), {3.875, 5.875, 0.75}, 1e-9));
    CHECK(grid.normal == Vec3{0, 0, 1});
    CHECK(is_near(normalize(cross(grid.across, grid.along)), grid.normal, kRounding));
}

TEST_CASE("measuring grid: its sides follow the walls, however they are turned") {
    for (const double turned : {0.3, -0.7, 2.0}) {
        CAPTURE(turned);
        const MeasuringGrid grid = PlaneRoom(1, turned).room().above_floor(0.75, {1, 2, 1.6});
        CHECK(std::max(grid.columns, grid.rows) == 48);
        CHECK(std::min(grid.columns, grid.rows) == 32);
        CHECK(counting(grid) == 32 * 48);
        CHECK(std::abs(length(grid.across) - 0.25) < 1e-6);
    }
}

TEST_CASE("measuring grid: it is the same in every unit, and whoever does what first") {
    const auto furnished = [](double unit) {
        PlaneRoom room(unit);
        room.room().box(1, 1, 2.5, 2.25, 0, 2).box(-3, -3, -1, -2, 0, 0.7);
        return room;
    };
    const MeasuringGrid grid = furnished(1).above_floor(0.8);
    const MeasuringGrid large = furnished(1000).above_floor(0.8);
    CHECK(large.counts == grid.counts);
    CHECK(is_near(large.origin / 1000, grid.origin, 1e-9));
    CHECK(furnished(1).above_floor(0.8, {0, 0, 1.6}, BackwardTaskRunner()).counts == grid.counts);
}

TEST_CASE("measuring grid: what stands as high as the plane does not count, lower things do") {
    PlaneRoom room;
    room.room().box(1.01, 1.01, 2.51, 2.26, 0, 2).box(-3, -3, -1, -2, 0, 0.7);
    const MeasuringGrid grid = room.above_floor(0.75);
    check_points(grid, 0.001, [](const Vec3& p, double edge) {
        return inside_of(p, -4, -6, 4, 6, 0) && !inside_of(p, 1.01, 1.01, 2.51, 2.26, -edge);
    });
    CHECK(counting(grid) == 32 * 48 - 6 * 5);
}

TEST_CASE("measuring grid: walls and panes enclose a room, what is invisible does not") {
    for (const char* material : {"grey", "clear", "shine"}) {
        CAPTURE(material);
        PlaneRoom room;
        room.room().wall(-4, 2, 4, 2, 0, 3, material);
        const MeasuringGrid grid = room.above_floor(0.75);
        const bool whole = material == std::string("shine");
        CHECK(length(grid.along) * grid.rows == doctest::Approx(whole ? 12 : 8).epsilon(1e-6));
        CHECK(counting(grid) == grid.columns * grid.rows);
    }
}

TEST_CASE("measuring grid: what lies behind screens is of the room, what lies outside is not") {
    PlaneRoom room;
    room.room().wall(-1, 2, 1.5, 2).wall(1, -3, 1, -5);  // screens
    const MeasuringGrid grid = room.above_floor(0.75);
    CHECK(length(grid.along) * grid.rows == doctest::Approx(12).epsilon(1e-6));
    CHECK(counting(grid) == grid.columns * grid.rows);
    PlaneRoom terrace;  // a floor without walls
    terrace.level(-1, -2, 3, 2, 0);
    const MeasuringGrid open = terrace.above_floor(0.75, {0, 0, 1.6});
    CHECK(counting(open) > 0.9 * open.columns * open.rows);
    check_points(open, 0.001,
                 [](const Vec3& p, double edge) { return inside_of(p, -1, -2, 3, 2, edge); });
}

TEST_CASE("measuring grid: the floor is that of the room, also where the eye is above a desk") {
    PlaneRoom room;
    room.room().box(-0.8, -0.4, 0.8, 0.4, 0.7, 0.76);
    const MeasuringGrid grid = room.above_floor(0.75);
    CHECK(std::abs(grid.origin.z - 0.75) < 1e-9);
    check_points(grid, 0.001, [](const Vec3& p, double edge) {
        return inside_of(p, -4, -6, 4, 6, 0) && !inside_of(p, -0.8, -0.4, 0.8, 0.4, -edge);
    });
    // A top just at the plane's height is of the plane.
    PlaneRoom other;
    other.room().box(-0.8, -0.4, 0.8, 0.4, 0.7, 0.75);
    CHECK(counting(other.above_floor(0.75)) == 32 * 48);
}

TEST_CASE("measuring grid: of a surface that part counts which is free, and of the plane") {
    PlaneRoom room;
    room.room().box(-0.83, -0.41, 0.83, 0.41, 0.7, 0.75).box(0.2, 0, 0.4, 0.3, 0.75, 1);
    const MeasuringGrid top = room.on_surface({-0.5, 0.2, 0.75}, {0, 0, 1});
    CHECK(std::max(top.columns, top.rows) == 48);
    CHECK(length(top.across) < 0.05);
    check_points(top, 0.001, [](const Vec3& p, double edge) {
        return inside_of(p, -0.83, -0.41, 0.83, 0.41, edge) &&
               !inside_of(p, 0.2, 0, 0.4, 0.3, -edge);
    });
    CHECK(counting(top) > 0.8 * top.columns * top.rows);
    // The floor goes on below the table, but not into what stands on it.
    PlaneRoom hall;
    hall.room().box(1, 1, 2, 2, 0, 2).box(-2, -2, -1, -1, 0.5, 0.6);
    const MeasuringGrid floor = hall.on_surface({0, 0, 0}, {0, 0, 1});
    check_points(floor, 0.001, [](const Vec3& p, double edge) {
        return inside_of(p, -4, -6, 4, 6, 0) && !inside_of(p, 1, 1, 2, 2, -edge);
    });
}

TEST_CASE("measuring grid: on a wall one side is level, and light is measured before it") {
    PlaneRoom room;
    const MeasuringGrid grid = room.room().on_surface({1, 6, 1}, {0, -1, 0});
    CHECK(counting(grid) == grid.columns * grid.rows);
    CHECK(grid.columns == 48);
    CHECK(grid.rows == 18);
    CHECK(std::abs(grid.across.z) < kRounding);
    CHECK(grid.along.z > 0);
    CHECK(is_near(normalize(cross(grid.across, grid.along)), {0, -1, 0}, kRounding));
}

TEST_CASE("measuring grid: where there is no plane there is no grid") {
    PlaneRoom room;
    room.room();
    CHECK(room.above_floor(3.5).columns == 0);  // above the ceiling
    CHECK(room.above_floor(1e9).columns == 0);
    CHECK(room.above_floor(0.75, {0, 0, 1e8}).columns == 0);
    CHECK(room.above_floor(0.75, {0, 0, -5}).columns == 0);     // nothing is below
    CHECK(room.on_surface({0, 0, 1}, {0, 0, 1}).columns == 0);  // in mid air
    CHECK(room.on_surface({1e9, -1e9, 1e9}, {1, 0, 0}).columns == 0);
    const TestScene scene("void plastic grey 0 0 5 .5 .5 .5 0 0\n");
    const PlanSight sight(scene.scene, true);
    for (const double unit : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), HUGE_VAL, 1.6}) {
        MeasuringSurvey survey = MeasuringSurvey::above_floor(sight, unit, {0, 0, 1.6}, 0.75);
        while (!survey.step(SerialTaskRunner())) continue;
        CHECK(survey.grid().columns == 0);
    }
}
