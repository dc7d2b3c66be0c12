#pragma once
#include <cstdint>

#include "core/math/random.h"

namespace lightwalk {

/// The seed of answer `replication`, from 0 on, of several independent ones to the same question.
[[nodiscard]] constexpr std::uint64_t replication_seed(std::uint64_t seed, int replication) {
    constexpr std::uint64_t kApart = 0x7265706c69636173ULL;  // from what else is made of seeds
    return mix_bits(mix_bits(seed ^ kApart) + static_cast<std::uint64_t>(replication));
}

}  // namespace lightwalk
