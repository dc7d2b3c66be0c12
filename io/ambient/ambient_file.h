#pragma once
// Radiance's ambient files: values that one run leaves to the next.
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/ambient/ambient_record.h"

namespace lightwalk {

inline constexpr std::size_t kAmbientRecordSize = 67;  ///< bytes, with three channels

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
/// 67 bytes.
[[nodiscard]] std::string encode_ambient_record(const AmbientRecord& record);

}  // namespace lightwalk
