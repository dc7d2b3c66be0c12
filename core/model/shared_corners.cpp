#include "core/model/shared_corners.h"

#include <algorithm>
#include <bit>

namespace lightwalk {
namespace {

constexpr std::size_t kFewestPlaces = 256, kMostPlaces = std::size_t{1} << 17;  ///< places
constexpr std::size_t kNumbers = 3;                                             ///< numbers

}  // namespace

/// Multiplicative hashing: D. Knuth, "The Art of Computer Programming", volume 3, 6.4.
std::size_t RecentCorners::place_of(const double* point) const {
    constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15U;
    std::uint64_t hash = 0;
    for (std::size_t k = 0; k < kNumbers; ++k)
        hash = (std::rotl(hash, 23) ^ std::bit_cast<std::uint64_t>(point[k])) * kGolden;
    return (hash ^ hash >> 32U) * kGolden >>
           static_cast<unsigned>(std::countl_zero(places_.size()) + 1);
}

std::uint32_t RecentCorners::find(const double* point, std::span<const double> reals) const {
    if (places_.empty()) return kNone;
    const std::uint32_t at = places_[place_of(point)];
    if (at == kNone) return kNone;
    for (std::size_t k = 0; k < kNumbers; ++k)
        if (std::bit_cast<std::uint64_t>(reals[at + k]) != std::bit_cast<std::uint64_t>(point[k]))
            return kNone;
    return at;
}

void RecentCorners::note(const double* point, std::uint32_t at) {
    if (2 * noted_ >= places_.size() && places_.size() < kMostPlaces)
        places_.assign(std::max(kFewestPlaces, 4 * places_.size()), kNone);
    ++noted_;
    places_[place_of(point)] = at;
}

}  // namespace lightwalk
