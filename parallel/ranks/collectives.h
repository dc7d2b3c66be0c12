#pragma once
// What ranks of a group tell each other, one round after the other: rank 0 gathers all shares.
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "parallel/ranks/topology.h"
#include "parallel/work_queue/outbox.h"

namespace lightwalk {

class Collectives {
  public:
    /// @param owners  of the workers, the first ones: those of Collective::Group::owners
    Collectives(const Topology& topology, std::size_t owners);

    [[nodiscard]] const std::vector<int>& members(Collective::Group group) const {
        return members_[static_cast<std::size_t>(group)];
    }
    /// On rank 0 a share of a round; on every rank the result. Throws InputError for what no member
    /// of the group should have sent.
    void handle(int from, Collective message, Outbox& out);

  private:
    struct Round {
        Collective result;
        std::size_t missing = 0;
    };
    std::array<std::vector<int>, kGroups> members_;                        ///< by group, ascending
    std::map<std::pair<Collective::Group, std::uint32_t>, Round> rounds_;  ///< not yet complete
};

}  // namespace lightwalk
