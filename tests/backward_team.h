#pragma once
// A team for tests of what must not depend on who does what first.
#include "core/math/team.h"

namespace lightwalk::test {

/// Runs the parts from the last to the first.
class BackwardTeam final : public Team {
  public:
    void run(std::size_t count, FunctionRef<void(std::size_t part)> part) const override {
        while (count-- > 0) part(count);
    }
};

}  // namespace lightwalk::test
