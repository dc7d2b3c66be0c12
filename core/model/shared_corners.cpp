#include "core/model/shared_corners.h"

#include <algorithm>
#include <bit>

namespace lightwalk {
namespace {

constexpr std::size_t kFewestPlaces = 256, kMostPlaces = std::size_t{1} << 15;  ///< places

std::array<std::uint64_t, 3> bits_of(const double* point) {
    return {std::bit_cast<std::uint64_t>(point[0]), std::bit_cast<std::uint64_t>(point[1]),
            std::bit_cast<std::uint64_t>(point[2])};
}

/// Without memcmp, which the library's comparison of arrays calls.
bool same(const std::array<std::uint64_t, 3>& a, const std::array<std::uint64_t, 3>& b) {
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

}  // namespace

/// Multiplicative hashing: D. Knuth, "The Art of Computer Programming", volume 3, 6.4.
std::size_t RecentCorners::place_of(const Bits& bits) const {
    constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15U;
    std::uint64_t hash = 0;
    for (const std::uint64_t word : bits) hash = (std::rotl(hash, 23) ^ word) * kGolden;
    return (hash ^ hash >> 32U) * kGolden >>
           static_cast<unsigned>(std::countl_zero(places_.size()) + 1);
}

std::uint32_t RecentCorners::find(const double* point, std::span<const double> reals) {
    const Bits bits = bits_of(point);
    for (const Last& last : last_)
        if (same(last.bits, bits) && last.at != kNone) return last.at;
    if (places_.empty()) return kNone;
    const std::uint32_t at = places_[place_of(bits)];
    if (at == kNone || !same(bits_of(&reals[at]), bits)) return kNone;
    remember(bits, at);
    return at;
}

void RecentCorners::note(const double* point, std::uint32_t at) {
    if (2 * noted_ >= places_.size() && places_.size() < kMostPlaces)
        places_.assign(std::max(kFewestPlaces, 4 * places_.size()), kNone);
    ++noted_;
    const Bits bits = bits_of(point);
    places_[place_of(bits)] = at;
    remember(bits, at);
}

void RecentCorners::remember(const Bits& bits, std::uint32_t at) {
    last_[next_last_] = {bits, at};
    next_last_ = (next_last_ + 1) % last_.size();
}

}  // namespace lightwalk
