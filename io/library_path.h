#pragma once
// Where library files are looked for: RAYPATH, then the library that Lightwalk installs.
#include <optional>
#include <string>
#include <vector>

namespace lightwalk {

class LibraryPath {
  public:
    /// From RAYPATH (default: the current directory); the project's own library folder is searched last.
    static LibraryPath from_environment();
    explicit LibraryPath(std::vector<std::string> directories) : directories_(std::move(directories)) {}

    /// First readable regular file; nothing when there is none. Names beginning with / or . are not searched,
    /// ~ and ~user are home directories.
    [[nodiscard]] std::optional<std::string> find(const std::string& name) const;
    /// The path to open; throws InputError "cannot find KIND \"NAME\" in A:B:C".
    [[nodiscard]] std::string locate(const std::string& name, const std::string& kind) const;
    [[nodiscard]] std::string describe() const;  ///< "A:B:C"
    [[nodiscard]] const std::vector<std::string>& directories() const { return directories_; }
    /// The same path seen from another working directory: relative elements are resolved against it.
    [[nodiscard]] LibraryPath relative_to(const std::string& directory) const;

  private:
    std::vector<std::string> directories_;
};

/// Whole file as bytes; throws InputError when it cannot be read or is larger than `limit` bytes.
[[nodiscard]] std::string read_file(const std::string& path, std::size_t limit = std::size_t{1} << 30);

}  // namespace lightwalk
