#pragma once
// Those who want to know of each new ambient value: files, other processes.
#include "core/ambient/ambient_record.h"

namespace lightwalk {

class AmbientListener {
  public:
    virtual ~AmbientListener() = default;
    /// A value was computed and stored in the cache. May be called by any thread that traces rays.
    virtual void stored(const AmbientRecord& record) = 0;
};

}  // namespace lightwalk
