#pragma once
// An append-only file of records that stays usable if its writer is killed at any moment.
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "core/error.h"

namespace lightwalk {

/// Layout: the line "lightwalk log 1", the header's lines, an empty line; then records: "LWRC",
/// size of the payload (u64), its FNV-1a hash (u64), the payload. Numbers are little-endian.
class RecordLog {
  public:
    /// Opens or creates the file for appending. An existing file must have the same header; `take`
    /// is called with each of its whole records, in order; a damaged end is reported and cut off.
    /// @param header  lines of text, none of them empty, that say what the records belong to
    /// Throws InputError for a file that is no log, has another header (the first line that differs
    /// is named), is open in another process, or cannot be read or written.
    RecordLog(std::string path, const std::string& header,
              const std::function<void(std::string_view)>& take, WarningSink& warnings);
    ~RecordLog();
    RecordLog(const RecordLog&) = delete;
    RecordLog& operator=(const RecordLog&) = delete;

    /// The whole records of a file, of whatever header; none where it is no log. Throws InputError
    /// for a file that cannot be read.
    static void look_through(const std::string& path,
                             const std::function<void(std::string_view)>& take);

    /// Throws InputError when the file cannot be written.
    void append(std::string_view payload);
    /// Wait until everything appended so far is on the disk.
    void sync();
    /// Delete the file.
    void remove();

  private:
    void start(const std::string& head, const std::string& header,
               const std::function<void(std::string_view)>& take, WarningSink& warnings);

    std::string path_;
    int file_ = -1;
};

/// FNV-1a, 64 bits (Fowler, Noll and Vo; RFC 9923).
[[nodiscard]] std::uint64_t fnv1a(std::string_view bytes);

}  // namespace lightwalk
