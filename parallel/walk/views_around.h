#pragma once
// What an eye that rests will see once it turns.
#include <cstddef>
#include <optional>
#include <vector>

#include "core/view/view.h"

namespace lightwalk {

/// A view beside one that rests, to be drawn for its points.
struct ViewAside {
    View view;
    double share = 1;  ///< of the resting picture's width and height
};

/// The views around one that rests, one after the other, those beside it first; each is drawn again
/// until hardly any of its pixels is unknown. First roughly, as soon as the resting picture is
/// recognised, since an eye that comes to rest often turns at once; as sharp as a moving eye sees
/// them once the resting picture is all there.
class ViewsAround {
  public:
    ViewsAround() = default;
    /// Perspective views only, of others points do not outlive a turn: then there are none.
    explicit ViewsAround(const View& view);

    /// Whether what an eye of this view sees when it turns is among them, or was.
    [[nodiscard]] bool hold(const View& view) const;
    /// The one to draw next; nothing: not now, or no more.
    /// @param traced  share of the resting picture's pixels
    /// @param done    whether nothing of it is left to be done, but smoother edges
    [[nodiscard]] std::optional<ViewAside> next(double traced, bool done) const;
    /// It was drawn.
    /// @param unknown  share of its pixels that there was no time for
    /// @param seconds  that it took
    void record(double unknown, double seconds);

  private:
    View home_;
    std::vector<View> views_;
    std::size_t round_ = 0, at_ = 0;  ///< at_: of views_
    double seconds_ = 0;              ///< of this round
};

}  // namespace lightwalk
