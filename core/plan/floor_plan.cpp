#include "core/plan/floor_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace lightwalk {
namespace {

// Lengths are in eye heights.
constexpr double kSame = 0.25;   // difference of heights at which a section is the same
constexpr double kUnder = 0.01;  // the section lies a little lower than the eye, not just where
                                 // sills and rails at eye level end
constexpr double kAlone = 12;    // how far it goes where nothing is cut
constexpr double kMargin = 1;    // around what it shows
constexpr double kFinest = 1.0 / 40;     // least side of a cell
constexpr double kThickest = 0.45;       // of walls between faces that face away from each other
constexpr double kThickestAnyhow = 0.2;  // where faces do not tell which side is inside
constexpr double kJump = 0.04;           // of heights that gets a line: less than a step of a stair
constexpr double kDepthUnit = 0.01;
constexpr double kSteepest = 4;  // slopes beyond it count as this [1]

constexpr int kDirections = 1024, kDirectionsAtOnce = 512;  // in which the eye looks around
constexpr double kLeastShare = 0.05;  // of them, in which what belongs to the plan is the nearest
constexpr double kApart = 0.125;      // least distance of crossings [cells]
constexpr double kOffBorder = 0.37;  // walls that the extent begins at lie between borders of cells
constexpr std::size_t kRowsAtOnce = 128;

float slope(double normal, double upward) {
    const double least = std::copysign(std::max(std::abs(upward), kEpsilon), upward);
    return static_cast<float>(std::clamp(-normal / least, -kSteepest, kSteepest));
}

}  // namespace

bool PlanSurvey::shows(const Vec3& eye) const {
    if (!(eye_height_ > 0)) return false;
    if (std::abs(eye.z - eye_.z) > kSame * eye_height_) return false;
    if (stage_ == Stage::extent) return length(eye - eye_) <= kMargin * eye_height_;
    const double x = (eye.x - plan_.left) / plan_.cell, y = (eye.y - plan_.bottom) / plan_.cell;
    return x >= 0 && x <= plan_.width && y >= 0 && y <= plan_.height;
}

void PlanSurvey::aim(const Vec3& eye, double eye_height) {
    if (shows(eye) && eye_height == eye_height_) return;
    plan_ = {};
    below_.clear();
    rows_done_ = 0;
    eye_ = eye;
    eye_height_ = eye_height;
    plan_.z = eye.z - kUnder * eye_height;
    const bool sound = eye_height > 0 && std::isfinite(eye_height) && !sight_.bounds().empty();
    stage_ = sound ? Stage::extent : Stage::done;
    directions_done_ = 0;
    surroundings_.reset();
    if (sound) surroundings_.emplace(eye, eye_height);
}

/// What lies in some of the directions from the eye. True: in all.
bool PlanSurvey::look_around() {
    const Vec3 from{eye_.x, eye_.y, plan_.z};
    const double reach = PlanSurroundings::kReach * eye_height_;
    for (const int end = directions_done_ + kDirectionsAtOnce; directions_done_ < end;) {
        const double angle = 2 * kPi * (directions_done_++ + 0.5) / kDirections;
        const Vec3 along{std::cos(angle), std::sin(angle), 0};
        bool nearest = true;
        sight_.follow(from, along, reach, kFinest * eye_height_, [&](const PlanCrossing& crossing) {
            surroundings_->add(from + crossing.t * along, std::exchange(nearest, false));
        });
    }
    return directions_done_ == kDirections;
}

/// The plan's rectangle, and the size of its cells.
void PlanSurvey::set_extent() {
    Bounds part = surroundings_->part(kLeastShare * kDirections);
    const bool alone = part.empty();
    part.extend(eye_);
    const double margin = (alone ? kAlone : kMargin) * eye_height_;
    const Bounds all = sight_.bounds();
    const auto side = [&](double Vec3::*axis) {
        const double low = std::max(part.lower.*axis - margin, all.lower.*axis - margin / 2);
        const double high = std::min(part.upper.*axis + margin, all.upper.*axis + margin / 2);
        return std::pair(low, high);
    };
    const auto [left, right] = side(&Vec3::x);
    const auto [bottom, top] = side(&Vec3::y);
    const double width = right - left, height = top - bottom;
    if (!(width > 0 && height > 0)) return;
    plan_.cell = std::max(std::max(width, height) / (kMostPlanCells - 1), kFinest * eye_height_);
    const auto cells = [&](double length) {
        return std::min(static_cast<int>(std::ceil(length / plan_.cell)) + 1, kMostPlanCells);
    };
    plan_.width = cells(width);
    plan_.height = cells(height);
    plan_.left = left - kOffBorder * plan_.cell;
    plan_.bottom = bottom - kOffBorder * plan_.cell;
    const std::size_t count = place(0, plan_.height);
    plan_.cells.assign(count, kPlanEmpty);
    below_.assign(count, {});
}

void PlanSurvey::look_down(int row) {
    const auto width = static_cast<std::size_t>(plan_.width);
    std::vector<Vec3> places(width);
    std::vector<Hit> hits(width);
    for (int i = 0; i < plan_.width; ++i)
        places[static_cast<std::size_t>(i)] = {x_of(i), y_of(row), plan_.z};
    sight_.look_down(places, hits);
    for (int i = 0; i < plan_.width; ++i) {
        const Hit& hit = hits[static_cast<std::size_t>(i)];
        if (!hit.exists()) continue;
        below_[place(i, row)] = {static_cast<float>(hit.t / eye_height_),
                                 slope(hit.normal.x, hit.normal.z),
                                 slope(hit.normal.y, hit.normal.z)};
    }
}

