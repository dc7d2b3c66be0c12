#pragma once
// An ambient cache that also stores its values in an ambient file, which other processes may use at
// the same time.
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/ambient/ambient_cache.h"
#include "core/ambient/ambient_listener.h"
#include "core/error.h"
#include "core/transport/options.h"
#include "io/ambient/ambient_fit.h"

namespace lightwalk {

/// What becomes of values that other processes append to the file.
enum class OthersValues {
    taken,  ///< they are inserted into the cache
    left,   ///< the cache has none that were not in the file when it was opened
};

/// Listens to a cache: each value that is stored there is also appended to the file at once, as a
/// whole record, and values that other processes append may be inserted into the cache. The file is
/// locked (fcntl) while it is read or written, as by Radiance's programs.
class AmbientStore final : public AmbientListener {
  public:
    /// Opens or creates the file, and inserts into `cache` those of its values that a run with
    /// `options` can use (see AmbientFit). If the file was made with other options, one warning
    /// names them. A damaged end is reported and cut off. If the file cannot be written, its values
    /// are used, with a warning, and it stays unchanged. Throws InputError for a file that is no
    /// ambient file, is of another version of the format, or cannot be read.
    /// @param cache  must outlive this
    AmbientStore(const std::string& path, const RenderOptions& options, AmbientCache& cache,
                 WarningSink& warnings, OthersValues others = OthersValues::taken);
    ~AmbientStore() override;
    AmbientStore(const AmbientStore&) = delete;
    AmbientStore& operator=(const AmbientStore&) = delete;

    /// The values that were in the file when it was opened, as the cache has them.
    [[nodiscard]] std::vector<AmbientRecord> take_loaded() { return std::exchange(loaded_, {}); }

    /// Append a value. Throws InputError when the file cannot be written.
    void stored(const AmbientRecord& record, std::span<const Rgb> groups) override;

  private:
    class Lock;
    void load(const RenderOptions& options, WarningSink& warnings);
    [[nodiscard]] std::vector<AmbientRecord> use(const std::vector<AmbientRecord>& records);
    void pass_appended();

    std::string path_;
    AmbientCache& cache_;
    int file_ = -1;
    bool writable_ = true;
    OthersValues others_;
    std::optional<AmbientFit> fit_;  ///< set once the header has been read
    std::mutex mutex_;               ///< guards the file
    std::size_t known_ =
        0;  ///< the file has whole records, which were looked at, up to here [bytes]
    std::vector<AmbientRecord> loaded_;
};

}  // namespace lightwalk
