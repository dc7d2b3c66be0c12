#pragma once
// Ageing of points: which of them the cloud keeps for the next frame.
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
    int age = 25;  ///< unused frames after which a point is dropped, at most kOldestAge
    bool supersaturated = true;  ///< false: a point that a frame did not use is dropped
    int awake = 0;  ///< frames after which a point out of the picture falls asleep; 0: it is
                    ///< dropped at once
};

/// What becomes of a point.
enum class PointFate : std::uint8_t { gone, stays, sleeps };

/// Numbers of points by age.
using AgeCounts = std::array<std::size_t, kOldestAge + 1>;

/// Age points by one frame; the age of those that were used is reset to 0. Points to be dropped
/// become PointKind::gone.
/// @param points  a part of the cloud
/// @param used    for each of them: not 0 where it was used
/// @param places  for each of them: where the frame showed it; distances below 0: another owner's
/// @param fates   for each of them, set: gone where it is too old, unused or out of the picture, or
///                was gone before
/// @return        the ages of those that stay
[[nodiscard]] AgeCounts age_points(std::span<CloudPoint> points, std::span<const std::uint8_t> used,
                                   std::span<const ImagePlace> places, const CloudLife& life,
                                   std::span<PointFate> fates);

/// Which points are dropped when there are too many: those unused longest, and of one age those
/// whose lot() is lowest. The choice depends on the points only, not on which rank keeps them.
struct AgeLimit {
    int age = kOldestAge;     ///< older points are dropped
    std::uint32_t share = 0;  ///< and points of this age whose lot() is below
    friend bool operator==(const AgeLimit&, const AgeLimit&) = default;
};
/// The limit by which at most `most` points stay. As lots are random, a few less do.
[[nodiscard]] AgeLimit age_limit(const AgeCounts& counts, std::size_t most);

}  // namespace lightwalk
