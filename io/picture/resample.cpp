#include "io/picture/resample.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace lightwalk {
namespace {

/// The pixels that a new one is the mean of, along one axis.
struct Taps {
    int first = 0;
    std::vector<double> weights;  ///< of sum 1
};

Taps box_taps(int place, int size, int new_size) {
    const double ratio = static_cast<double>(size) / new_size;
    const auto begin = [&](int i) { return static_cast<int>(std::ceil(i * ratio - 1e-9)); };
    const int first = begin(place), count = std::min(begin(place + 1), size) - first;
    if (count > 0) {
        const auto n = static_cast<std::size_t>(count);
        return {first, std::vector<double>(n, 1.0 / count)};
    }
    const int middle = static_cast<int>((place + .5) * ratio);
    return {std::min(middle, size - 1), {1}};
}

Taps gaussian_taps(int place, int size, int new_size, double radius) {
    constexpr double kReach = 2.2;  ///< radii
    // Where new pixels are smaller than the old ones the filter does not become narrower.
    const double ratio = std::max(1.0, static_cast<double>(size) / new_size);
    const double middle = (place + .5) * size / new_size;
    const int reach = std::max(1, static_cast<int>(std::lround(kReach * radius * ratio)));
    const int centre = static_cast<int>(middle);
    Taps taps;
    taps.first = std::max(0, centre - reach);
    const int last = std::min(size - 1, centre + reach);
    taps.weights.reserve(static_cast<std::size_t>(std::max(0, last - taps.first + 1)));
    double sum = 0;
    for (int i = taps.first; i <= last; ++i) {
        const double distance = (i + .5 - middle) / (ratio * radius);
        taps.weights.push_back(std::exp(-distance * distance));
        sum += taps.weights.back();
    }
    for (double& weight : taps.weights) weight /= sum;
    return taps;
}

std::vector<Taps> taps_along(int size, int new_size, double radius) {
    std::vector<Taps> all;
    all.reserve(static_cast<std::size_t>(new_size));
    for (int i = 0; i < new_size; ++i)
        all.push_back(radius > 0 ? gaussian_taps(i, size, new_size, radius)
                                 : box_taps(i, size, new_size));
    return all;
}

/// Means of runs of pixels that are `stride` apart.
Rgb mean_of(const Taps& taps, const Rgb* pixels, std::size_t stride) {
    double r = 0, g = 0, b = 0;
    const Rgb* p = pixels + static_cast<std::size_t>(taps.first) * stride;
    for (const double weight : taps.weights) {
        r += weight * static_cast<double>(p->r);
        g += weight * static_cast<double>(p->g);
        b += weight * static_cast<double>(p->b);
        p += stride;
    }
    return {static_cast<float>(r), static_cast<float>(g), static_cast<float>(b)};
}

}  // namespace

Picture resampled(const Picture& picture, int width, int height, double radius) {
    const std::vector<Taps> columns = taps_along(picture.width, width, radius);
    const std::vector<Taps> rows = taps_along(picture.height, height, radius);
    const auto old_width = static_cast<std::size_t>(picture.width);
    Picture narrow{width, picture.height, {}};
    narrow.pixels.reserve(static_cast<std::size_t>(width) *
                          static_cast<std::size_t>(picture.height));
    for (std::size_t y = 0; y < static_cast<std::size_t>(picture.height); ++y)
        for (const Taps& taps : columns)
            narrow.pixels.push_back(mean_of(taps, &picture.pixels[y * old_width], 1));
    Picture result{width, height, {}};
    result.pixels.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (const Taps& taps : rows)
        for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x)
            result.pixels.push_back(
                mean_of(taps, &narrow.pixels[x], static_cast<std::size_t>(width)));
    return result;
}

}  // namespace lightwalk
