#pragma once
// Finds the records that serve a point among those of one ambient level.
#include <array>
#include <cstdint>
#include <vector>

#include "core/ambient/ambient_cache.h"

namespace lightwalk {

/// A record that serves a point.
struct RecordShare {
    std::uint32_t record = 0;  ///< how many were inserted before it
    double weight = 0;         ///< among those that serve
    double factor = 1;         ///< of its value at the point
};

/// The octree of the ambient caches for records of one level and weight, in which nodes know where
/// their records are usable. Lookups may be made by many threads, not while records are inserted.
class RecordTree {
  public:
    explicit RecordTree(const AmbientLimits& limits) : limits_(limits), nodes_(1) {}
    [[nodiscard]] std::size_t size() const { return records_.size(); }
    void insert(const AmbientRecord& record);
    /// Appends the records whose weighted sum SerialCache::lookup is.
    /// @return  their weight
    double find(const AmbientQuery& query, LeakTest leaks, std::vector<RecordShare>& shares) const;

  private:
    static constexpr std::uint32_t kNone = 0xffffffff;
    /// Where records are usable.
    struct Box {
        std::array<float, 3> low{1, 1, 1}, high{};
        [[nodiscard]] bool holds(const std::array<float, 3>& p) const {
            return p[0] >= low[0] && p[0] <= high[0] && p[1] >= low[1] && p[1] <= high[1] &&
                   p[2] >= low[2] && p[2] <= high[2];
        }
        void grow(const Box& other);
    };
    struct Node {
        Box box;                      ///< of its records and those below
        std::uint32_t children = 0;   ///< first of eight; 0: none
        std::uint32_t first = kNone;  ///< record
    };
    /// A record's place in the tree, beside the record itself: most are not usable.
    struct Leaf {
        Box box;
        std::uint32_t next = kNone;  ///< record of its node
    };
    struct Search;
    [[nodiscard]] double find_below(const Node& node, double edge, const Search& search) const;

    AmbientLimits limits_;
    std::vector<Node> nodes_;
    std::vector<Leaf> leaves_;  ///< one a record
    std::vector<DecodedRecord> records_;
};

}  // namespace lightwalk