/// Marks what lies between two places of a row or a column [cells].
void PlanSurvey::mark(bool along_x, int line, double from, double to, PlanLook look) {
    const std::uint8_t value = look == PlanLook::pane ? kPlanPane : kPlanWall;
    const int size = along_x ? plan_.width : plan_.height;
    const int first = std::clamp(static_cast<int>(std::floor(from)), 0, size - 1);
    const int last = std::clamp(static_cast<int>(std::floor(to)), first, size - 1);
    for (int k = first; k <= last; ++k) {
        std::uint8_t& cell = plan_.cells[along_x ? place(k, line) : place(line, k)];
        cell = std::max(cell, value);
    }
}

/// Marks what a row or a column crosses, and what is solid between.
void PlanSurvey::cut(bool along_x, int line) {
    const double top = plan_.bottom + plan_.height * plan_.cell;
    const Vec3 from =
        along_x ? Vec3{plan_.left, y_of(line), plan_.z} : Vec3{x_of(line), top, plan_.z};
    const Vec3 along = along_x ? Vec3{1, 0, 0} : Vec3{0, -1, 0};
    const double length = (along_x ? plan_.width : plan_.height) * plan_.cell;
    std::optional<PlanCrossing> last;
    sight_.follow(from, along, length, kApart * plan_.cell, [&](const PlanCrossing& crossing) {
        const double at = crossing.t / plan_.cell;
        mark(along_x, line, at, at, crossing.look);
        if (last && last->look == crossing.look) {
            const double thick = crossing.t - last->t;
            const bool solid = last->inward && !crossing.inward;
            const bool unclear = last->inward == crossing.inward;
            if ((solid && thick <= kThickest * eye_height_) ||
                (unclear && thick <= kThickestAnyhow * eye_height_))
                mark(along_x, line, last->t / plan_.cell, at, crossing.look);
        }
        last = crossing;
    });
}

/// Whether there is a jump from one cell to the next: not where the slope of either leads to the
/// other.
/// @param rise_a, rise_b  slopes toward the next cell
bool PlanSurvey::is_edge(const Below& a, const Below& b, double rise_a, double rise_b) const {
    if (std::isinf(a.depth) || std::isinf(b.depth)) return a.depth != b.depth;
    const double way = plan_.cell / eye_height_;
    const double rise = static_cast<double>(a.depth) - static_cast<double>(b.depth);
    return std::min(std::abs(rise - rise_a * way), std::abs(rise - rise_b * way)) > kJump;
}

/// What a row shows where nothing is cut. Of two cells with a jump between them the upper one is an
/// edge.
void PlanSurvey::find_edges(int row) {
    constexpr std::array<std::pair<int, int>, 4> kSides{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
    for (int i = 0; i < plan_.width; ++i) {
        std::uint8_t& cell = plan_.cells[place(i, row)];
        const Below& own = below_[place(i, row)];
        if (cell != kPlanEmpty || std::isinf(own.depth)) continue;
        const double depth = static_cast<double>(own.depth) / kDepthUnit;
        cell = static_cast<std::uint8_t>(std::clamp(depth, 1.0, double{kPlanDeepest}));
        for (const auto& [right, down] : kSides) {
            const int x = i + right, y = row + down;
            if (x < 0 || y < 0 || x == plan_.width || y == plan_.height) continue;
            const Below& other = below_[place(x, y)];
            const auto toward = [&, r = right, d = down](const Below& b) {
                return static_cast<double>(b.slope_x) * r - static_cast<double>(b.slope_y) * d;
            };
            if (own.depth < other.depth && is_edge(own, other, toward(own), toward(other)))
                cell = kPlanEdge;
        }
    }
}

bool PlanSurvey::step(const TaskRunner& task_runner) {
    const auto height = static_cast<std::size_t>(plan_.height);
    const auto width = static_cast<std::size_t>(plan_.width);
    if (stage_ == Stage::extent) {
        if (!look_around()) return false;
        set_extent();
        surroundings_.reset();
        stage_ = plan_.width > 0 ? Stage::below : Stage::done;
    } else if (stage_ == Stage::below) {
        const auto first = static_cast<std::size_t>(rows_done_);
        const std::size_t count = std::min(kRowsAtOnce, height - first);
        task_runner.run(count, [&](std::size_t k) { look_down(static_cast<int>(first + k)); });
        rows_done_ += static_cast<int>(count);
        if (rows_done_ == plan_.height) stage_ = Stage::cut;
    } else if (stage_ == Stage::cut) {
        task_runner.run(height, [&](std::size_t k) { cut(true, static_cast<int>(k)); });
        task_runner.run(width, [&](std::size_t k) { cut(false, static_cast<int>(k)); });
        task_runner.run(height, [&](std::size_t k) { find_edges(static_cast<int>(k)); });
        below_ = {};
        stage_ = Stage::done;
    }
    return stage_ == Stage::done;
}

}  // namespace lightwalk
