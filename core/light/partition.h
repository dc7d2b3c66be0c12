#pragma once
// Where a source is sampled from a point: its parts, and one direction with its solid angle for
// each. Source: Ward, "The RADIANCE lighting simulation and rendering system", SIGGRAPH 1994
// ("adaptive source subdivision"); the -ds and -dj options of rpict(1).
#include <array>
#include <optional>

#include "core/light/light_source.h"
#include "core/math/random.h"

namespace lightwalk {

/// A source is divided into no more parts than this.
inline constexpr int kMaxParts = 64;

/// A part of a source's sampling box, in units of the box's half axes.
struct SourcePart {
    Vec3 center;  ///< 0 for the whole box
    Vec3 size;    ///< half widths; 1 for the whole box
};

inline constexpr SourcePart kWholeBox{{0, 0, 0}, {1, 1, 1}};

struct SourceParts {
    std::array<SourcePart, kMaxParts> part;
    int count = 0;
};

/// One sample of a source: a direction, and the solid angle for which it stands. Of undivided
/// polygons that are jittered fully, the solid angle is 1 / pdf; of others it is Radiance's
/// estimate from the projected area at the sampled position.
struct SourceSample {
    Vec3 direction;  ///< unit, from the point to the sampled position
    /// To the sampled position, not to the source's surface [m]; kHuge: at infinity.
    double distance = kHuge;
    double solid_angle = 0;  ///< [sr]
};

/// Whether the point is beyond a local glow's radius of influence, or beside the beam of a virtual
/// source's redirecting surface.
[[nodiscard]] bool out_of_reach(const LightSource& source, const Vec3& point);

/// Samples of round sources lie outside the sampling box by less than this times its size.
inline constexpr double kBoxMargin = 1.5;

/// Whether all samples of a source certainly lie behind the plane through `point`. Conservative:
/// true implies that they do.
[[nodiscard]] bool is_behind(const LightSource& source, const Vec3& point, const Vec3& normal);

/// How large a part of a source may be relative to its distance, for -ds and the weight of a ray; 0
/// where sources are not divided.
[[nodiscard]] double partition_size(double subdivision, double weight);

/// Cuts a source into parts for points that look at it.
class Partition {
  public:
    explicit Partition(const LightSource& source);  ///< the source must outlive the Partition
    /// Cut the source into parts no larger than `size_over_distance` times their distance from
    /// `point`. There are none when the source turns away (flat sources) or the point is in it
    /// (cylinders), and always one when the size is 0.
    void operator()(const Vec3& point, double size_over_distance, SourceParts& parts) const;

  private:
    [[nodiscard]] bool is_far(const Vec3& to_center, double size_over_distance) const;

    const LightSource& source_;
    double longest_squared_;  ///< square of the longer half axis [m²]
};

/// Where to sample one of `parts` parts, in units of the source's half axes.
/// @param jitter  -dj: how much of the part samples fill, from 0 (its centre, and no random number
///                is drawn) to 1
[[nodiscard]] Vec3 position_in_box(const LightSource& source, const SourcePart& part, int parts,
                                   double jitter, RandomStream& random);

/// Density of position_in_box: over the plane (x, y) of flat and distant sources, over the space
/// (x, y, z) of others, in units of half axes; to be divided by |u x v| for a density over area
/// [1/m²; at infinity 1/sr], by |u · (v x w)| for one over volume [1/m³].
/// @param jitter  above 0
[[nodiscard]] double position_pdf(const LightSource& source, const SourcePart& part, int parts,
                                  double jitter, const Vec3& position);

/// Sample one of `parts` parts of a source. Nothing when the part turns away, is out of reach, or
/// is seen from outside the source's spot. Before that, directions have the density of
/// position_in_box times the squared distance over the cosine to the normal (of volumes, integrated
/// along the way).
[[nodiscard]] std::optional<SourceSample> sample_part(const LightSource& source,
                                                      const SourcePart& part, int parts,
                                                      const Vec3& point, double jitter,
                                                      RandomStream& random);

/// Sample a whole source as one part.
[[nodiscard]] std::optional<SourceSample> sample_whole(const LightSource& source, const Vec3& point,
                                                       double jitter, RandomStream& random);

}  // namespace lightwalk
