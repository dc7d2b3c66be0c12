#include "parallel/refine.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace lightwalk {
namespace {

/// A square between four traced pixels; its sides may be 0 at the picture's edge.
struct Square {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

PixelValue mix(const PixelValue& a, const PixelValue& b, float t) {
    return {a.radiance * (1 - t) + b.radiance * t, a.distance * (1 - t) + b.distance * t};
}

class TileRefiner {
  public:
    TileRefiner(const PixelRectangle& tile, int width, int height, const RefineOptions& options,
                TracePixels trace, StorePixel store)
        : tile_(tile),
          width_(width),
          height_(height),
          options_(options),
          trace_(trace),
          store_(store),
          columns_(tile.width() + 1),
          values_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(tile.height() + 1)),
          wanted_(values_.size(), false) {}

    void run() {
        std::vector<Square> squares = first_squares();
        while (!squares.empty()) {
            trace_wanted();
            std::vector<Square> smaller;
            for (const Square& square : squares) {
                if (is_split(square))
                    split(square, smaller);
                else
                    interpolate(square);
            }
            squares = std::move(smaller);
        }
    }

  private:
    [[nodiscard]] std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y - tile_.y0) * static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(x - tile_.x0);
    }
    [[nodiscard]] std::array<PixelValue, 4> corners(const Square& q) const {
        return {values_[at(q.x0, q.y0)], values_[at(q.x1, q.y0)], values_[at(q.x0, q.y1)],
                values_[at(q.x1, q.y1)]};
    }

    std::vector<Square> first_squares() {
        std::vector<Square> squares;
        for (int y = tile_.y0; y < tile_.y1; y += options_.spacing) {
            for (int x = tile_.x0; x < tile_.x1; x += options_.spacing) {
                squares.push_back({x, y, std::min(x + options_.spacing, width_ - 1),
                                   std::min(y + options_.spacing, height_ - 1)});
                want_corners(squares.back());
            }
        }
        return squares;
    }

    void want(int x, int y) {
        if (wanted_[at(x, y)]) return;
        wanted_[at(x, y)] = true;
        places_.push_back({x, y});
    }
    void want_corners(const Square& q) {
        want(q.x0, q.y0);
        want(q.x1, q.y0);
        want(q.x0, q.y1);
        want(q.x1, q.y1);
    }
    void trace_wanted() {
        traced_.assign(places_.size(), PixelValue{});
        trace_(places_, traced_);
        for (std::size_t i = 0; i < places_.size(); ++i)
            values_[at(places_[i].x, places_[i].y)] = traced_[i];
        places_.clear();
    }

    [[nodiscard]] bool is_split(const Square& q) const {
        return (q.x1 - q.x0 > 1 || q.y1 - q.y0 > 1) && differ(corners(q), options_);
    }

    void split(const Square& q, std::vector<Square>& parts) {
        const bool in_x = q.x1 - q.x0 > 1;
        const bool in_y = q.y1 - q.y0 > 1;
        const int mx = in_x ? (q.x0 + q.x1) / 2 : q.x1;
        const int my = in_y ? (q.y0 + q.y1) / 2 : q.y1;
        const std::size_t first = parts.size();
        parts.push_back({q.x0, q.y0, mx, my});
        if (in_x) parts.push_back({mx, q.y0, q.x1, my});
        if (in_y) parts.push_back({q.x0, my, mx, q.y1});
        if (in_x && in_y) parts.push_back({mx, my, q.x1, q.y1});
        for (std::size_t i = first; i < parts.size(); ++i) want_corners(parts[i]);
    }

    /// One beyond the last pixel that a square from `first` to `last` owns: the edge at `last` is
    /// the next square's, unless the picture ends there before the next square begins.
    [[nodiscard]] int end_of(int first, int last, int end_of_picture) const {
        const bool cut_off = last == end_of_picture && end_of_picture % options_.spacing != 0;
        return first == last || cut_off ? last + 1 : last;
    }

    /// Bilinear between the corners, for the pixels that belong to the square.
    void interpolate(const Square& q) {
        const std::array<PixelValue, 4> c = corners(q);
        const int x_end = end_of(q.x0, q.x1, width_ - 1);
        const int y_end = end_of(q.y0, q.y1, height_ - 1);
        for (int y = q.y0; y < y_end; ++y) {
            const float v =
                y == q.y0 ? 0.0f : static_cast<float>(y - q.y0) / static_cast<float>(q.y1 - q.y0);
            const PixelValue left = mix(c[0], c[2], v);
            const PixelValue right = mix(c[1], c[3], v);
            for (int x = q.x0; x < x_end; ++x) {
                const float u =
                    x == q.x0 ? 0.0f
                              : static_cast<float>(x - q.x0) / static_cast<float>(q.x1 - q.x0);
                store_({x, y}, mix(left, right, u));
            }
        }
    }

    PixelRectangle tile_;
    int width_, height_;
    RefineOptions options_;
    TracePixels trace_;
    StorePixel store_;
    int columns_;                     ///< the tile's and the next one's first, which holds corners
    std::vector<PixelValue> values_;  ///< of traced pixels
    std::vector<bool> wanted_;        ///< traced, or about to be
    std::vector<PixelPlace> places_;
    std::vector<PixelValue> traced_;
};

}  // namespace

int refine_tile_side(int spacing) {
    constexpr int kAbout =
        32;  // corners beyond the upper and right edge cost the less the larger a tile is
    return spacing * std::max(1, kAbout / spacing);
}

bool differ(std::span<const PixelValue> values, const RefineOptions& options) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
        double least = static_cast<double>(values[0].radiance[channel]);
        double most = least;
        for (const PixelValue& value : values.subspan(1)) {
            least = std::min(least, static_cast<double>(value.radiance[channel]));
            most = std::max(most, static_cast<double>(value.radiance[channel]));
        }
        if (most - least > options.threshold * least) return true;
    }
    if (!options.by_distance) return false;
    const auto [nearest, farthest] = std::minmax_element(
        values.begin(), values.end(),
        [](const PixelValue& a, const PixelValue& b) { return a.distance < b.distance; });
    const double near = static_cast<double>(nearest->distance);
    const double far = static_cast<double>(farthest->distance);
    return 2 * (far - near) > options.threshold * (far + near);
}

void refine_tile(const PixelRectangle& tile, int width, int height, const RefineOptions& options,
                 TracePixels trace, StorePixel store) {
    TileRefiner(tile, width, height, options, trace, store).run();
}

}  // namespace lightwalk
