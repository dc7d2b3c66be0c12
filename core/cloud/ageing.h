#pragma once
// Which points the cloud keeps for the next frame.
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/cloud/point.h"
#include "core/cloud/projection.h"

namespace lightwalk {

inline constexpr int kOldestAge = 255;

/// How long points live.
struct CloudLife {
    int age = 25;                ///< frames without use that a point outlives, at most kOldestAge
    bool supersaturated = true;  ///< false: a point that a frame did not use is dropped
};

/// Points by age, of the cloud or of a part of it.
using AgeCounts = std::array<std::size_t, kOldestAge + 1>;

/// Make points one frame older; those that were used are of age 0 again. Those that do not stay are
/// gone (PointKind).
/// @param points  a part of the cloud
/// @param used    for each of them: not 0 where it was used
/// @param places  for each of them: where the frame showed it
/// @param keep    for each of them, set: 1 where it stays, 0 where it is too old, unused or out of
///                the picture, or was gone before
/// @return        the ages of those that stay
[[nodiscard]] AgeCounts age_points(std::span<CloudPoint> points, std::span<const std::uint8_t> used,
                                   std::span<const ImagePlace> places, const CloudLife& life,
                                   std::span<std::uint8_t> keep);

/// What has to go for want of room: the longest unused points, and of one age those that draw the
/// lowest lots (see lot). So it does not matter who keeps which of them.
struct AgeLimit {
    int age = kOldestAge;     ///< older ones go
    std::uint32_t share = 0;  ///< and of just that age those whose lots lie below
    friend bool operator==(const AgeLimit&, const AgeLimit&) = default;
};
/// For so many points to stay at most: as lots are drawn, a few less do.
[[nodiscard]] AgeLimit age_limit(const AgeCounts& counts, std::size_t most);

}  // namespace lightwalk
