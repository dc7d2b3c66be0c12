#pragma once
// Radiance's ambient files: values that one run leaves to the next.
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/ambient/ambient_bytes.h"

namespace lightwalk {

/// The contents of an ambient file: all whole records up to the first damaged one.
struct AmbientFile {
    std::vector<std::string> header;  ///< the header's lines but FORMAT
    std::vector<AmbientRecord> records;
    std::size_t size = 0;  ///< length up to the end of the last whole record [bytes]
    std::string damage;    ///< what is wrong with the bytes after that; "" for an undamaged file
};

/// Throws InputError for bytes that are no ambient file, have not three channels, or are of another
/// version of the format.
[[nodiscard]] AmbientFile decode_ambient_file(std::string_view bytes, const std::string& name);

/// The header and the magic number of a new ambient file. `lines` are the header's lines without
/// FORMAT and NCOMP.
[[nodiscard]] std::string encode_ambient_header(const std::vector<std::string>& lines);

}  // namespace lightwalk
