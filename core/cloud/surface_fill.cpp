#include "core/cloud/surface_fill.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lightwalk {
namespace {

constexpr std::size_t kRaysAtOnce = 64;  ///< pixels whose rays are cast together
constexpr int kSpacing = 2;              ///< of rays that are cast for sure [pixels]
constexpr int kSquareSide = 8;           ///< of the square that they lie in
constexpr int kFarthest = 16;            ///< coarsest grid of traced pixels [pixels]
constexpr int kEnoughOfSurface = 3;      ///< pixels of the same surface: no coarser grid is needed
constexpr int kLeaf = 2;             ///< grid on which most leaves have no second pixel [pixels]
constexpr float kMostRatio = 4;      ///< of the brightness of patterns
constexpr float kAsFarAway = 0.05f;  ///< relative difference of depth within one surface

/// A weighted mean of colours, and of the patterns that are in them.
struct Mean {
    Rgb sum;
    float weight = 0, patterns = 0;
    int count = 0;

    void add(const Rgb& color, std::uint8_t pattern, float share) {
        sum += color * share;
        weight += share;
        patterns += share * decode_pattern(pattern);
        ++count;
    }
    /// The colour of a place with another pattern: what light does to a surface varies less than
    /// what its pattern does. Where there is hardly any colour to go by, no more than kMostRatio of
    /// it.
    [[nodiscard]] Rgb value(float pattern) const {
        const float ratio =
            weight * pattern < kMostRatio * patterns ? weight * pattern / patterns : kMostRatio;
        return sum * (ratio / weight);
    }
};

/// The known pixels around one, by what they show.
struct Surroundings {
    Mean same, kin, level;  ///< of the same surface; of others that are about as far away: of the
                            ///< same material, of any

    /// Whether no grid of this step or a coarser one is needed. A leaf ends within a few pixels.
    [[nodiscard]] bool tell_enough(int step) const {
        const bool leaf = same.count == 0 && step > kLeaf;
        return (leaf ? kin : same).count >= kEnoughOfSurface;
    }
};

/// Considers the pixels of a grid around a place, 4 x 4 of them.
/// @param step  of the grid [pixels]
void look_around(const CloudFrame& frame, const PixelPlace& place, int step,
                 const PrimaryVisibility& seen, Surroundings& around) {
    const PixelPlace corner{place.x - place.x % step - step, place.y - place.y % step - step};
    for (int y = corner.y; y <= corner.y + 3 * step; y += step) {
        for (int x = corner.x; x <= corner.x + 3 * step; x += step) {
            if (!frame.area.contains({x, y})) continue;
            const std::size_t at = frame.area.index({x, y});
            if (frame.known[at] == 0) continue;
            const auto dx = static_cast<float>(x - place.x), dy = static_cast<float>(y - place.y);
            const float weight = 1 / (dx * dx + dy * dy);
            if (frame.surfaces[at] == seen.surface)
                around.same.add(frame.radiance[at], frame.patterns[at], weight);
            else if (is_kin(frame.surfaces[at], frame.distance[at], seen.surface, seen.distance))
                around.kin.add(frame.radiance[at], frame.patterns[at], weight);
            else if (std::abs(frame.distance[at] - seen.distance) <= kAsFarAway * seen.distance)
                around.level.add(frame.radiance[at], kNoPattern, weight);
        }
    }
}

}  // namespace

std::optional<InferredPixel> infer_pixel(const CloudFrame& frame, const PixelPlace& place,
                                         const PixelVisibility& visibility) {
    const PrimaryVisibility& seen = visibility.ahead.seen ? visibility.ahead : visibility.mirrored;
    if (!visibility.ray || !seen.seen) return std::nullopt;
    Surroundings around;
    for (int step = 1; step <= kFarthest && !around.tell_enough(step); step *= 2)
        look_around(frame, place, step, seen, around);
    const Mean& own = around.same.count > 0 ? around.same : around.kin;
    const bool same = own.count > 0;
    if (!same && around.level.count == 0) return std::nullopt;
    const Rgb radiance = same ? own.value(seen.pattern) : around.level.value(1);
    return InferredPixel{frame.area.index(place), radiance, seen.distance, same};
}

void infer_block(const CloudFrame& frame, const PixelRectangle& block, PixelCaster& caster,
                 int worker, std::vector<InferredPixel>& found) {
    std::array<PixelPlace, kRaysAtOnce> places;
    std::array<PixelVisibility, kRaysAtOnce> visibility;
    std::size_t count = 0;
    const auto infer = [&] {
        caster.probe({places.data(), count}, {true, kSpacing}, {visibility.data(), count}, worker);
        for (std::size_t i = 0; i < count; ++i)
            if (const auto pixel = infer_pixel(frame, places[i], visibility[i]))
                found.push_back(*pixel);
        count = 0;
    };
    for (int y0 = block.y0; y0 < block.y1; y0 += kSquareSide) {
        for (int x0 = block.x0; x0 < block.x1; x0 += kSquareSide) {
            for (int y = y0; y < std::min(y0 + kSquareSide, block.y1); ++y) {
                for (int x = x0; x < std::min(x0 + kSquareSide, block.x1); ++x) {
                    if (frame.known[frame.area.index({x, y})] != 0) continue;
                    places[count++] = {x, y};
                    if (count == kRaysAtOnce) infer();
                }
            }
        }
    }
    if (count > 0) infer();
}

void show_inferred(std::span<const InferredPixel> inferred, CloudFrame& frame) {
    for (const InferredPixel& pixel : inferred) {
        frame.radiance[pixel.at] = pixel.radiance;
        frame.distance[pixel.at] = pixel.distance;
        frame.known[pixel.at] = 1;
        if (pixel.same) ++frame.report.inferred;
        if (!frame.origins.empty()) frame.origins[pixel.at] = {PixelOrigin::Kind::guessed, 0, 0};
    }
}

}  // namespace lightwalk
