#pragma once
// Radiance's ambient files: values that one run leaves to the next.
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/ambient/ambient_bytes.h"

namespace lightwalk {

/// What an ambient file holds. Whole records up to the first damaged one are taken.
struct AmbientFile {
    std::vector<std::string> header;  ///< without FORMAT
    std::vector<AmbientRecord> records;
    std::size_t size = 0;  ///< bytes up to the end of the last good record
    std::string damage;    ///< what is wrong with the rest; "" where nothing is
};

/// Throws InputError for a file that is none, has not three channels, or is of another version.
[[nodiscard]] AmbientFile decode_ambient_file(std::string_view bytes, const std::string& name);

/// Header and magic number of a new file. `lines` are header lines, without FORMAT and NCOMP.
[[nodiscard]] std::string encode_ambient_header(const std::vector<std::string>& lines);

}  // namespace lightwalk
