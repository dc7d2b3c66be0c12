#pragma once
// What a rank traces for a run that ranks share.
#include "core/trace/tracer.h"
#include "parallel/executor.h"

namespace lightwalk {

class RankWork {
  public:
    virtual ~RankWork() = default;
    /// On ranks that trace: what rank 0 orders, until it says that no more comes.
    virtual void trace(Executor& executor) = 0;
    // What this rank did.
    [[nodiscard]] virtual RayCounters rays() const = 0;
    [[nodiscard]] virtual AmbientCounters ambient() const = 0;
};

}  // namespace lightwalk
