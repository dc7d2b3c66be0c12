#pragma once
// A cache that keeps its values in an ambient file, which other processes may use at the same time.
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

/// Stands before another cache: what is stored there goes to the file as well, in whole records, at
/// once; what other processes append is taken over. The file is locked (fcntl) while it is read or
/// written, as Radiance's programs do.
class AmbientStore final : public AmbientCache {
  public:
    /// Opens or makes the file, and fills `cache` with those of its values that serve under
    /// `options` (see AmbientFit); one warning says which options the file was made with, where
    /// they are others. A damaged end is reported and cut off. Where the file cannot be written its
    /// values are used, with a warning, and it stays as it is. Throws InputError for a file that is
    /// none, is of another version of the format, or cannot be read.
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
    /// Within this process.
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
    std::optional<AmbientFit> fit_;  ///< set from the header on
    std::mutex mutex_;               ///< guards the file
    std::size_t known_ = 0;          ///< bytes of the file that are in the cache
};

}  // namespace lightwalk
