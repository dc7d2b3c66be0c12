#include "core/plan/measuring_grid.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lightwalk {
namespace {

// Lengths are in eye heights, so that a scene whose unit is another one has the same grids.
constexpr double kMeasuringReach = 20;
constexpr double kSurfaceLift = 0.01;  // what is lower lies on a surface, what is higher stands on
constexpr double kLevelLift = 0.002;   // tops at the plane's height are of the plane
constexpr double kSunk = 5e-4;         // so deep below the plane a surface is still its own
// So high above it: sensors stand off by little more, and must not lie below the surface.
constexpr double kRaised = 5e-5;
constexpr double kBelowFloor = 0.25;  // so deep below the floor there is nothing to stand on
constexpr double kSameFloor = 0.02;   // difference of depths
constexpr double kFloorAround = 3;    // how far from the eye the floor is looked for
constexpr double kSmallestSide = 1e-3;
constexpr double kParallel = 0.99;  // cosine between normals of one plane
constexpr double kLevel = 0.999;    // of a plane's normal: its axes follow the walls
constexpr int kDirectionsAround = 256, kFloorDirections = 32;
constexpr int kSurveyPoints = 64;  // along the longer side while the extent is sought
constexpr int kMostRounds = 5;
constexpr double kShrinks = 0.9;  // a round that leaves more of both sides is the last
constexpr int kFewestPoints = 4;
constexpr Vec3 kDown{0, 0, -1};

Vec3 around_axes(const Vec3& x, const Vec3& y, int k, int directions) {
    const double angle = 2 * kPi * k / directions;
    return std::cos(angle) * x + std::sin(angle) * y;
}

/// A depth that most of the others are near to.
double most_frequent(const std::vector<double>& depths, double near) {
    double best = depths.front();
    std::ptrdiff_t most = 0;
    for (const double depth : depths) {
        const auto count = std::count_if(depths.begin(), depths.end(), [&](double other) {
            return std::abs(other - depth) <= near;
        });
        if (count <= most) continue;
        most = count;
        best = depth;
    }
    return best;
}

}  // namespace

MeasuringSurvey MeasuringSurvey::on_surface(const PlanSight& sight, double unit,
                                            const Vec3& position, const Vec3& normal) {
    MeasuringSurvey survey(sight, unit);
    survey.start_ = position;
    survey.normal_ = normal;
    survey.lift_ = kSurfaceLift * unit;
    return survey;
}

MeasuringSurvey MeasuringSurvey::above_floor(const PlanSight& sight, double unit, const Vec3& eye,
                                             double height) {
    MeasuringSurvey survey(sight, unit);
    survey.above_floor_ = true;
    survey.eye_ = eye;
    survey.height_ = height;
    survey.normal_ = -kDown;
    survey.lift_ = kLevelLift * unit;
    return survey;
}

bool MeasuringSurvey::step(const TaskRunner& task_runner) {
    if (stage_ == Stage::done) return true;
    if (stage_ == Stage::start) {
        stage_ = find_start() ? Stage::survey : Stage::done;
        return stage_ == Stage::done;
    }
    if (rounds_++ < kMostRounds) {
        const Box smaller = around(survey(box_, kSurveyPoints, task_runner));
        const bool shrinks = smaller.width() < kShrinks * box_.width() ||
                             smaller.height() < kShrinks * box_.height();
        box_ = smaller;
        if (!shrinks) rounds_ = kMostRounds;
        return false;
    }
    grid_ = survey(box_, kMostMeasuringPoints, task_runner);
    if (std::accumulate(grid_.counts.begin(), grid_.counts.end(), 0) < kFewestPoints) grid_ = {};
    stage_ = Stage::done;
    return true;
}

bool MeasuringSurvey::find_start() {
    if (!(unit_ > 0 && std::isfinite(unit_))) return false;
    if (above_floor_ && !stand_above_floor()) return false;
    x_axis_ = std::abs(normal_.z) > kLevel ? Vec3{1, 0, 0} : cross(-kDown, normal_);
    y_axis_ = normalize(cross(normal_, x_axis_));
    x_axis_ = cross(y_axis_, normal_);
    if (!belongs(start_)) return false;
    look_around();
    return std::min(box_.width(), box_.height()) > kSmallestSide * unit_;
}

