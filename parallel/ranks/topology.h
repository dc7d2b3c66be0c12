#pragma once
// Who plays which role.
#include <optional>
#include <vector>

#include "core/view/pixels.h"
#include "parallel/ranks/message.h"

namespace lightwalk {

/// How work is spread.
enum class Variant {
    threads,  ///< one process: no messages
    ranks,    ///< one thread a rank; master and ambient master do not trace
    hybrid,   ///< ranks of threads; rank 0 traces beside being the master
};

/// Roles of `ranks` ranks. Rank 0 is always the master that the others' masters answer to.
struct Topology {
    struct Worker {
        int rank = 0;
        int master = 0;  ///< rank of the master that gives it blocks
    };
    /// A master below rank 0: asks there for blocks, by the dozen, for its own workers.
    struct SubMaster {
        int rank = 0;
        std::vector<Address> children;
    };
    int ranks = 1;
    std::vector<Worker> workers;
    std::vector<SubMaster> sub_masters;
    std::vector<Address> children;      ///< of rank 0: its own workers, and the sub-masters
    std::optional<int> ambient_master;  ///< its rank, where ambient values are exchanged

    [[nodiscard]] bool traces(int rank) const { return worker_index(rank).has_value(); }
    [[nodiscard]] std::optional<std::size_t> worker_index(int rank) const;
};

/// @param ranks    at least 1 for `hybrid`; for `ranks` at least one worker beside master, ambient
///                 master and sub-masters. Throws InputError "... needs at least N ranks"
/// @param ambient  whether ambient values are exchanged
/// @param masters  number of all masters, rank 0 included; 0: as many as it takes that none has
///                 more than kMostChildren children
[[nodiscard]] Topology make_topology(Variant variant, int ranks, bool ambient, int masters);

/// The rectangles of a picture that its workers own: `count` of them, side by side, as square as
/// they come; some are empty when there are fewer pixels than workers. None is kept: with as many
/// workers as a large machine has cores, a list of all would be too long to be walked each block.
class SubImages {
  public:
    SubImages() = default;
    SubImages(const PixelRectangle& area, std::size_t count);
    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] PixelRectangle operator[](std::size_t i) const;
    /// Indices of all that share pixels with `block`, smallest first.
    [[nodiscard]] std::vector<std::size_t> overlapping(const PixelRectangle& block) const;

  private:
    [[nodiscard]] std::size_t first_of(std::size_t column) const {
        return column * count_ / columns_;
    }
    [[nodiscard]] PixelRectangle part(std::size_t column, std::size_t row) const;

    PixelRectangle area_;
    std::size_t count_ = 0, columns_ = 1;
};

}  // namespace lightwalk
