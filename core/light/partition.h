#pragma once
// Where a source is sampled from a point: its parts, and one direction with its solid angle for
// each. Source: Ward, "The RADIANCE lighting simulation and rendering system", SIGGRAPH 1994
// ("adaptive source subdivision"); the -ds and -dj options of rpict(1).
#include <array>
#include <optional>

#include "core/light/light_source.h"
#include "core/math/random.h"

namespace lightwalk {

inline constexpr int kMaxParts = 64;  ///< of one source

/// A share of a source's sampling box, in units of its half axes.
struct SourcePart {
    Vec3 center;  ///< the whole box: 0
    Vec3 size;    ///< half widths; the whole box: 1
};

inline constexpr SourcePart kWholeBox{{0, 0, 0}, {1, 1, 1}};

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
/// source's redirecting surface.
[[nodiscard]] bool out_of_reach(const LightSource& source, const Vec3& point);

/// Samples of round sources leave the box, by less than this times its size.
inline constexpr double kBoxMargin = 1.5;

/// Whether all samples of a source lie behind the plane through `point`. May be false though they
/// do.
[[nodiscard]] bool is_behind(const LightSource& source, const Vec3& point, const Vec3& normal);

/// How large a part may be relative to its distance, for -ds and the weight of a ray. 0: sources
/// are not divided.
[[nodiscard]] double partition_size(double subdivision, double weight);

/// Cuts a source into parts for points that look at it.
class Partition {
  public:
    explicit Partition(const LightSource& source);  ///< which must outlive this
    /// Parts no larger than `size_over_distance` times their distance from `point`. None when the
    /// source turns away (flat sources) or the point is in it (cylinders); always one when the size
    /// is 0.
    void operator()(const Vec3& point, double size_over_distance, SourceParts& parts) const;

  private:
    [[nodiscard]] bool is_far(const Vec3& to_center, double size_over_distance) const;

    const LightSource& source_;
    double longest_squared_;  ///< of the half axes [m²]
};

/// Where to sample one of `parts` parts, in units of the source's half axes.
[[nodiscard]] Vec3 position_in_box(const LightSource& source, const SourcePart& part, int parts,
                                   double jitter, RandomStream& random);

/// Sample one of `parts` parts. Nothing when it turns away, is out of reach, or is seen from
/// outside the source's spot.
[[nodiscard]] std::optional<SourceSample> sample_part(const LightSource& source,
                                                      const SourcePart& part, int parts,
                                                      const Vec3& point, double jitter,
                                                      RandomStream& random);

/// Sample the whole source as one part.
[[nodiscard]] std::optional<SourceSample> sample_whole(const LightSource& source, const Vec3& point,
                                                       double jitter, RandomStream& random);

}  // namespace lightwalk