/// Furniture may be below the eye, or the plane within it: then a place next to it is the start.
bool MeasuringSurvey::stand_above_floor() {
    std::vector<Vec3> places{eye_};
    for (const double share : {0.2, 0.4, 0.7}) {
        for (int k = 0; k < kFloorDirections; ++k) {
            const Vec3 along = around_axes({1, 0, 0}, {0, 1, 0}, k, kFloorDirections);
            const Hit wall = sight_.first(eye_, along, kFloorAround * unit_);
            const double far = wall.exists() ? wall.t : kFloorAround * unit_;
            places.push_back(eye_ + share * far * along);
        }
    }
    std::vector<double> depths;
    std::vector<Vec3> above;  // of these depths
    for (const Vec3& place : places) {
        const Hit below = sight_.first(place, kDown, kMeasuringReach * unit_);
        if (!below.exists()) continue;
        depths.push_back(below.t);
        above.push_back(place);
    }
    if (depths.empty()) return false;
    const double floor = most_frequent(depths, kSameFloor * unit_);
    for (std::size_t i = 0; i < above.size(); ++i) {
        if (std::abs(depths[i] - floor) > kSameFloor * unit_) continue;
        const double rise = height_ - floor;  // from the eye to the plane
        if (rise > 0 && sight_.first(above[i], -kDown, rise + lift_).exists()) continue;
        start_ = {above[i].x, above[i].y, above[i].z + rise};
        return true;
    }
    return false;
}

void MeasuringSurvey::look_around() {
    std::vector<Vec3> reached;
    std::vector<std::optional<Vec3>> walls;
    const Vec3 from = start_ + lift_ * normal_;
    for (int k = 0; k < kDirectionsAround; ++k) {
        const Vec3 along = around_axes(x_axis_, y_axis_, k, kDirectionsAround);
        const Hit wall = sight_.first(from, along, kMeasuringReach * unit_);
        reached.push_back((wall.exists() ? wall.t : kMeasuringReach * unit_) * along);
        walls.push_back(wall.exists() ? std::optional(wall.normal) : std::nullopt);
    }
    if (std::abs(normal_.z) > kLevel) turn_axes(reached, walls);
    box_ = {};
    for (const Vec3& place : reached) {
        box_.x0 = std::min(box_.x0, dot(place, x_axis_));
        box_.x1 = std::max(box_.x1, dot(place, x_axis_));
        box_.y0 = std::min(box_.y0, dot(place, y_axis_));
        box_.y1 = std::max(box_.y1, dot(place, y_axis_));
    }
}

/// The mean direction of walls, by length, where a right angle is a full turn: walls at right
/// angles to each other have the same one.
void MeasuringSurvey::turn_axes(const std::vector<Vec3>& reached,
                                const std::vector<std::optional<Vec3>>& walls) {
    constexpr double kMostOblique = 0.2;  // cosine
    constexpr double kFlat = 1e-3;        // difference of the normals of a wall
    double sine = 0, cosine = 0;
    for (std::size_t i = 0; i < walls.size(); ++i) {
        const std::optional<Vec3>& next = walls[(i + 1) % walls.size()];
        if (!walls[i] || !next || length(*walls[i] - *next) > kFlat) continue;
        const double x = dot(*walls[i], x_axis_), y = dot(*walls[i], y_axis_);
        if (std::hypot(x, y) < kParallel) continue;  // no upright wall
        const double far = length(reached[i]);
        const double facing = std::abs(dot(*walls[i], reached[i])) / far;
        const double size = far / std::max(facing, kMostOblique);
        const double angle = 4 * std::atan2(y, x);
        sine += size * std::sin(angle);
        cosine += size * std::cos(angle);
    }
    if (sine == 0 && cosine == 0) return;
    const double turn = std::atan2(sine, cosine) / 4;
    const Vec3 x = x_axis_, y = y_axis_;
    x_axis_ = std::cos(turn) * x + std::sin(turn) * y;
    y_axis_ = std::cos(turn) * y - std::sin(turn) * x;
}

bool MeasuringSurvey::belongs(const Vec3& point) const {
    const double deep = above_floor_ ? height_ + kBelowFloor * unit_ : kSunk * unit_;
    const Hit hit = sight_.first(point + lift_ * normal_, -normal_, lift_ + deep);
    if (!hit.exists() || hit.t < lift_ - kRaised * unit_) return false;
    return above_floor_ || std::abs(dot(hit.normal, normal_)) > kParallel;
}

bool MeasuringSurvey::is_clear(const Vec3& from, const Vec3& to) const {
    const Vec3 way = to - from;
    const double far = length(way);
    return far <= kEpsilon || !sight_.first(from + lift_ * normal_, way / far, far).exists();
}

