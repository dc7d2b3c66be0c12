#include "core/plan/floor_plan.h"

#include <doctest/doctest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "tests/backward_task_runner.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

constexpr double kHeight = 1.6;

/// Writes polygons whose lengths are all in one unit.
class Builder {
  public:
    explicit Builder(double unit = 1) : unit_(unit) {}
    Builder& polygon(const std::vector<Vec3>& corners, const std::string& material = "grey") {
        std::ostringstream line;
        line.precision(17);
        line << material << " polygon p" << ++count_ << " 0 0 " << 3 * corners.size();
        for (const Vec3& p : corners)
            line << ' ' << p.x * unit_ << ' ' << p.y * unit_ << ' ' << p.z * unit_;
        text_ += line.str() + '\n';
        return *this;
    }
    Builder& level(double x0, double y0, double x1, double y1, double z) {
        return polygon({{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}});
    }
    /// An upright rectangle, without thickness.
    Builder& wall(double x0, double y0, double x1, double y1, const std::string& material = "grey",
                  double low = 0, double high = 3) {
        return polygon({{x0, y0, low}, {x1, y1, low}, {x1, y1, high}, {x0, y0, high}}, material);
    }
    /// A box whose normals point outward.
    Builder& box(double x0, double y0, double x1, double y1, double low, double high) {
        wall(x0, y0, x1, y0, "grey", low, high).wall(x1, y0, x1, y1, "grey", low, high);
        wall(x1, y1, x0, y1, "grey", low, high).wall(x0, y1, x0, y0, "grey", low, high);
        return level(x0, y0, x1, y1, high);
    }
    Builder& room(double half_x, double half_y) {
        wall(half_x, -half_y, -half_x, -half_y).wall(-half_x, half_y, half_x, half_y);
        wall(-half_x, -half_y, -half_x, half_y).wall(half_x, half_y, half_x, -half_y);
        return level(-half_x, -half_y, half_x, half_y, 0);
    }
    [[nodiscard]] const std::string& text() const { return text_; }

  private:
    double unit_;
    int count_ = 0;
    std::string text_ =
        "void plastic grey 0 0 5 .5 .5 .5 0 0\nvoid glass clear 0 0 3 .9 .9 .9\n"
        "void illum shine 0 0 3 1 1 1\n";
};

FloorPlan finished(PlanSurvey& survey, const TaskRunner& task_runner = SerialTaskRunner()) {
    int steps = 1;
    while (!survey.step(task_runner)) ++steps;
    CHECK(steps <= 3 + kMostPlanCells / 128);
    return survey.plan();
}

FloorPlan plan_of(const std::string& text, const Vec3& eye = {0, 0, kHeight},
                  double height = kHeight, const TaskRunner& task_runner = SerialTaskRunner()) {
    const TestScene scene(text);
    PlanSurvey survey(scene.scene, true);
    survey.aim(eye, height);
    return finished(survey, task_runner);
}

struct Cell {
    int column, row;
};
Cell cell_at(const FloorPlan& plan, double x, double y) {
    return {static_cast<int>(std::floor((x - plan.left) / plan.cell)),
            plan.height - 1 - static_cast<int>(std::floor((y - plan.bottom) / plan.cell))};
}

int value(const FloorPlan& plan, Cell at) {
    REQUIRE(at.column >= 0);
    REQUIRE(at.column < plan.width);
    REQUIRE(at.row >= 0);
    REQUIRE(at.row < plan.height);
    return plan.cells[static_cast<std::size_t>(at.row * plan.width + at.column)];
}
int value(const FloorPlan& plan, double x, double y) {
    return value(plan, cell_at(plan, x, y));
}

/// Whether one gets from the eye to the plan's border without stepping through what is cut.
bool leads_out(const FloorPlan& plan, const Vec3& eye) {
    std::vector<Cell> reached{cell_at(plan, eye.x, eye.y)};
    std::vector<bool> seen(plan.cells.size(), false);
    while (!reached.empty()) {
        const Cell at = reached.back();
        reached.pop_back();
        if (at.column < 0 || at.row < 0 || at.column == plan.width || at.row == plan.height)
            return true;
        const auto place = static_cast<std::size_t>(at.row * plan.width + at.column);
        if (seen[place] || plan.cells[place] >= kPlanPane) continue;
        seen[place] = true;
        for (const Cell step : {Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}})
            reached.push_back({at.column + step.column, at.row + step.row});
    }
    return false;
}

}  // namespace

