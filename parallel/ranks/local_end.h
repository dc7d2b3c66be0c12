#pragma once
// What within a rank is no role: its tracer, its ambient cache, its program.
#include "parallel/ranks/message.h"

namespace lightwalk {

class LocalEnd {
  public:
    virtual ~LocalEnd() = default;
    /// A message to Role::tracer, cache or program of this rank. Called by the thread that serves
    /// the messages, which must not wait here.
    virtual void take(Envelope envelope) = 0;
    /// Ambient values that were made here and wait to be sent. Called by the same thread, every
    /// second and at the end.
    [[nodiscard]] virtual AmbientValues unsent_values() { return {}; }
};

}  // namespace lightwalk
