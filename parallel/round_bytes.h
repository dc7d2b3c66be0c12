#pragma once
// Points and values of a round as bytes, for other processes, and for an order of points.
#include <cstdint>
#include <string>
#include <vector>

#include "core/ambient/ambient_point.h"

namespace lightwalk {

/// A value of a round, and those that were computed on the way to it.
struct RoundValue {
    std::vector<NewAmbientRecord> new_records;
    std::vector<AmbientRecord> record;  ///< one, or none where it cannot be stored
};

[[nodiscard]] std::string encode_points(const std::vector<AmbientPoint>& points);
/// Appends. Throws InputError for bytes that encode_points did not make, as do the others.
void decode_points(const std::string& bytes, std::vector<AmbientPoint>& points);

[[nodiscard]] std::string encode_values(const std::vector<RoundValue>& values);
[[nodiscard]] std::vector<RoundValue> decode_values(const std::string& bytes);

/// A number that is random, but a function of all that the point holds.
[[nodiscard]] std::uint64_t hash_of(const AmbientPoint& point);

}  // namespace lightwalk
