#include "io/files/digest.h"

#include <xxhash.h>

namespace lightwalk {

std::uint64_t digest_of_bytes(std::string_view bytes, std::uint64_t seed) {
    return XXH3_64bits_withSeed(bytes.data(), bytes.size(), seed);
}

}  // namespace lightwalk
