#pragma once
// Moving views: paths through key views, and the moves of a walk.
#include <optional>
#include <string>
#include <vector>

#include "core/view/view.h"

namespace lightwalk {

/// A view that a path passes through.
struct ViewKey {
    double time = 0;  ///< [s]
    View view;
};

/// A smooth path through keys: a cubic Hermite spline of all numbers of a view, whose slope at a
/// key is that of the line between its neighbours (Catmull & Rom, "A class of local interpolating
/// splines", 1974, for keys at any times).
class ViewPath {
  public:
    /// What is wrong with the keys; nothing where there is at least one, all have one view type,
    /// and their times rise.
    static std::optional<std::string> problem(const std::vector<ViewKey>& keys);
    explicit ViewPath(std::vector<ViewKey> keys);  ///< throws InputError with problem()

    [[nodiscard]] double begin() const { return keys_.front().time; }  ///< [s]
    [[nodiscard]] double end() const { return keys_.back().time; }     ///< [s]
    /// The view at a time; before the first key and after the last one it stands still.
    [[nodiscard]] View at(double time) const;

  private:
    std::vector<ViewKey> keys_;
};

/// The moves of a walk.
enum class WalkMove { turn, forward, backward, left, right };

/// A view after `steps` steps of a move.
/// @param step      share of the field of view: a turn about the upward axis, to the right, by that
///                  share of its horizontal angle; sideways so far that what is `distance` away
///                  shifts by that share of the picture's width; forward and backward as far as
///                  sideways
/// @param distance  of what the picture's middle shows [m]
[[nodiscard]] View walked_view(const View& view, WalkMove move, double steps, double step,
                               double distance);

/// The view turned to the right about its upward axis [degrees].
[[nodiscard]] View turned_view(const View& view, double degrees);

}  // namespace lightwalk
