#pragma once
// The search path of library files: RAYPATH, then the library folder that Lightwalk installs.
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/files/file_source.h"

namespace lightwalk {

class LibraryPath {
  public:
    /// The path in the environment variable RAYPATH (default: the current directory), and after it
    /// Lightwalk's own library folder.
    static LibraryPath from_environment(std::shared_ptr<FileSource> files = real_files());
    explicit LibraryPath(std::vector<std::string> directories,
                         std::shared_ptr<FileSource> files = real_files());

    /// The first readable regular file of this name along the path; nothing when there is none. A
    /// file that a generator has made, and the source keeps, comes first.
    /// Names that begin with / or . are not searched for; ~ and ~user are home directories.
    [[nodiscard]] std::optional<std::string> find(const std::string& name) const;
    /// The result of find(); throws MissingFile "cannot find KIND \"NAME\" in A:B:C" when there is
    /// none.
    [[nodiscard]] std::string locate(const std::string& name, const std::string& kind) const;
    [[nodiscard]] std::string describe() const;  ///< "A:B:C"
    [[nodiscard]] const std::vector<std::string>& directories() const { return directories_; }
    /// This search path for another working directory: its relative elements, as they were first
    /// given, are resolved against `directory`, which may be relative to that of the process.
    [[nodiscard]] LibraryPath relative_to(const std::string& directory) const;
    /// The source that files are read from.
    [[nodiscard]] FileSource& files() const { return *files_; }
    [[nodiscard]] const std::shared_ptr<FileSource>& shared_files() const { return files_; }
    /// The directory that relative names are resolved against; "" is the process's.
    [[nodiscard]] const std::string& base() const { return base_; }

  private:
    std::vector<std::string> directories_;  ///< resolved against base_
    std::vector<std::string> given_;        ///< as they were first given
    std::string base_;
    std::shared_ptr<FileSource> files_;
};

/// The elements of a RAYPATH value, which are separated by ':'. An empty element is the current
/// directory, except at the end, where it is ignored.
[[nodiscard]] std::vector<std::string> split_search_path(const std::string& value);

/// `path` resolved against `directory`: unchanged when it is absolute or `directory` is "" or ".".
[[nodiscard]] std::string path_from(const std::string& directory, const std::string& path);

/// The directory part of a path; "" when it has none.
[[nodiscard]] std::string directory_of(const std::string& path);

/// Whether `path` is a regular file that can be read; terminals and pipes, whose reading may block,
/// are not.
[[nodiscard]] bool is_readable_file(const std::string& path);

/// The bytes of a file; throws InputError when it cannot be read or is larger than `limit` bytes.
[[nodiscard]] std::string read_file(const std::string& path, std::size_t limit = kLargestFile);
/// The bytes of the rest of standard input; throws InputError as read_file does.
[[nodiscard]] std::string read_standard_input(std::size_t limit = kLargestFile);

}  // namespace lightwalk
