#pragma once
// A manifest: the files that something was made from, and whether they have changed since.
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "io/files/file_source.h"

namespace lightwalk {

/// The state of a file when it was read, or was looked for and did not exist.
struct ManifestFile {
    std::string path;          ///< absolute
    bool exists = false;       ///< false: the members below have no meaning
    std::uint64_t size = 0;    ///< [bytes]
    std::int64_t written = 0;  ///< date of the last write [ns since 1970]
    std::uint64_t digest = 0;  ///< digest_of_bytes() of the contents
    friend bool operator==(const ManifestFile&, const ManifestFile&) = default;
};

/// A decorator of a source that records the files that were read, and those that were looked for
/// and did not exist, as such a file would be found if it appeared. Standard input and the output
/// of commands are not recorded.
class ManifestRecorder final : public FileSource {
  public:
    explicit ManifestRecorder(std::shared_ptr<FileSource> source = real_files())
        : source_(std::move(source)) {}

    [[nodiscard]] std::optional<std::string> answer(Question question, const std::string& text,
                                                    std::size_t limit) override;
    /// The recorded files, sorted by path.
    [[nodiscard]] std::vector<ManifestFile> files() const;

  private:
    std::shared_ptr<FileSource> source_;
    std::map<std::string, ManifestFile> files_;
};

/// The files of both, sorted by path; of one that is in both the state is that of `base`.
[[nodiscard]] std::vector<ManifestFile> merged_manifest(std::span<const ManifestFile> base,
                                                        std::span<const ManifestFile> added);

/// A phrase for each file that has changed since it was recorded: "room.rad has changed", "sky.cal
/// is missing", "more.cal is new". A file of equal size and date counts as unchanged without being
/// read; of others the digests are compared.
[[nodiscard]] std::vector<std::string> changes_since(std::span<const ManifestFile> files);

}  // namespace lightwalk
