#pragma once
// Digests of bytes that tell whether they have changed; they do not protect against forgery.
#include <cstdint>
#include <string_view>

namespace lightwalk {

/// XXH3 with 64 bits (Collet; in the format of its reference implementation), about 10 GB/s.
/// @param seed  equal bytes with different seeds have different digests
[[nodiscard]] std::uint64_t digest_of_bytes(std::string_view bytes, std::uint64_t seed = 0);

}  // namespace lightwalk
