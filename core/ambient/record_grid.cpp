#include "core/ambient/record_grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/math/random.h"

namespace lightwalk {
namespace {

constexpr float kThickness = 0.15f;     ///< of a disk, to either side, in its radius
constexpr double kCell = 0.5;           ///< least edge of a cell, in the reach of its records
constexpr float kOneNormal = 0.99999f;  ///< cosine of normals that count as one
constexpr int kMostGrids = 60;
constexpr double kEnoughOfSmall = 0.05;  ///< weight of small records that keeps larger ones out

std::array<float, 3> single(const Vec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

float single_dot(const std::array<float, 3>& a, const std::array<float, 3>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

RecordGrid::RecordGrid(const Vec3& origin, double least, double largest_angle)
    : origin_(origin),
      least_(least),
      largest_angle_(largest_angle),
      least_cosine_(std::cos(largest_angle)),
      slots_(64) {}

std::uint64_t RecordGrid::key(const Grid& grid, const Cell& cell) {
    // Factors of which no small multiples add up to 0.
    return mix_bits(grid.key + static_cast<std::uint64_t>(cell[0]) * 0x9e3779b97f4a7c15ULL +
                    static_cast<std::uint64_t>(cell[1]) * 0xbf58476d1ce4e5b9ULL +
                    static_cast<std::uint64_t>(cell[2]) * 0x94d049bb133111ebULL);
}

/// Where the key is, or would be.
std::size_t RecordGrid::slot_of(std::uint64_t key) const {
    std::size_t at = key & (slots_.size() - 1);
    while (slots_[at].first != kNone && slots_[at].key != key) at = (at + 1) & (slots_.size() - 1);
    return at;
}

void RecordGrid::add(std::uint64_t key, std::uint32_t record) {
    if (2 * used_ >= slots_.size()) {
        std::vector<Slot> old(2 * slots_.size());
        old.swap(slots_);
        for (const Slot& slot : old) {
            if (slot.first != kNone) slots_[slot_of(slot.key)] = slot;
        }
    }
    Slot& slot = slots_[slot_of(key)];
    if (slot.first == kNone) ++used_;
    slot.key = key;
    const auto entry = static_cast<std::uint32_t>(entries_.size());
    entries_.push_back({record, std::exchange(slot.first, entry)});
}

void RecordGrid::insert(const CoefficientRecord& record) {
    int number = 0;
    double edge = kCell * least_;
    for (; edge < kCell * record.reach && number < kMostGrids; edge *= 2) ++number;
    const Grid grid{number, mix_bits(static_cast<std::uint64_t>(number)), 1 / edge};
    const auto place = std::ranges::lower_bound(grids_, number, {}, &Grid::number);
    if (place == grids_.end() || place->number != number) grids_.insert(place, grid);
    const Vec3 at = record.position - origin_;
    Cell low{}, high{};
    for (std::size_t k = 0; k < 3; ++k) {
        const double n = std::abs(record.normal[k]);
        const double wide = record.reach * (std::sqrt(std::max(0.0, 1 - n * n)) +
                                            static_cast<double>(kThickness) * n);
        low[k] = static_cast<std::int64_t>(std::floor((at[k] - wide) * grid.inverse_edge));
        high[k] = static_cast<std::int64_t>(std::floor((at[k] + wide) * grid.inverse_edge));
    }
    const auto number_of_record = static_cast<std::uint32_t>(disks_.size());
    disks_.push_back({single(at), single(record.normal), static_cast<float>(1 / record.reach)});
    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
        for (std::int64_t y = low[1]; y <= high[1]; ++y) {
            for (std::int64_t z = low[2]; z <= high[2]; ++z)
                add(key(grid, {x, y, z}), number_of_record);
        }
    }
}

double RecordGrid::weight_of(const Disk& disk, const std::array<float, 3>& p,
                             const std::array<float, 3>& n) const {
    const std::array<float, 3> offset{p[0] - disk.position[0], p[1] - disk.position[1],
                                      p[2] - disk.position[2]};
    const float apart = std::sqrt(single_dot(offset, offset)) * disk.inverse_reach;
    if (apart >= 1) return 0;
    const float cosine = single_dot(n, disk.normal);
    if (static_cast<double>(cosine) <= least_cosine_) return 0;
    if (std::abs(single_dot(offset, disk.normal)) * disk.inverse_reach > kThickness) return 0;
    if (cosine > kOneNormal) return 1 - static_cast<double>(apart);
    const double angle = std::sqrt(std::max(0.0, 2 - 2 * static_cast<double>(cosine)));
    return std::max(0.0, 1 - angle / largest_angle_) * (1 - static_cast<double>(apart));
}

double RecordGrid::find(const Vec3& position, const Vec3& normal,
                        std::vector<RecordShare>& shares) const {
    const Vec3 at = position - origin_;
    const std::array<float, 3> p = single(at), n = single(normal);
    double weight = 0;
    for (const Grid& grid : grids_) {
        Cell cell{};
        for (std::size_t k = 0; k < 3; ++k)
            cell[k] = static_cast<std::int64_t>(std::floor(at[k] * grid.inverse_edge));
        std::uint32_t i = slots_[slot_of(key(grid, cell))].first;
        for (; i != kNone; i = entries_[i].next) {
            const std::uint32_t record = entries_[i].record;
            const double part = weight_of(disks_[record], p, n);
            if (part <= 0) continue;
            weight += part;
            shares.push_back({record, part});
        }
        if (weight >= kEnoughOfSmall) break;
    }
    return weight;
}

}  // namespace lightwalk
