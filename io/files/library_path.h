#pragma once
// Where library files are looked for: RAYPATH, then the library that Lightwalk installs.
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/files/file_source.h"

namespace lightwalk {

class LibraryPath {
  public:
    /// From RAYPATH (default: the current directory); the project's own library folder is searched
    /// last.
    static LibraryPath from_environment(std::shared_ptr<FileSource> files = real_files());
    explicit LibraryPath(std::vector<std::string> directories,
                         std::shared_ptr<FileSource> files = real_files());

    /// First readable regular file; nothing when there is none. Names beginning with / or . are not
    /// searched, ~ and ~user are home directories.
    [[nodiscard]] std::optional<std::string> find(const std::string& name) const;
    /// The path to open; throws MissingFile "cannot find KIND \"NAME\" in A:B:C".
    [[nodiscard]] std::string locate(const std::string& name, const std::string& kind) const;
    [[nodiscard]] std::string describe() const;  ///< "A:B:C"
    [[nodiscard]] const std::vector<std::string>& directories() const { return directories_; }
    /// The same path seen from another working directory: relative elements, as they were first
    /// given, are resolved against it. A relative `directory` is relative to the process's.
    [[nodiscard]] LibraryPath relative_to(const std::string& directory) const;
    /// What files are read from.
    [[nodiscard]] FileSource& files() const { return *files_; }
    [[nodiscard]] const std::shared_ptr<FileSource>& shared_files() const { return files_; }
    /// The directory that relative names are seen from; "" is the process's.
    [[nodiscard]] const std::string& base() const { return base_; }

  private:
    std::vector<std::string> directories_;  ///< resolved against base_
    std::vector<std::string> given_;        ///< as they were first given
    std::string base_;
    std::shared_ptr<FileSource> files_;
};

/// Elements of a RAYPATH value: separated by ':'; empty elements are the current directory, a last
/// one is none.
[[nodiscard]] std::vector<std::string> split_search_path(const std::string& value);

/// `path` as seen from `directory`: unchanged when it is absolute or `directory` is "" or ".".
[[nodiscard]] std::string path_from(const std::string& directory, const std::string& path);

/// The directory part of a path: "" when it has none.
[[nodiscard]] std::string directory_of(const std::string& path);

/// Whether `path` is a regular file that can be read: not a terminal or a pipe that would have to
/// be waited for.
[[nodiscard]] bool is_readable_file(const std::string& path);

/// Whole file as bytes; throws InputError when it cannot be read or is larger than `limit` bytes.
[[nodiscard]] std::string read_file(const std::string& path, std::size_t limit = kLargestFile);
/// All that is left of standard input as bytes; throws InputError as read_file does.
[[nodiscard]] std::string read_standard_input(std::size_t limit = kLargestFile);

}  // namespace lightwalk
