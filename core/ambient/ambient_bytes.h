#pragma once
// An ambient record as bytes: in ambient files, and between processes.
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "core/ambient/ambient_record.h"

namespace lightwalk {

inline constexpr std::size_t kAmbientRecordSize = 67;  ///< bytes, with three channels

/// 67 bytes, the same on every machine: level, weight, position, directions, radii, gradients,
/// corral, value, as Radiance's ambient files hold them. Reals keep their 24 bits, the value the
/// eight of a shared-exponent pixel.
[[nodiscard]] std::string encode_ambient_record(const AmbientRecord& record);

/// The record in the first 67 bytes; `bytes` must hold so many. What it says may still make no
/// sense: see ambient_record_problem.
[[nodiscard]] AmbientRecord decode_ambient_record(std::string_view bytes);

/// What is wrong with a record, as "a weight out of range"; nothing when a cache can use it.
[[nodiscard]] std::optional<std::string> ambient_record_problem(const AmbientRecord& record);

}  // namespace lightwalk
