#pragma once
// Transform words as they stand in scene files: -t -s -rx -ry -rz -mx -my -mz -i.
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>

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

/// parse_transform() of words that come again and again: xform writes the same ones behind each
/// modifier of what it places, thousands of them in a scene.
class TransformMemo {
  public:
    [[nodiscard]] const ParsedTransform& parse(std::span<const std::string> words);

  private:
    std::unordered_map<std::string, ParsedTransform> known_;  ///< by the words, each ended by a 0
};

/// Whether `word` is one of the transform options, exactly.
[[nodiscard]] bool is_transform_option(std::string_view word);

/// Strict decimal number of the scene language, whole word; false when it is not one.
[[nodiscard]] bool parse_real(std::string_view word, double& value);
[[nodiscard]] bool parse_integer(std::string_view word, long& value);

}  // namespace lightwalk
