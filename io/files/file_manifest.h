#pragma once
// Which files something was made from, and whether they are still the same.
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "io/files/file_source.h"

namespace lightwalk {

/// A file as it was when it was read, or looked for.
struct ManifestFile {
    std::string path;          ///< absolute
    bool exists = false;       ///< else the rest says nothing
    std::uint64_t size = 0;    ///< [bytes]
    std::int64_t written = 0;  ///< [ns] since 1970
    std::uint64_t digest = 0;  ///< digest_of_bytes()
    friend bool operator==(const ManifestFile&, const ManifestFile&) = default;
};

/// Passes on what a source answers, and notes the files that it read, and those that were looked
/// for in vain: where one appears something else may be found. Standard input and the output of
/// commands are not noted.
class ManifestRecorder final : public FileSource {
  public:
    explicit ManifestRecorder(std::shared_ptr<FileSource> source = real_files())
        : source_(std::move(source)) {}

    [[nodiscard]] std::optional<std::string> answer(Question question, const std::string& text,
                                                    std::size_t limit) override;
    /// By path.
    [[nodiscard]] std::vector<ManifestFile> files() const;

  private:
    std::shared_ptr<FileSource> source_;
    std::map<std::string, ManifestFile> files_;
};

/// What has become of them since: "room.rad has changed", "sky.cal is missing", "more.cal is new",
/// a phrase each. A file of the same size and date is not read again; of others the digest decides.
[[nodiscard]] std::vector<std::string> changes_since(std::span<const ManifestFile> files);

}  // namespace lightwalk
