#pragma once
// What the eye is shown of a view that rests: its picture, without the noise that is left.
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "apps/walk/picture_cleaner.h"
#include "core/view/walk_state.h"
#include "io/net/walk_request.h"

namespace lightwalk {

struct LivePicture;

/// Cleans a picture as soon as all of its pixels are traced, and once more when it is as good as it
/// gets; what is better between these is not shown, lest noise comes and goes. An eye that moves
/// drops both. Colours of luminance are of what was traced, always. For one thread.
class CleanView {
  public:
    explicit CleanView(PictureCleaner::Denoise denoise) : cleaner_(std::move(denoise)) {}

    /// The picture as it is by now.
    /// @param rests  whether it is of what is seen
    /// @return       whether something else is to be shown than before
    [[nodiscard]] bool follow(const LivePicture& picture, const DisplayRequest& display,
                              bool rests);
    /// To be shown in place of the picture's; empty: nothing is.
    [[nodiscard]] std::span<const Rgb> radiance() const { return radiance_; }
    /// Whether another one is on its way.
    [[nodiscard]] bool is_coming() const { return cleaner_.is_busy(); }
    /// Why no picture is cleaned any more, once; "": nothing is to be told.
    [[nodiscard]] std::string take_problem();

  private:
    [[nodiscard]] bool drop();

    PictureCleaner cleaner_;
    std::vector<Rgb> radiance_;
    WalkPhase begun_ = WalkPhase::moving;  ///< of the picture that is or was cleaned last
    bool failed_ = false, told_ = false;
};

}  // namespace lightwalk
