#include "core/glare/pixel_contour.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace lightwalk {
namespace {

/// Which pixels of a rectangle are set.
class PixelMask {
  public:
    explicit PixelMask(const PixelRectangle& rectangle)
        : rectangle_(rectangle), set_(rectangle.pixels(), 0) {}
    [[nodiscard]] const PixelRectangle& rectangle() const { return rectangle_; }
    [[nodiscard]] bool at(int x, int y) const {
        return rectangle_.contains({x, y}) && set_[index(x, y)] != 0;
    }
    void set(int x, int y) { set_[index(x, y)] = 1; }
    void clear(int x, int y) { set_[index(x, y)] = 0; }

  private:
    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y - rectangle_.y0) *
                   static_cast<std::size_t>(rectangle_.width()) +
               static_cast<std::size_t>(x - rectangle_.x0);
    }
    PixelRectangle rectangle_;
    std::vector<std::uint8_t> set_;
};

PixelMask mask_of(std::span<const PixelPlace> places) {
    PixelRectangle around{places[0].x, places[0].y, places[0].x + 1, places[0].y + 1};
    for (const PixelPlace& p : places) {
        around = {std::min(around.x0, p.x), std::min(around.y0, p.y), std::max(around.x1, p.x + 1),
                  std::max(around.y1, p.y + 1)};
    }
    PixelMask mask(around);
    for (const PixelPlace& p : places) mask.set(p.x, p.y);
    return mask;
}

/// Calls visit(x, y) for each pixel that is set, row by row from the bottom.
template <class Visit>
void for_each_set(const PixelMask& mask, const Visit& visit) {
    const PixelRectangle& r = mask.rectangle();
    for (int y = r.y0; y < r.y1; ++y) {
        for (int x = r.x0; x < r.x1; ++x) {
            if (mask.at(x, y)) visit(x, y);
        }
    }
}

/// The mask widened by the eight neighbours of each pixel (morphological dilation).
PixelMask widened(const PixelMask& mask) {
    const PixelRectangle& r = mask.rectangle();
    PixelMask wide({r.x0 - 1, r.y0 - 1, r.x1 + 1, r.y1 + 1});
    for_each_set(mask, [&](int x, int y) {
        for (int k = 0; k < 9; ++k) wide.set(x + k % 3 - 1, y + k / 3 - 1);
    });
    return wide;
}

/// The first pixel of the lowest row, which is not empty.
PixelPlace lowest(const PixelMask& mask) {
    const PixelRectangle& r = mask.rectangle();
    int x = r.x0;  // the lowest row of the rectangle has a pixel, or it would be smaller
    while (!mask.at(x, r.y0)) ++x;
    return {x, r.y0};
}

/// Whether all pixels are connected, by edges or corners.
bool hangs_together(PixelMask mask) {
    std::vector<PixelPlace> open{lowest(mask)};
    mask.clear(open[0].x, open[0].y);
    while (!open.empty()) {
        const PixelPlace p = open.back();
        open.pop_back();
        for (int k = 0; k < 9; ++k) {
            const PixelPlace next{p.x + k % 3 - 1, p.y + k / 3 - 1};
            if (!mask.at(next.x, next.y)) continue;
            mask.clear(next.x, next.y);
            open.push_back(next);
        }
    }
    bool all = true;
    for_each_set(mask, [&](int, int) { all = false; });
    return all;
}

struct Heading {
    int dx, dy;
    PixelPlace left, right;  ///< the pixels ahead, from the corner where one stands
};
/// East, north, west, south: each a left turn from the one before.
constexpr std::array<Heading, 4> kHeadings{{{1, 0, {0, 0}, {0, -1}},
                                            {0, 1, {-1, 0}, {0, 0}},
                                            {-1, 0, {-1, -1}, {-1, 0}},
                                            {0, -1, {0, -1}, {-1, -1}}}};

/// Walks along the outer edge with the pixels to the left.
std::vector<PixelPlace> walk_edge(const PixelMask& mask) {
    const PixelPlace start = lowest(mask);
    std::vector<PixelPlace> corners;
    PixelPlace at = start;
    std::size_t heading = 0;  // nothing lies below the start, so its lower edge is on the outside
    do {
        corners.push_back(at);
        at = {at.x + kHeadings[heading].dx, at.y + kHeadings[heading].dy};
        const Heading& h = kHeadings[heading];
        if (mask.at(at.x + h.right.x, at.y + h.right.y))
            heading = (heading + 3) % 4;
        else if (!mask.at(at.x + h.left.x, at.y + h.left.y))
            heading = (heading + 1) % 4;
    } while (at != start || heading != 0);
    return corners;
}

}  // namespace

std::vector<PixelPlace> pixel_contour(std::span<const PixelPlace> places) {
    if (places.empty()) return {};
    PixelMask mask = mask_of(places);
    while (!hangs_together(mask)) mask = widened(mask);
    return walk_edge(mask);
}

}  // namespace lightwalk