MeasuringGrid MeasuringSurvey::survey(const Box& box, int most_points,
                                      const TaskRunner& task_runner) const {
    const double cell = std::max(box.width(), box.height()) / most_points;
    const auto points_along = [&](double side) {
        return std::clamp(static_cast<int>(std::lround(side / cell)), 2, most_points);
    };
    MeasuringGrid grid;
    const int columns = grid.columns = points_along(box.width());
    const int rows = grid.rows = points_along(box.height());
    grid.normal = normal_;
    grid.across = box.width() / columns * x_axis_;
    grid.along = box.height() / rows * y_axis_;
    grid.origin =
        start_ + box.x0 * x_axis_ + box.y0 * y_axis_ + 0.5 * grid.across + 0.5 * grid.along;
    const auto width = static_cast<std::size_t>(columns);
    grid.counts.resize(width * static_cast<std::size_t>(rows));
    task_runner.run(static_cast<std::size_t>(rows), [&](std::size_t row) {
        for (int x = 0; x < columns; ++x)
            grid.counts[row * width + static_cast<std::size_t>(x)] =
                belongs(grid.point(x, static_cast<int>(row))) ? 1 : 0;
    });
    // Whether the way from a point to the next of its row is clear, and to the next row.
    std::vector<std::array<bool, 2>> ways(grid.counts.size());
    task_runner.run(static_cast<std::size_t>(rows), [&](std::size_t task) {
        const int y = static_cast<int>(task);
        for (int x = 0; x < columns; ++x) {
            if (!grid.counts_at(x, y)) continue;
            const Vec3 here = grid.point(x, y);
            std::array<bool, 2>& way = ways[task * width + static_cast<std::size_t>(x)];
            if (x + 1 < columns && grid.counts_at(x + 1, y))
                way[0] = is_clear(here, grid.point(x + 1, y));
            if (y + 1 < rows && grid.counts_at(x, y + 1))
                way[1] = is_clear(here, grid.point(x, y + 1));
        }
    });
    fill_from_start(box, grid, ways);
    return grid;
}

/// Only what is reached counts.
void MeasuringSurvey::fill_from_start(const Box& box, MeasuringGrid& grid,
                                      const std::vector<std::array<bool, 2>>& ways) const {
    const int columns = grid.columns, rows = grid.rows;
    const auto at = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
               static_cast<std::size_t>(x);
    };
    std::vector<std::uint8_t> reached(grid.counts.size());
    std::vector<std::pair<int, int>> edge;
    const auto reach = [&](int x, int y) {
        if (reached[at(x, y)] != 0 || !grid.counts_at(x, y)) return;
        reached[at(x, y)] = 1;
        edge.emplace_back(x, y);
    };
    const int middle_x = static_cast<int>(-box.x0 / box.width() * columns);
    const int middle_y = static_cast<int>(-box.y0 / box.height() * rows);
    for (int y = std::max(middle_y - 1, 0); y <= std::min(middle_y + 1, rows - 1); ++y)
        for (int x = std::max(middle_x - 1, 0); x <= std::min(middle_x + 1, columns - 1); ++x)
            if (is_clear(start_, grid.point(x, y))) reach(x, y);
    while (!edge.empty()) {
        const auto [x, y] = edge.back();
        edge.pop_back();
        if (x + 1 < columns && ways[at(x, y)][0]) reach(x + 1, y);
        if (y + 1 < rows && ways[at(x, y)][1]) reach(x, y + 1);
        if (x > 0 && ways[at(x - 1, y)][0]) reach(x - 1, y);
        if (y > 0 && ways[at(x, y - 1)][1]) reach(x, y - 1);
    }
    grid.counts = std::move(reached);
}

/// A side whose outermost points do not count lies somewhere within the cells that come next.
MeasuringSurvey::Box MeasuringSurvey::around(const MeasuringGrid& grid) const {
    const double cell_x = box_.width() / grid.columns, cell_y = box_.height() / grid.rows;
    int x0 = static_cast<int>(-box_.x0 / cell_x), x1 = x0;
    int y0 = static_cast<int>(-box_.y0 / cell_y), y1 = y0;
    for (int y = 0; y < grid.rows; ++y)
        for (int x = 0; x < grid.columns; ++x) {
            if (!grid.counts_at(x, y)) continue;
            x0 = std::min(x0, x);
            x1 = std::max(x1, x);
            y0 = std::min(y0, y);
            y1 = std::max(y1, y);
        }
    // Half a cell more than the points' own halves: an edge is not farther.
    constexpr double kMore = 0.5;
    return {std::max(box_.x0, box_.x0 + (x0 - kMore) * cell_x),
            std::min(box_.x1, box_.x0 + (x1 + 1 + kMore) * cell_x),
            std::max(box_.y0, box_.y0 + (y0 - kMore) * cell_y),
            std::min(box_.y1, box_.y0 + (y1 + 1 + kMore) * cell_y)};
}

}  // namespace lightwalk
