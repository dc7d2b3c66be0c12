#pragma once
// Those who want to know of each new ambient value: files, other processes.
#include <span>

#include "core/ambient/ambient_record.h"

namespace lightwalk {

class AmbientListener {
  public:
    virtual ~AmbientListener() = default;
    /// A value was computed and stored in the cache. May be called by any thread that traces rays.
    /// @param groups  of it, what each light group adds; empty: not kept
    virtual void stored(const AmbientRecord& record, std::span<const Rgb> groups) = 0;
};

}  // namespace lightwalk
