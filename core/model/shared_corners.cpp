#include "core/model/shared_corners.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace lightwalk {
namespace {

constexpr std::size_t kFewest = 256, kMost = std::size_t{1} << 17;  ///< places
constexpr std::size_t kPoint = 3;                                   ///< numbers

}  // namespace

/// Multiplicative hashing: D. Knuth, "The Art of Computer Programming", volume 3, 6.4.
std::size_t RecentCorners::place_of(const double* point) const {
    constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15U;
    std::uint64_t hash = 0;
    for (std::size_t k = 0; k < kPoint; ++k)
        hash = (std::rotl(hash, 23) ^ std::bit_cast<std::uint64_t>(point[k])) * kGolden;
    return (hash ^ hash >> 32U) * kGolden >>
           static_cast<unsigned>(std::countl_zero(places_.size()) + 1);
}

std::uint32_t RecentCorners::find(const double* point, std::span<const double> reals) const {
    if (places_.empty()) return kNone;
    const std::uint32_t at = places_[place_of(point)];
    const bool same = at != kNone && std::memcmp(&reals[at], point, kPoint * sizeof(double)) == 0;
    return same ? at : kNone;
}

void RecentCorners::note(const double* point, std::uint32_t at) {
    if (2 * noted_ >= places_.size() && places_.size() < kMost)
        places_.assign(std::max(kFewest, 4 * places_.size()), kNone);
    ++noted_;
    places_[place_of(point)] = at;
}

}  // namespace lightwalk
