#pragma once
// A cached ambient value and the rule by which it serves other points.
#include <array>
#include <cstdint>
#include <optional>

#include "core/math/function_ref.h"
#include "core/math/rgb.h"
#include "core/math/vec3.h"

namespace lightwalk {

/// Indirect irradiance / pi at a point, with its gradients and its validity ellipse. The frame is
/// (u, n x u, n). Sources: Ward & Heckbert, "Irradiance Gradients", EGWR 1992; Schwarzhaupt, Jensen
/// & Jarosz, "Practical Hessian-Based Error Control for Irradiance Caching", SIGGRAPH Asia 2012.
struct AmbientRecord {
    std::array<float, 3> position{};     ///< [m]
    std::uint32_t normal = 0, axis = 0;  ///< n and u, as encode_direction codes them
    std::array<float, 2> radius{};       ///< short and long, along u and v, per unit of -aa [m]
    std::array<float, 2> translation{};  ///< relative change per metre along u and v [1/m]
    std::array<float, 2> rotation{};     ///< relative change per radian about u and v
    Rgb value;                           ///< [W/(m² sr)]
    float weight = 1;          ///< evaluation weight: values of less are less exact; in (0, 1]
    std::uint32_t corral = 0;  ///< azimuths of 1/32 turn in which something near may hide the point
    std::uint8_t level = 0;    ///< ambient evaluations that were open around this one
};

/// What a cache needs to know of scene and options.
struct AmbientLimits {
    Vec3 origin;              ///< lower corner of the scene's cube
    double size = 1;          ///< its edge [m]
    double accuracy = 0.1;    ///< -aa
    double least_radius = 0;  ///< from -ar [m]
    double most_radius = 0;
};

/// A point that wants an ambient value.
struct AmbientQuery {
    Vec3 position;
    Vec3 normal;          ///< the surface's, on the side whose light is wanted
    Vec3 shading_normal;  ///< the normal as textures turn it
    int level = 0;        ///< open ambient evaluations
    double weight = 1;    ///< RayPath::weight of the ray that hit the point
};

/// Whether something opaque stands on the segment from the query's point to `target`.
using LeakTest = FunctionRef<bool(const Vec3& target)>;

/// Weighted sum over records; the value is sum / weight where weight > kEpsilon.
struct AmbientSum {
    double weight = 0;
    std::array<double, 3> sum{};
};

/// A record as lookups read it: directions decoded.
struct DecodedRecord {
    explicit DecodedRecord(const AmbientRecord& record);
    DecodedRecord() = default;
    [[nodiscard]] Vec3 n() const { return {normal[0], normal[1], normal[2]}; }
    [[nodiscard]] Vec3 u() const { return {axis[0], axis[1], axis[2]}; }
    [[nodiscard]] bool serves(int query_level, double query_weight) const {
        return level < query_level ||
               (level == query_level && static_cast<double>(weight) >= 0.9 * query_weight);
    }

    std::array<float, 3> position{}, normal{}, axis{};
    std::array<float, 2> radius{}, translation{}, rotation{};
    Rgb value;
    float weight = 1;
    std::uint32_t corral = 0;
    std::uint32_t next = 0;  ///< next record in the list of its node; for caches
    std::uint8_t level = 0;
};

/// Largest angle between normals [rad] at a node; wider for light rays where the node holds a
/// record of their level.
[[nodiscard]] double largest_angle(double accuracy, double query_weight, bool has_level);

/// Corners of the bounding box of all points at which a record may be usable: an ellipsoid, cut off
/// below the surface [m].
struct RecordReach {
    Vec3 low, high;
};
[[nodiscard]] RecordReach reach_of(const DecodedRecord& record, const AmbientLimits& limits);

/// Weight of small records that keeps larger ones out.
inline constexpr double kEnoughWeight = 0.05;

/// What a record is good for at a point.
struct RecordUse {
    double weight = 0;  ///< among others; 0: it is not valid there
    double factor = 1;  ///< of its value there
};
[[nodiscard]] RecordUse use_of(const DecodedRecord& record, const AmbientQuery& query,
                               const AmbientLimits& limits, double most_angle, LeakTest leaks);

/// Add what the record says about the query's point; nothing when it is not valid there.
void add_record(const DecodedRecord& record, const AmbientQuery& query, const AmbientLimits& limits,
                double most_angle, LeakTest leaks, AmbientSum& sum);

/// Relative value of the record at an offset and another normal, in [0.05, 20].
[[nodiscard]] double extrapolated(const DecodedRecord& record, const Vec3& offset,
                                  const Vec3& shading_normal);

}  // namespace lightwalk