TEST_CASE("floor plan: a room's walls are a closed line where they stand") {
    const FloorPlan plan = plan_of(Builder().room(4, 3).text());
    CHECK_FALSE(leads_out(plan, {}));
    for (double x = -3.97; x < 3.95; x += plan.cell / 2)
        for (const double y : {-3.0, 3.0}) CHECK(value(plan, x, y) == kPlanWall);
    for (double y = -2.97; y < 2.95; y += plan.cell / 2)
        for (const double x : {-4.0, 4.0}) CHECK(value(plan, x, y) == kPlanWall);
    for (int row = 0; row < plan.height; ++row) {
        for (int column = 0; column < plan.width; ++column) {
            if (value(plan, {column, row}) != kPlanWall) continue;
            const double x = plan.left + (column + 0.5) * plan.cell;
            const double y = plan.bottom + (plan.height - row - 0.5) * plan.cell;
            const double beside = std::min(std::abs(std::abs(x) - 4), std::abs(std::abs(y) - 3));
            CHECK(beside <= 0.5001 * plan.cell);
        }
    }
    CHECK(value(plan, 1, 1) == 99);  // the section lies a hundredth lower than the eye
    CHECK(value(plan, 4.5, 0) == kPlanEmpty);
}

TEST_CASE("floor plan: walls that stand askew are closed, too") {
    Builder builder;
    const double c = std::cos(0.3), s = std::sin(0.3);
    const auto turned = [&](double x, double y) { return Vec3{c * x - s * y, s * x + c * y, 0}; };
    const std::vector<Vec3> corners{turned(-4, -3), turned(4, -3), turned(4, 3), turned(-4, 3)};
    for (std::size_t k = 0; k < 4; ++k)
        builder.wall(corners[k].x, corners[k].y, corners[(k + 1) % 4].x, corners[(k + 1) % 4].y);
    CHECK_FALSE(leads_out(plan_of(builder.text()), {}));
}

TEST_CASE("floor plan: a door is a gap in the wall, a window a pane") {
    Builder builder;
    builder.room(4, 3).wall(-4, 1, -0.5, 1).wall(0.5, 1, 4, 1).wall(-0.5, 1, 0.5, 1, "grey", 2.1);
    builder.wall(4, -1, 6, -1).wall(6, -1, 6, 1, "clear").wall(6, 1, 4, 1);
    const FloorPlan plan = plan_of(builder.text());
    CHECK(value(plan, -1, 1) == kPlanWall);
    CHECK(value(plan, 1, 1) == kPlanWall);
    CHECK(value(plan, 0, 1) == 99);
    CHECK(value(plan, 6, 0) == kPlanPane);
    const Builder open =
        Builder().wall(-4, -3, 4, -3).wall(-4, 3, 4, 3).wall(-4, -3, -4, 3).wall(4, 3, 4, 0.5);
    CHECK(leads_out(plan_of(open.text()), {}));
}

TEST_CASE("floor plan: thick walls are solid, rooms are not") {
    const Builder builder = Builder().room(2, 2).box(3, -2, 3.4, 2, 0, 3).box(4, -2, 7, 2, 0, 3);
    const FloorPlan plan = plan_of(builder.text());
    for (double x = 3.02; x < 3.4; x += plan.cell) CHECK(value(plan, x, 0) == kPlanWall);
    CHECK(value(plan, 2.5, 0) != kPlanWall);
    CHECK(value(plan, 5.5, 0) != kPlanWall);
}

TEST_CASE("floor plan: a table shows its height and its outline, a ramp no lines") {
    Builder builder = Builder().room(4, 3).box(1, 1, 2.2, 1.8, 0, 0.75);
    builder.polygon({{-3, -2, 0}, {-1, -2, 0.8}, {-1, -1, 0.8}, {-3, -1, 0}});
    const FloorPlan plan = plan_of(builder.text());
    CHECK(value(plan, 1.5, 1.4) == 52);  // (1.6 · 0.99 - 0.75) / 1.6
    CHECK(value(plan, 1.6, 1.0 + 0.5 * plan.cell) >= 52);
    int edges = 0;
    for (double x = 0.5; x < 2.7; x += plan.cell) edges += value(plan, x, 1.4) == kPlanEdge;
    CHECK(edges == 2);
    for (double x = -2.9; x < -1.1; x += plan.cell) CHECK(value(plan, x, -1.5) < kPlanDeepest);
    CHECK(value(plan, 0.5, 1.4) == 99);
}

