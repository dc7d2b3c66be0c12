#pragma once
// Serialisation of points and values of a round for other processes; hashes of points.
#include <cstdint>
#include <string>
#include <vector>

#include "core/ambient/ambient_point.h"

namespace lightwalk {

/// A value of a round, and those that were computed on the way to it.
struct RoundValue {
    std::vector<NewAmbientRecord> new_records;
    std::vector<AmbientRecord> record;  ///< one record, or none where it cannot be stored
};

[[nodiscard]] std::string encode_points(const std::vector<AmbientPoint>& points);
/// Append the decoded points. Throws InputError for bytes that are not the output of encode_points,
/// as the other decoders do.
void decode_points(const std::string& bytes, std::vector<AmbientPoint>& points);

[[nodiscard]] std::string encode_values(const std::vector<RoundValue>& values);
[[nodiscard]] std::vector<RoundValue> decode_values(const std::string& bytes);

/// A hash of all members of a point.
[[nodiscard]] std::uint64_t hash_of(const AmbientPoint& point);

}  // namespace lightwalk
