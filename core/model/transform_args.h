#pragma once
// Transform words as they stand in scene files: -t -s -rx -ry -rz -mx -my -mz -i.
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "core/math/transform.h"

namespace lightwalk {

struct ParsedTransform {
    Transform transform;
    std::size_t words =
        0;  ///< how many words belonged to it; parsing stops at the first that does not
};

/// Parse the longest valid transform at the beginning of `words` (angles in degrees, operations
/// left to right, `-i n` repeats what follows n times). Never throws; `-s 0` and malformed numbers
/// end it. Source: Radiance manual page xform(1).
[[nodiscard]] ParsedTransform parse_transform(std::span<const std::string> words);
[[nodiscard]] ParsedTransform parse_transform(std::span<const std::string_view> words);

/// Whether `word` is one of the transform options, exactly.
[[nodiscard]] bool is_transform_option(std::string_view word);

/// Strict decimal number of the scene language, whole word; false when it is not one.
[[nodiscard]] bool parse_real(std::string_view word, double& value);
[[nodiscard]] bool parse_integer(std::string_view word, long& value);

}  // namespace lightwalk
