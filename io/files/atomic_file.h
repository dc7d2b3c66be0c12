#pragma once
// Files that appear whole or not at all.
#include <span>
#include <string>
#include <string_view>

namespace lightwalk {

/// Any bytes, whole or not at all: a temporary file in the same folder is renamed when it is
/// complete, and removed when that fails. Links are followed; devices and pipes are written to
/// directly. Throws InputError.
void write_file_atomically(const std::string& path, std::string_view bytes);
/// The same for bytes in pieces, one after the other.
void write_file_atomically(const std::string& path, std::span<const std::string_view> pieces);

}  // namespace lightwalk
