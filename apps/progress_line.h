#pragma once
// What a terminal's line says of a picture that is being made.
#include <optional>
#include <string>

namespace lightwalk {

struct ProgressState {
    double done = 0;  ///< share of the work, 0 ... 1
    double rays_per_second = 0;
    std::optional<double> seconds_left;  ///< nothing: not known yet
};

/// A bar, the share done, the speed and the time left, in at most columns - 1 characters, because
/// terminals wrap what fills their last column. What does not fit is left out: the speed first,
/// then the bar, then the time.
[[nodiscard]] std::string progress_line(const ProgressState& state, int columns);

/// Hours, minutes and seconds: "0:07", "12:30", "1:00:00".
[[nodiscard]] std::string time_text(double seconds);

}  // namespace lightwalk