TEST_CASE("floor plan: surfaces that the eye does not see are not drawn") {
    Builder builder = Builder().room(4, 3);
    builder.wall(-2, -3, -2, 3, "void").wall(2, -3, 2, 3, "shine");
    const FloorPlan plan = plan_of(builder.text());
    CHECK(value(plan, -2, 0) == 99);
    CHECK(value(plan, 2, 0) == 99);
}

TEST_CASE("floor plan: the scene's unit does not matter, nor who does the work") {
    const auto furnished = [](double unit) {
        return Builder(unit).room(4.03, 3.07).box(1, 1, 2.2, 1.8, 0, 0.75).box(-3, 0, -2, 3, 0, 3);
    };
    const FloorPlan plan = plan_of(furnished(1).text());
    for (const double unit : {0.001, 1000.0}) {
        const double height = kHeight * unit;
        const FloorPlan other = plan_of(furnished(unit).text(), {0, 0, height}, height);
        CHECK(other.cells == plan.cells);
        CHECK(other.cell == doctest::Approx(plan.cell * unit));
        CHECK(other.left == doctest::Approx(plan.left * unit));
    }
    const FloorPlan backward =
        plan_of(furnished(1).text(), {0, 0, kHeight}, kHeight, BackwardTaskRunner());
    CHECK(backward.cells == plan.cells);
}

TEST_CASE("floor plan: where there is nothing, there is no plan") {
    CHECK(plan_of("").width == 0);
    const std::string text = Builder().room(4, 3).text();
    CHECK(plan_of(text, {0, 0, kHeight}, 0).width == 0);
    CHECK(plan_of(text, {0, 0, kHeight}, HUGE_VAL).width == 0);
    CHECK(plan_of(text, {1e9, 0, kHeight}).width == 0);
}

TEST_CASE("floor plan: of a house in a landscape it shows the house") {
    const double far = 1e5;
    Builder ground;
    ground.level(-far, -far, far, far, -0.1);
    const FloorPlan empty = plan_of(ground.text());
    CHECK(empty.width * empty.cell == doctest::Approx(24 * kHeight).epsilon(0.01));
    Builder house = ground;
    house.room(5, 4).wall(-50, 60, 50, 60, "grey", -1, 40).wall(900, -900, 900, 900);
    const FloorPlan plan = plan_of(house.text(), {1, 1, kHeight});
    CHECK(plan.width * plan.cell > 10);
    CHECK(plan.width * plan.cell < 16);
    CHECK_FALSE(leads_out(plan, {1, 1, 0}));
    const FloorPlan garden = plan_of(house.text(), {12, 1, kHeight - 0.1});
    CHECK(value(garden, -5, 0) == kPlanWall);
}

TEST_CASE("floor plan: it is finished while the eye walks on") {
    const TestScene scene(Builder().room(4, 3).text());
    PlanSurvey survey(scene.scene, true);
    for (int k = 0; k < 20; ++k) {
        survey.aim({0.1 * k, 0, kHeight}, kHeight);
        if (survey.step(SerialTaskRunner())) break;
    }
    CHECK(survey.plan().cells == plan_of(Builder().room(4, 3).text()).cells);
}

TEST_CASE("floor plan: it is kept within a storey") {
    Builder builder = Builder().room(4, 3).box(1, 1, 2.2, 1.8, 0, 0.75);
    builder.level(-4, -3, 4, 0, 3).wall(-4, 0, 4, 0, "grey", 3, 5);
    const TestScene scene(builder.text());
    PlanSurvey survey(scene.scene, true);
    survey.aim({0, -1, 1.6}, kHeight);
    const FloorPlan lower = finished(survey);
    survey.aim({2, -2, 1.8}, kHeight);
    CHECK(survey.step(SerialTaskRunner()));
    CHECK(survey.plan().z == lower.z);
    survey.aim({0, -1, 4.6}, kHeight);
    CHECK_FALSE(survey.step(SerialTaskRunner()));
    const FloorPlan upper = finished(survey);
    CHECK(upper.z == doctest::Approx(4.6 - 0.016));
    CHECK(value(upper, 0, -2) == 99);
    CHECK(value(upper, 3, 1) == kPlanDeepest);
    CHECK(value(upper, 2, 0) == kPlanWall);
}
