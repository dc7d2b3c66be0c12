#include "core/glare/direction_groups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace lightwalk {
namespace {

/// A union-find structure; the name of a set is its smallest member.
class JoinedSets {
  public:
    explicit JoinedSets(std::size_t count) : parents_(count) {
        std::iota(parents_.begin(), parents_.end(), 0u);
    }
    std::uint32_t name_of(std::uint32_t member) {
        while (parents_[member] != member)
            member = parents_[member] = parents_[parents_[member]];  // path halving
        return member;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = name_of(a), b = name_of(b);
        parents_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<std::uint32_t> parents_;
};

using CellPlace = std::array<int, 3>;

/// The members whose directions end in one cell of a cubic grid.
struct GridCell {
    CellPlace place{};
    std::vector<std::uint32_t> members;
};

/// The occupied cells, in the order of their places.
std::vector<GridCell> grid_cells(std::span<const Vec3> directions, double side) {
    std::vector<std::pair<CellPlace, std::uint32_t>> placed;
    placed.reserve(directions.size());
    for (std::size_t i = 0; i < directions.size(); ++i) {
        CellPlace place;
        for (std::size_t k = 0; k < 3; ++k)
            place[k] = static_cast<int>(std::floor(directions[i][k] / side));
        placed.emplace_back(place, static_cast<std::uint32_t>(i));
    }
    std::sort(placed.begin(), placed.end());
    std::vector<GridCell> cells;
    for (const auto& [place, member] : placed) {
        if (cells.empty() || cells.back().place != place) cells.push_back({place, {}});
        cells.back().members.push_back(member);
    }
    return cells;
}

const GridCell* cell_at(const std::vector<GridCell>& cells, const CellPlace& place) {
    const auto at =
        std::lower_bound(cells.begin(), cells.end(), place,
                         [](const GridCell& cell, const CellPlace& p) { return cell.place < p; });
    return at != cells.end() && at->place == place ? &*at : nullptr;
}

/// Whether any member of one is within the distance of any of the other.
bool near_each_other(const GridCell& a, const GridCell& b, std::span<const Vec3> directions,
                     double distance) {
    for (const std::uint32_t i : a.members) {
        for (const std::uint32_t j : b.members) {
            if (length_squared(directions[i] - directions[j]) <= distance * distance) return true;
        }
    }
    return false;
}

/// Joins a cell with those of its neighbours that come after it: a distance away are at most two
/// cells, as the distance is a cell's diagonal.
void join_neighbours(const GridCell& cell, const std::vector<GridCell>& cells,
                     std::span<const Vec3> directions, double distance, JoinedSets& sets) {
    for (int i = 0; i < 125; ++i) {
        const CellPlace place{cell.place[0] + i / 25 - 2, cell.place[1] + i / 5 % 5 - 2,
                              cell.place[2] + i % 5 - 2};
        if (place <= cell.place) continue;
        const GridCell* other = cell_at(cells, place);
        if (!other) continue;
        const std::uint32_t a = cell.members.front(), b = other->members.front();
        if (sets.name_of(a) != sets.name_of(b) &&
            near_each_other(cell, *other, directions, distance))
            sets.join(a, b);
    }
}

}  // namespace

std::vector<std::uint32_t> group_directions(std::span<const Vec3> directions, double angle) {
    // The length of the chord between two directions `angle` apart. Not 0, as cells must have a
    // size.
    const double distance = std::max(2 * std::sin(angle / 2), kEpsilon);
    const std::vector<GridCell> cells = grid_cells(directions, distance / std::sqrt(3.));
    JoinedSets sets(directions.size());
    for (const GridCell& cell : cells) {
        for (const std::uint32_t member : cell.members) sets.join(cell.members.front(), member);
    }
    for (const GridCell& cell : cells) join_neighbours(cell, cells, directions, distance, sets);

    std::vector<std::uint32_t> groups(directions.size());
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < groups.size(); ++i) {
        const std::uint32_t name = sets.name_of(i);  // at most i, so it has its group already
        groups[i] = name == i ? count++ : groups[name];
    }
    return groups;
}

}  // namespace lightwalk
