#include "io/net/luminance_plane.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <string_view>

#include "core/math/xyz.h"

namespace lightwalk {
namespace {

constexpr int kPlaneQuality = 95;
constexpr float kMostOctaves = 24;  // of the scale: beyond, the darkest are black
constexpr float kMostGrey = 255;
constexpr float kBlack = -std::numeric_limits<float>::infinity();

/// Bytes of a number, the lowest first.
void append_float(std::string& out, float number) {
    const auto bits = std::bit_cast<std::uint32_t>(number);
    for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>((bits >> shift) & 255);
}

}  // namespace

void LuminancePlane::begin(int width, int height) {
    width_ = width;
    height_ = height;
    columns_ = (width + kSquare - 1) / kSquare;
    rows_ = (height + kSquare - 1) / kSquare;
    const auto squares = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
    logarithms_.resize(squares);
    greys_.resize(squares);
}

void LuminancePlane::measure(std::span<const Rgb> picture, const PixelRectangle& area) {
    for (int y = area.y0; y < area.y1; y += kSquare) {
        const int bottom = std::min(y + kSquare, area.y1);
        for (int x = area.x0; x < area.x1; x += kSquare) {
            const int right = std::min(x + kSquare, area.x1);
            float sum = 0;
            for (int v = y; v < bottom; ++v) {
                const Rgb* row =
                    &picture[static_cast<std::size_t>(v) * static_cast<std::size_t>(width_)];
                for (int u = x; u < right; ++u) sum += brightness(row[u]);
            }
            const float L = kEfficacy * sum / static_cast<float>((right - x) * (bottom - y));
            const bool lit = L > 0 && std::isfinite(L);
            const int square = y / kSquare * columns_ + x / kSquare;
            logarithms_[static_cast<std::size_t>(square)] = lit ? std::log2(L) : kBlack;
        }
    }
}

void LuminancePlane::finish(float white) {
    white_ = white;
    float least = std::numeric_limits<float>::infinity(), most = kBlack;
    for (const float value : logarithms_) {
        if (value == kBlack) continue;
        least = std::min(least, value);
        most = std::max(most, value);
    }
    if (most == kBlack) least = most = 0;
    least = std::max(least, most - kMostOctaves);
    step_ = std::max((most - least) / (kMostGrey - 1), 1.0f / 256);
    low_ = least - step_;  // grey 1 is the darkest
    for (std::size_t i = 0; i < greys_.size(); ++i) {
        const float grey = std::round((logarithms_[i] - low_) / step_);
        greys_[i] = static_cast<std::uint8_t>(std::clamp(grey, 0.0f, kMostGrey));
    }
    std::string key(reinterpret_cast<const char*>(greys_.data()), greys_.size());
    for (const float number : {low_, step_, white_}) append_float(key, number);
    content_ = std::hash<std::string_view>{}(key) | 1;  // 0 means that there is none
}

const std::string& LuminancePlane::bytes(JpegCompressor& compressor) {
    if (coded_ == content_) return bytes_;
    coded_ = content_;
    bytes_.clear();
    if (content_ == 0) return bytes_;
    for (const float number : {low_, step_, white_}) append_float(bytes_, number);
    const std::span<const std::uint8_t> jpeg = compressor.compress_grey(
        {greys_.data(), columns_, rows_, static_cast<std::size_t>(columns_)}, kPlaneQuality);
    bytes_.append(reinterpret_cast<const char*>(jpeg.data()), jpeg.size());
    return bytes_;
}

}  // namespace lightwalk
