#pragma once
// The line of a Radiance picture that says how large it is and in which order its pixels stand.
#include <cstddef>
#include <string>
#include <string_view>

#include "core/error.h"

namespace lightwalk {

/// "bad picture file: PROBLEM" of a file.
[[nodiscard]] InputError bad_picture(const std::string& name, const std::string& problem);

/// Size and order of the scanlines. x counts to the right, y upward.
struct PictureResolution {
    int width = 0, height = 0;
    bool columns = false;  ///< scanlines are columns
    bool x_falling = false, y_falling = false;

    [[nodiscard]] int scanlines() const { return columns ? width : height; }
    [[nodiscard]] int length() const { return columns ? height : width; }
    [[nodiscard]] bool standard() const { return !columns && !x_falling && y_falling; }
    /// Where the pixel of a row (from the top) and a column stands among the stored ones.
    [[nodiscard]] std::size_t stored_index(std::size_t row, std::size_t column) const {
        const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
        const std::size_t y = y_falling ? row : h - 1 - row;
        const std::size_t x = x_falling ? w - 1 - column : column;
        return columns ? x * h + y : y * w + x;
    }
};

/// Remove a line like "-Y 480 +X 640" from the front of `bytes`: the first axis counts scanlines,
/// the second runs along them. Throws InputError.
[[nodiscard]] PictureResolution take_resolution(std::string_view& bytes, const std::string& name);

}  // namespace lightwalk
