#pragma once
// Finds the records of coefficients that serve a point.
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/math/rgb.h"
#include "core/math/vec3.h"

namespace lightwalk {

/// A place for which indirect light is kept. It serves the points of a flat disk about it. Other
/// than an ambient value it has no gradients: these differ from emitter to emitter.
struct CoefficientRecord {
    Vec3 position;     ///< [m]
    Vec3 normal;       ///< unit, on the side whose light it is
    double reach = 0;  ///< radius of the disk [m]
    Rgb value;         ///< irradiance / pi [W/(m² sr)]
};

/// A record that serves a point.
struct RecordShare {
    std::uint32_t record = 0;  ///< how many were inserted before it
    double weight = 0;         ///< among those that serve
};

/// Records in grids, each of one size of disks: its cells, which are hashed, list the records that
/// reach into them. Lookups may be made by many threads, not while records are inserted.
class RecordGrid {
  public:
    /// @param origin         near the records: places are kept to single precision from there [m]
    /// @param least          smallest reach [m]
    /// @param largest_angle  between the normals of a record and of a point that it serves [rad]
    RecordGrid(const Vec3& origin, double least, double largest_angle);
    [[nodiscard]] std::size_t size() const { return disks_.size(); }
    void insert(const CoefficientRecord& record);
    /// Appends the records that serve a point; those of small disks keep larger ones out.
    /// @param normal  unit
    /// @return        their weight; 0: there are none
    double find(const Vec3& position, const Vec3& normal, std::vector<RecordShare>& shares) const;

  private:
    static constexpr std::uint32_t kNone = 0xffffffff;
    /// All records of similar reach.
    struct Grid {
        int number = 0;           ///< twos that its cells' edge has more than the smallest
        std::uint64_t key = 0;    ///< that those of its cells are made of
        double inverse_edge = 0;  ///< [1/m]
    };
    using Cell = std::array<std::int64_t, 3>;
    /// All of a record that decides whether it serves. A record lies in dozens of cells; these hold
    /// its number, so that what a processor's nearest cache has of it serves for all of them.
    struct Disk {
        std::array<float, 3> position{}, normal{};
        float inverse_reach = 0;
    };
    /// A record in a cell.
    struct Entry {
        std::uint32_t record = 0;
        std::uint32_t next = kNone;  ///< of the same cell
    };
    struct Slot {
        std::uint64_t key = 0;
        std::uint32_t first = kNone;  ///< kNone: the slot is free
    };
    [[nodiscard]] static std::uint64_t key(const Grid& grid, const Cell& cell);
    [[nodiscard]] std::size_t slot_of(std::uint64_t key) const;
    void add(std::uint64_t key, std::uint32_t record);
    [[nodiscard]] double weight_of(const Disk& disk, const std::array<float, 3>& p,
                                   const std::array<float, 3>& n) const;

    Vec3 origin_;
    double least_, largest_angle_, least_cosine_;
    std::size_t used_ = 0;     ///< slots
    std::vector<Grid> grids_;  ///< that have records, from the smallest disks on
    std::vector<Slot> slots_;  ///< a power of two
    std::vector<Disk> disks_;  ///< by record
    std::vector<Entry> entries_;
};

}  // namespace lightwalk
