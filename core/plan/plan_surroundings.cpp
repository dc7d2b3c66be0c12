#include "core/plan/plan_surroundings.h"

#include <cmath>
#include <utility>

namespace lightwalk {
namespace {

constexpr double kSquare = 0.4;  // side [eye heights]
constexpr int kHalf = static_cast<int>(PlanSurroundings::kReach / kSquare) + 2;
constexpr int kSide = 2 * kHalf;  // of the grid, with a border that stays empty [squares]

void extend(Bounds& bounds, const Bounds& by) {
    if (by.empty()) return;
    bounds.extend(by.lower);
    bounds.extend(by.upper);
}

}  // namespace

PlanSurroundings::PlanSurroundings(const Vec3& eye, double eye_height)
    : eye_(eye), side_(kSquare * eye_height), squares_(std::size_t{kSide} * kSide) {}

void PlanSurroundings::add(const Vec3& place, bool nearest) {
    const double x = std::floor((place.x - eye_.x) / side_) + kHalf;
    const double y = std::floor((place.y - eye_.y) / side_) + kHalf;
    if (!(x >= 1 && y >= 1 && x < kSide - 1 && y < kSide - 1)) return;
    Square& square = squares_[static_cast<std::size_t>(y) * kSide + static_cast<std::size_t>(x)];
    square.bounds.extend(place);
    square.nearest += nearest ? 1 : 0;
}

/// What hangs together with a square that is in no group yet.
PlanSurroundings::Group PlanSurroundings::group_of(std::size_t first) {
    Group group;
    std::vector<std::size_t> open{first};
    squares_[first].grouped = true;
    while (!open.empty()) {
        const std::size_t at = open.back();
        open.pop_back();
        extend(group.bounds, squares_[at].bounds);
        group.nearest += squares_[at].nearest;
        for (const std::size_t row : {at - kSide, at, at + kSide}) {
            for (const std::size_t beside : {row - 1, row, row + 1}) {
                if (squares_[beside].bounds.empty()) continue;
                if (!std::exchange(squares_[beside].grouped, true)) open.push_back(beside);
            }
        }
    }
    return group;
}

Bounds PlanSurroundings::part(double nearest) {
    Bounds some, all;
    for (std::size_t i = 0; i < squares_.size(); ++i) {
        if (squares_[i].grouped || squares_[i].bounds.empty()) continue;
        const Group group = group_of(i);
        extend(all, group.bounds);
        if (group.nearest >= nearest) extend(some, group.bounds);
    }
    return some.empty() ? all : some;
}

}  // namespace lightwalk
