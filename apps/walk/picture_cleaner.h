#pragma once
// Pictures for the eye, made beside those that are traced.
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "io/picture/picture.h"

namespace lightwalk {

/// Denoises one picture at a time, the newest, on a thread of its own: who
/// draws never waits for it. Its functions are for one thread.
class PictureCleaner {
  public:
    /// Replaces a picture's radiance. Asks now and then whether to go on; false:
    /// it did not. Throws InputError. Called by the cleaner's thread only.
    using Denoise = std::function<bool(Picture& picture, const std::function<bool()>& goes_on)>;

    explicit PictureCleaner(Denoise denoise);
    /// Gives up what is under way, and waits until that is over.
    ~PictureCleaner();
    PictureCleaner(const PictureCleaner&) = delete;
    PictureCleaner& operator=(const PictureCleaner&) = delete;

    /// Clean this picture in place of any other one.
    void begin(Picture picture);
    /// Whatever was begun is not wanted any more; take() will not return it.
    void give_up();
    /// Whether something was begun, and neither taken nor given up.
    [[nodiscard]] bool is_busy() const;
    /// The radiance of what was begun, once it is clean; each is returned once.
    [[nodiscard]] std::optional<std::vector<Rgb>> take();
    /// Why it cannot clean pictures; "": it can, as far as is known. Then nothing
    /// is busy any more.
    [[nodiscard]] std::string problem() const;

  private:
    void work();
    [[nodiscard]] bool is_wanted(std::uint64_t number) const;

    Denoise denoise_;
    mutable std::mutex mutex_;
    std::condition_variable news_;
    std::uint64_t begun_ = 0;  ///< number of the newest picture
    bool wanted_ = false;      ///< it is
    bool ends_ = false;
    std::optional<Picture> next_;            ///< waits for the thread
    std::optional<std::vector<Rgb>> clean_;  ///< of the newest picture
    std::string problem_;
    std::thread thread_;  ///< last: it uses the others
};

}  // namespace lightwalk
