#pragma once
// A point where an ambient value is missing, apart from the ray that found it.
#include <cstdint>
#include <type_traits>
#include <vector>

#include "core/ambient/ambient_record.h"
#include "core/transport/ray.h"

namespace lightwalk {

/// All that the value at a point depends on, but for the cache: the query, and what the rays of its
/// hemisphere inherit from the ray that wanted the value.
struct AmbientPoint {
    AmbientQuery query;
    Medium medium;           ///< without scattering sources
    double distance = 0;     ///< length of the ray that wanted the value [m]
    double path_length = 0;  ///< that ray's RayPath::path_length [m]
    double limit = 0;        ///< that ray's aft clipping distance; 0: none [m]
    int ray_level = 0;       ///< that ray's RayPath::level
    std::int32_t target = kNoTarget;
    std::uint16_t history = kPrimary;
    bool far_side = false;  ///< the value is of the side that the ray did not come from
};

/// What is wanted and not there. Where a context has one, rays only find points: no value is
/// computed and no light source looked at, so that what they bring back means nothing. Points
/// inside clipped matter or a mist that scatters are left out: they do not stand alone.
struct MissingAmbient {
    std::vector<AmbientPoint> points;
    bool left_out = false;  ///< one was, that a primary ray or what it became wanted
};

/// A value that was computed on the way to others, with the point that wanted it.
struct NewAmbientRecord {
    AmbientPoint point;
    AmbientRecord record;
    std::vector<Rgb> groups = {};  ///< of its value, what each light group adds; empty: not asked
};

/// Takes values that are computed on the way, in their order. Where a context has one, they are not
/// stored; those whose points do not stand alone are lost.
struct NewAmbientRecords {
    std::vector<NewAmbientRecord> new_records;
};

}  // namespace lightwalk
