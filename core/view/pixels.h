#pragma once
// Types for pixels: places, values and rectangles. In all of them x counts from the left and y from
// the bottom of the picture.
#include <algorithm>
#include <cstddef>

#include "core/math/rgb.h"
#include "core/math/vec3.h"
#include "core/model/ids.h"

namespace lightwalk {

/// Place of a pixel.
struct PixelPlace {
    int x = 0, y = 0;
    friend bool operator==(const PixelPlace&, const PixelPlace&) = default;
};

/// What a pixel shows.
struct PixelValue {
    Rgb radiance;        ///< [W/(m² sr)]
    float distance = 0;  ///< along the pixel's ray [m]; 0 where there is no ray
    friend bool operator==(const PixelValue&, const PixelValue&) = default;
};

/// The first hit of a pixel's ray, for reuse of pixels in later frames.
struct PixelHit {
    bool traced = false;  ///< false: the pixel has no ray of its own, its value is interpolated
    SurfaceId surface = kNoSurface;  ///< a source at infinity, too; kNoSurface: nothing
    ModifierId modifier = kVoid;     ///< the surface's own, which shades it
    Vec3 position;                   ///< world; where nothing finite was met, the ray's origin [m]
    double reflected_path_length = 0;  ///< along the ray to what is seen in a mirror-like surface;
                                       ///< kHuge: nothing is [m]
    Rgb mirrored;                      ///< the reflected part of the pixel's radiance
    friend bool operator==(const PixelHit&, const PixelHit&) = default;
};

/// Pixels x0 <= x < x1, y0 <= y < y1.
struct PixelRectangle {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    [[nodiscard]] int width() const { return x1 - x0; }
    [[nodiscard]] int height() const { return y1 - y0; }
    [[nodiscard]] bool empty() const { return x1 <= x0 || y1 <= y0; }
    /// The number of pixels; 0 for an empty rectangle.
    [[nodiscard]] std::size_t pixels() const {
        return empty() ? 0 : static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
    }
    [[nodiscard]] bool contains(const PixelPlace& place) const {
        return x0 <= place.x && place.x < x1 && y0 <= place.y && place.y < y1;
    }
    /// Index of a pixel inside, row by row from the bottom, left to right.
    [[nodiscard]] std::size_t index(const PixelPlace& place) const {
        return static_cast<std::size_t>(place.y - y0) * static_cast<std::size_t>(width()) +
               static_cast<std::size_t>(place.x - x0);
    }
    friend bool operator==(const PixelRectangle&, const PixelRectangle&) = default;
};

/// The pixels that lie in both; empty where there are none.
[[nodiscard]] inline PixelRectangle intersection(const PixelRectangle& a, const PixelRectangle& b) {
    return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

/// A rectangle with `by` more pixels on each side, inside a picture; empty where it is.
[[nodiscard]] inline PixelRectangle widened(const PixelRectangle& area, int by, int width,
                                            int height) {
    if (area.empty()) return {};
    return intersection({area.x0 - by, area.y0 - by, area.x1 + by, area.y1 + by},
                        {0, 0, width, height});
}

}  // namespace lightwalk
