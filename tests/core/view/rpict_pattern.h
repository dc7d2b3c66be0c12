#pragma once
// The pattern of pixels that rpict traces with -ps above 1, for comparing counts. It was found by
// observing the program: rays reported by -t agree to 0.5 % in scenes where every ray is a primary
// one.
#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "core/view/refine.h"

namespace lightwalk {

/// Base rows a step apart, from the top, with pixels a step apart; between two of them columns. An
/// interval is halved while its ends differ, or while there were rays in the one before.
class RpictPattern {
  public:
    using Image = std::function<PixelValue(int x, int y)>;
    RpictPattern(const Image& image, int width, int height, const RefineOptions& options)
        : image_(image),
          options_(options),
          width_(width),
          pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)),
          column_step_((140 * options.spacing + 49) / 99),
          row_step_((99 * options.spacing + 70) / 140),
          density_(static_cast<std::size_t>(width / column_step_ + 3), column_step_) {
        int y = height - 1;
        base_row(y);
        while (y > 0) {
            const int below = std::max(y - row_step_, 0);
            base_row(below);
            int budget = y - below;
            for (int x = 0; x < width_; ++x)
                budget = refine(index(x, below), width_, y - below, budget / 2);
            y = below;
        }
    }
    [[nodiscard]] long rays() const { return rays_; }
    [[nodiscard]] const std::vector<PixelValue>& pixels() const { return pixels_; }

  private:
    [[nodiscard]] int index(int x, int y) const { return y * width_ + x; }
    PixelValue& pixel(int i) { return pixels_[static_cast<std::size_t>(i)]; }
    void trace(int i) {
        pixel(i) = image_(i % width_, i / width_);
        ++rays_;
    }

    /// Between `first` and length * stride beyond it; how many were traced.
    int refine(int first, int stride, int length, int budget) {
        if (length <= 1) return 0;
        const int half = length / 2;
        const int middle = first + half * stride;
        const PixelValue& a = pixel(first);
        const PixelValue& b = pixel(first + length * stride);
        const bool is_traced = budget > 0 || differ(std::array{a, b}, options_);
        if (is_traced) {
            trace(middle);
        } else {
            const float t = static_cast<float>(half) / static_cast<float>(length);
            pixel(middle).radiance = a.radiance * (1 - t) + b.radiance * t;
        }
        const int before = refine(first, stride, half, (budget - 1) / 2);
        return (is_traced ? 1 : 0) + before + refine(middle, stride, length - half, budget / 2);
    }

    void base_row(int y) {
        const bool is_odd = ++base_rows_ % 2 == 1;
        trace(index(0, y));
        int previous = 0;
        int count = column_step_;
        int anchor = is_odd ? column_step_ : column_step_ / 2;
        for (std::size_t i = 0;; ++i, anchor += column_step_) {
            anchor = std::min(anchor, width_ - 1);
            trace(index(anchor, y));
            const int budget = column_step_ <= 2 ? count : std::max(density(i), density(i + 1));
            const int before = count;
            count = refine(index(previous, y), 1, anchor - previous, budget / 2);
            if (i < density_.size()) density_[i] = is_odd ? before : count;
            previous = anchor;
            if (anchor == width_ - 1) {
                if (is_odd && i + 1 < density_.size()) density_[i + 1] = count;
                return;
            }
        }
    }
    [[nodiscard]] int density(std::size_t i) const { return i < density_.size() ? density_[i] : 0; }

    const Image& image_;
    const RefineOptions& options_;
    int width_;
    std::vector<PixelValue> pixels_;
    int column_step_, row_step_;
    std::vector<int> density_;  ///< rays in each interval of the base row before
    int base_rows_ = 0;
    long rays_ = 0;
};

}  // namespace lightwalk
