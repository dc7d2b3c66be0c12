#pragma once
// What is known of a walk's picture, kept for the ranks that may have to begin anew.
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "io/files/watched_files.h"
#include "parallel/walk/known_picture.h"

namespace lightwalk {

/// A file that one process writes now and then, and the next one reads.
class KeptPicture {
  public:
    /// @param scene  the files that it is made of, as they were read
    KeptPicture(std::string path, const FileStates& scene);

    /// Nothing: there is none, or none of this scene, or somebody died while it was written.
    [[nodiscard]] std::optional<KnownPicture> read() const;
    /// In place of the one before; not one that is too large, or where the file cannot be.
    void write(KnownPicture& known) const;

  private:
    std::string path_;
    std::uint64_t scene_;  ///< a digest
};

/// The one whose path kWalkKept says; null: none, as this is no run of `lightwalk launch`.
[[nodiscard]] std::shared_ptr<const KeptPicture> kept_picture(const FileStates& scene);

}  // namespace lightwalk
