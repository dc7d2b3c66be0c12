#pragma once
// What is seen from a surface point: stratified samples of its hemisphere, and the change of their
// sum with place and tilt.
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/random.h"
#include "core/math/rgb.h"
#include "core/math/vec3.h"

namespace lightwalk {

/// One ray's answer: radiance times the sample's share, and the distance of what it saw [m].
struct HemisphereAnswer {
    Rgb value;
    double distance = 0;
};

/// Traces the rays of a hemisphere, some at a time.
class HemisphereRays {
  public:
    static constexpr std::size_t kTogether = 64;  ///< most rays between two calls of trace()
    virtual ~HemisphereRays() = default;
    /// Prepare a ray into a direction. False: it may not start.
    virtual bool start(const Vec3& direction) = 0;
    /// The answers to all that were started since the last call, in that order; valid until the
    /// next call.
    virtual std::span<const HemisphereAnswer> trace() = 0;
    /// Part of an answer of the last trace(), by its number, in a cell's value: the cell keeps
    /// `kept` of what it had.
    virtual void taken(std::size_t /*answer*/, std::size_t /*cell*/, float /*kept*/,
                       float /*share*/) {}
};

/// A cell of the hemisphere.
struct HemisphereCell {
    Vec3 vertex;          ///< what the first sample saw, relative to the point [m]
    double nearness = 0;  ///< 1 / distance of the nearest thing seen [1/m]; 0: no sample
    Rgb value;            ///< mean of the samples
};

/// n x n cells of equal cosine-weighted solid angle around `normal`; row-major, the first index
/// runs along v.
struct Hemisphere {
    Vec3 normal, u, v;
    int divisions = 0;
    std::vector<HemisphereCell> cells;
    Rgb sum;  ///< sum of the cells' values: E / π times the coefficient, E indirect irradiance
    int succeeded = 0;        ///< cells with a sample
    std::vector<Rgb> groups;  ///< of the sum, what each light group adds; empty: not asked for

    [[nodiscard]] const HemisphereCell& cell(int i, int j) const {
        return cells[static_cast<std::size_t>(i) * static_cast<std::size_t>(divisions) +
                     static_cast<std::size_t>(j)];
    }
    /// Density over solid angle [1/sr] of a sample of any cell: cosθ / π. That of a given cell has
    /// n² times as much in its own share of the hemisphere.
    [[nodiscard]] double pdf(const Vec3& wi) const { return std::max(0.0, dot(normal, wi)) / kPi; }
    [[nodiscard]] bool complete() const { return succeeded == divisions * divisions; }
};

struct HemisphereSampling {
    int divisions = 1;  ///< per axis
    int extra = 0;  ///< samples that go where neighbours differ; none where fewer than 4 divisions
    double share = 1;         ///< brightness of one sample's coefficient
    double farthest = kHuge;  ///< vertices are not farther than this [m]
    bool tells = false;       ///< HemisphereRays::taken() is called
};

/// Sample the hemisphere about the unit vector `normal`. Map: Shirley & Chiu, "A Low Distortion Map
/// Between Disk and Square", JGT 1997. `random` alone decides the directions.
[[nodiscard]] Hemisphere sample_hemisphere(const Vec3& normal, const HemisphereSampling& sampling,
                                           RandomStream random, HemisphereRays& rays);

/// Point of the unit disk for a point of the unit square (Shirley & Chiu); areas keep their ratio.
struct DiskPoint {
    double x = 0, y = 0;
};
[[nodiscard]] DiskPoint square_to_disk(double x, double y);

/// A hemisphere turned at random about its normal.
struct HemisphereFrame {
    HemisphereFrame(const Vec3& normal, RandomStream& random);
    /// The unit vector above a point of the disk.
    [[nodiscard]] Vec3 above(const DiskPoint& d) const;
    Vec3 normal, u, v;
};

/// Where the only ray of a hemisphere of one division goes, as above.
[[nodiscard]] Vec3 sample_direction(const Vec3& normal, RandomStream random);

}  // namespace lightwalk
