#pragma once
// The information header at the beginning of Radiance's binary files.
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lightwalk {

/// A decoded information header.
struct InfoHeader {
    std::vector<std::string> lines;  ///< all lines but FORMAT
    std::string format;              ///< the value of FORMAT=; "" when there is no such line
    std::size_t size = 0;  ///< length with the empty line at the end: where the data begin [bytes]
};
/// Decode the header that `bytes` begin with; throws InputError when they do not begin with one of
/// at most 1 MiB.
[[nodiscard]] InfoHeader decode_header(std::string_view bytes, const std::string& name);
/// The value in a header line "name=value", without blanks around it; nothing when the line has
/// another name or none.
[[nodiscard]] std::optional<std::string_view> header_variable(std::string_view line,
                                                              std::string_view name);

}  // namespace lightwalk
