#pragma once
// Where a source is sampled from a point: its parts, and one direction with its solid angle for
// each. Source: Ward, "The RADIANCE lighting simulation and rendering system", SIGGRAPH 1994
// ("adaptive source subdivision"); the -ds and -dj options of rpict(1).
#include <array>
#include <optional>
#include <vector>

#include "core/light/light_source.h"
#include "core/math/random.h"

namespace lightwalk {

inline constexpr int kMaxParts = 64;  ///< of one source

/// A share of a source's sampling box, in units of its half axes.
struct SourcePart {
    Vec3 center;  ///< the whole box: 0
    Vec3 size;    ///< half widths; the whole box: 1
};

struct SourceParts {
    std::array<SourcePart, kMaxParts> part;
    int count = 0;
};

/// One sample of a source: unit direction, distance of the sampled point and solid angle it stands
/// for.
struct SourceSample {
    Vec3 direction;
    double distance =
        kHuge;  ///< to the sampled point, not to the source's surface [m]; kHuge: at infinity
    double solid_angle = 0;  ///< [sr]
};

/// Whether the point is beyond a local glow's radius of influence, or beside the beam of a virtual
/// source's relay.
[[nodiscard]] bool out_of_reach(const LightSource& source, const Vec3& point);

/// Whether all samples of a source lie behind the plane through `point`. May be false though they
/// do.
[[nodiscard]] bool is_behind(const LightSource& source, const Vec3& point, const Vec3& normal);

/// How large a part may be relative to its distance, for -ds and the weight of a ray. 0: sources
/// are not divided.
[[nodiscard]] double partition_size(double subdivision, double weight);

/// Cut a source into parts no larger than `size_over_distance` times their distance from `point`.
/// No parts when the source turns away (flat sources) or the point is in it (cylinders); always one
/// when the size is 0.
void partition(const LightSource& source, const Vec3& point, double size_over_distance,
               SourceParts& parts);

/// Sample one of `parts` parts. Nothing when the part turns away, is out of reach, or is seen from
/// outside the source's spot.
[[nodiscard]] std::optional<SourceSample> sample_part(const LightSource& source,
                                                      const SourcePart& part, int parts,
                                                      const Vec3& point, double jitter,
                                                      RandomStream& random);

/// Sample all parts; `samples` grows by those that may bring light.
void sample_parts(const LightSource& source, const SourceParts& parts, const Vec3& point,
                  double jitter, RandomStream& random, std::vector<SourceSample>& samples);

/// Sample the whole source as one part.
[[nodiscard]] std::optional<SourceSample> sample_whole(const LightSource& source, const Vec3& point,
                                                       double jitter, RandomStream& random);

}  // namespace lightwalk
