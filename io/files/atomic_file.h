#pragma once
// Atomic writes: a file appears whole or not at all.
#include <span>
#include <string>
#include <string_view>

namespace lightwalk {

/// Writes a file atomically: a temporary file in the same folder is renamed when it is complete,
/// and removed when that fails. Links are followed; devices and pipes are written to directly, and
/// /dev/stdout, /dev/fd/N by the descriptor that is open already. Throws InputError.
void write_file_atomically(const std::string& path, std::string_view bytes);
/// Writes the concatenation of `pieces` atomically.
void write_file_atomically(const std::string& path, std::span<const std::string_view> pieces);

/// Throws InputError where write_file_atomically() could not begin: for those who work for long
/// before they write. Leaves nothing behind.
void check_writable(const std::string& path);

}  // namespace lightwalk
