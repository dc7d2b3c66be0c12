#pragma once
// Who answers lists of rays: the threads of this process, or all ranks together.
#include <optional>
#include <string>

#include "apps/session/lightwalk/renderer.h"

namespace lightwalk {

class RayMaker {
  public:
    virtual ~RayMaker() = default;
    /// A list that take() will be asked for, after those ordered before it.
    virtual void order(RayTask list) = 0;
    /// The answer to the oldest list that was ordered and not taken: the records of its rays one
    /// after the other. Nothing: stopped.
    [[nodiscard]] virtual std::optional<std::string> take() = 0;
    /// @param wait  until a further list is wanted, or the oldest one is answered
    [[nodiscard]] virtual RayDemand demand(bool wait) = 0;
};

}  // namespace lightwalk
