#pragma once
// The information header that Radiance's binary files begin with.
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lightwalk {

/// An information header: its lines, the value of FORMAT= ("" when absent), and where the data
/// begin.
struct InfoHeader {
    std::vector<std::string> lines;  ///< without FORMAT
    std::string format;
    std::size_t size = 0;  ///< bytes, with the empty line
};
/// At most 1 MiB; throws InputError when `bytes` does not begin with a header.
[[nodiscard]] InfoHeader decode_header(std::string_view bytes, const std::string& name);
/// Value of a header line "name=value", without blanks around it; nothing when the line is another
/// one.
[[nodiscard]] std::optional<std::string_view> header_variable(std::string_view line,
                                                              std::string_view name);

}  // namespace lightwalk
