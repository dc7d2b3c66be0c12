#pragma once
// An ambient cache that also stores its values in an ambient file, which other processes may use at
// the same time.
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "core/ambient/ambient_cache.h"
#include "core/ambient/ambient_listener.h"
#include "core/error.h"
#include "core/transport/options.h"
#include "io/ambient/ambient_file.h"
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
    /// @param begun  what `beginning` was in a run that this one goes on with: only the values that
    /// the file had then are loaded, and those that it has got since are not stored once more.
    /// Where the file does not begin like that any more, all are, with a warning. "": nothing goes
    /// on
    AmbientStore(const std::string& path, const RenderOptions& options, AmbientCache& cache,
                 WarningSink& warnings, OthersValues others = OthersValues::taken,
                 const std::string& begun = {});
    ~AmbientStore() override;
    AmbientStore(const AmbientStore&) = delete;
    AmbientStore& operator=(const AmbientStore&) = delete;

    /// The values that were in the file when it was opened, as the cache has them.
    [[nodiscard]] std::vector<AmbientRecord> take_loaded() { return std::exchange(loaded_, {}); }

    /// Says which values are loaded: one word for the length of that part of the file, one for a
    /// hash of it.
    [[nodiscard]] const std::string& beginning() const { return beginning_; }

    /// Append a value. Throws InputError when the file cannot be written.
    void stored(const AmbientRecord& record, std::span<const Rgb> groups) override;

  private:
    class Lock;
    void load(const RenderOptions& options, WarningSink& warnings, const std::string& begun);
    void leave_added(AmbientFile& contents, std::string_view bytes, const std::string& begun);
    void warn_of_difference(std::size_t values, WarningSink& warnings) const;
    void cut_damage(const AmbientFile& contents, WarningSink& warnings) const;
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
    std::string beginning_;
    std::vector<AmbientRecord> loaded_;
    std::unordered_multiset<std::string> added_;  ///< values that the file has got since, encoded
};

}  // namespace lightwalk
