#pragma once
// An ambient cache that also stores its values in an ambient file, which other processes may use at
// the same time.
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/ambient/ambient_cache.h"
#include "core/error.h"
#include "core/transport/options.h"
#include "io/ambient/ambient_fit.h"

namespace lightwalk {

/// A decorator of another cache: each value that is inserted is also appended to the file at once,
/// as a whole record, and values that other processes append are inserted into the cache. The file
/// is locked (fcntl) while it is read or written, as by Radiance's programs.
class AmbientStore final : public AmbientCache {
  public:
    /// Opens or creates the file, and inserts into `cache` those of its values that a run with
    /// `options` can use (see AmbientFit). If the file was made with other options, one warning
    /// names them. A damaged end is reported and cut off. If the file cannot be written, its values
    /// are used, with a warning, and it stays unchanged. Throws InputError for a file that is no
    /// ambient file, is of another version of the format, or cannot be read.
    AmbientStore(const std::string& path, const RenderOptions& options, AmbientCache& cache,
                 WarningSink& warnings);
    ~AmbientStore() override;

    [[nodiscard]] const AmbientLimits& limits() const override { return cache_.limits(); }
    [[nodiscard]] AmbientSum lookup(const AmbientQuery& query, LeakTest leaks) const override {
        return cache_.lookup(query, leaks);
    }
    /// Throws InputError when the file cannot be written.
    void insert(const AmbientRecord& record) override;
    [[nodiscard]] AmbientLogMean log_mean() const override { return cache_.log_mean(); }
    /// Claims hold within this process only, not among those that share the file.
    [[nodiscard]] AmbientClaim claim(const AmbientQuery& query) override {
        return cache_.claim(query);
    }
    void release(const AmbientClaim& claim) override { cache_.release(claim); }

  private:
    class Lock;
    void load(const RenderOptions& options, WarningSink& warnings);
    [[nodiscard]] std::size_t use(const std::vector<AmbientRecord>& records);
    void take_over_appended();

    std::string path_;
    AmbientCache& cache_;
    int file_ = -1;
    bool writable_ = true;
    std::optional<AmbientFit> fit_;  ///< set once the header has been read
    std::mutex mutex_;               ///< guards the file
    std::size_t known_ = 0;          ///< the cache has the records of so many bytes of the file
};

}  // namespace lightwalk
