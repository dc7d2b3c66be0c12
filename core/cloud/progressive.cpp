#include "core/cloud/progressive.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/cloud/gaps.h"

namespace lightwalk {
namespace {

/// Neighbours whose difference is a larger share of the brighter one form an edge.
constexpr float kSteep = 0.1f;
constexpr std::size_t kLeastPart = 16;  // of the pixels at edges so many-th part is worth a pass

bool is_step(const Rgb& a, const Rgb& b) {
    const float x = brightness(a), y = brightness(b);
    return std::abs(x - y) > kSteep * std::max(x, y);
}

}  // namespace

void ProgressivePicture::begin(std::span<const Rgb> radiance, std::span<const float> distance,
                               std::span<const PixelOrigin> origins, std::span<const Rgb> groups) {
    radiance_.assign(radiance.begin(), radiance.end());
    distance_.assign(distance.begin(), distance.end());
    origins_.assign(origins.begin(), origins.end());
    groups_.assign(groups.begin(), groups.end());
    with_groups_ = groups.empty() ? 0 : radiance.size();
    choose_edges();
}

void ProgressivePicture::mix(const LightMixture& mixture) {
    const std::size_t count = groups_.size() / radiance_.size();
    for (std::size_t i = 0; i < radiance_.size(); ++i)
        radiance_[i] = mixture.sum(std::span(groups_).subspan(i * count, count));
    choose_edges();
}

ProgressiveWork ProgressivePicture::next(std::size_t most) const {
    ProgressiveWork work = open(most);
    if (!work.places.empty()) return work;
    const auto count = static_cast<std::ptrdiff_t>(std::min(most, edges_.places.size()));
    return {edges_.sample, {edges_.places.begin(), edges_.places.begin() + count}};
}

bool ProgressivePicture::finished() const {
    return !has_open() && edges_.places.empty();
}

bool ProgressivePicture::has_open() const {
    return std::ranges::any_of(
        origins_, [](const PixelOrigin& pixel) { return pixel.kind != PixelOrigin::Kind::traced; });
}

/// All that one pass finds, and no other pass before these are traced: some of them would have
/// blurred others by then, and how many depends on the time there was.
void ProgressivePicture::choose_edges() {
    edges_ = has_open() ? ProgressiveWork{} : steep();
}

std::size_t ProgressivePicture::open_pixels() const {
    return static_cast<std::size_t>(std::count_if(
        origins_.begin(), origins_.end(),
        [](const PixelOrigin& pixel) { return pixel.kind != PixelOrigin::Kind::traced; }));
}

std::size_t ProgressivePicture::guessed_pixels() const {
    return static_cast<std::size_t>(
        std::count_if(origins_.begin(), origins_.end(), [](const PixelOrigin& pixel) {
            return pixel.kind == PixelOrigin::Kind::filled ||
                   pixel.kind == PixelOrigin::Kind::guessed;
        }));
}

std::vector<Rgb> ProgressivePicture::picture() const {
    std::vector<Rgb> shown = radiance_;
    std::vector<std::uint8_t> known;
    known.reserve(origins_.size());
    for (const PixelOrigin& pixel : origins_)
        known.push_back(pixel.kind == PixelOrigin::Kind::filled ? 0 : 1);
    if (std::find(known.begin(), known.end(), 0) != known.end())
        fill_gaps(width_, height_, shown, known);
    return shown;
}

/// Pixels that have not been traced, the most needed first.
ProgressiveWork ProgressivePicture::open(std::size_t most) const {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < origins_.size(); ++i)
        if (origins_[i].kind != PixelOrigin::Kind::traced) found.push_back(i);
    const auto width = static_cast<std::size_t>(width_);
    const auto level = [&](std::size_t i) {
        return origins_[i].kind == PixelOrigin::Kind::filled
                   ? grid_level({static_cast<int>(i % width), static_cast<int>(i / width)})
                   : 0;
    };
    const auto sooner = [&](std::size_t a, std::size_t b) {
        const PixelOrigin &p = origins_[a], &q = origins_[b];
        if (p.kind != q.kind) return p.kind < q.kind;
        if (p.order != q.order) return p.order < q.order;
        const int coarse = level(a), other = level(b);
        return coarse != other ? coarse < other : a < b;
    };
    if (found.size() > most) {
        std::nth_element(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(most),
                         found.end(), sooner);
        found.resize(most);
    }
    std::sort(found.begin(), found.end(), sooner);
    ProgressiveWork work;
    work.places.reserve(found.size());
    for (const std::size_t i : found)
        work.places.push_back({static_cast<int>(i % width), static_cast<int>(i / width)});
    return work;
}

bool ProgressivePicture::is_steep(int x, int y) const {
    const Rgb& own = radiance_[at(x, y)];
    return (x > 0 && is_step(own, radiance_[at(x - 1, y)])) ||
           (x + 1 < width_ && is_step(own, radiance_[at(x + 1, y)])) ||
           (y > 0 && is_step(own, radiance_[at(x, y - 1)])) ||
           (y + 1 < height_ && is_step(own, radiance_[at(x, y + 1)]));
}

/// Of the pixels at edges those that have the fewest rays, if they are not too few: what is chosen
/// takes a pass over the picture, and new edges come up in ones and twos as others get blurred.
ProgressiveWork ProgressivePicture::steep() const {
    std::vector<std::vector<PixelPlace>> by_samples(static_cast<std::size_t>(most_samples_));
    std::size_t all = 0;
    for (int y = 0; y < height_; ++y) {
        for (int x = 0; x < width_; ++x) {
            const int samples = origins_[at(x, y)].samples;
            if (samples >= most_samples_ || !is_steep(x, y)) continue;
            by_samples[static_cast<std::size_t>(samples)].push_back({x, y});
            ++all;
        }
    }
    if (all == 0) return {most_samples_, {}};
    const auto size = [](const std::vector<PixelPlace>& places) { return places.size(); };
    auto chosen = std::ranges::find_if(
        by_samples, [&](std::size_t count) { return count * kLeastPart >= all; }, size);
    if (chosen == by_samples.end()) chosen = std::ranges::max_element(by_samples, {}, size);
    return {static_cast<int>(chosen - by_samples.begin()), std::move(*chosen)};
}

void ProgressivePicture::record(const ProgressiveWork& work,
                                std::span<const std::optional<PixelValue>> traced,
                                std::span<const Rgb> groups) {
    const std::size_t count = traced.empty() ? 0 : groups.size() / traced.size();
    if (groups_.empty()) groups_.resize(radiance_.size() * count);
    for (std::size_t i = 0; i < traced.size(); ++i) {
        if (!traced[i]) continue;
        const std::size_t pixel = at(work.places[i].x, work.places[i].y);
        const auto before = static_cast<float>(work.sample);
        for (std::size_t g = 0; g < count; ++g) {
            Rgb& of_group = groups_[pixel * count + g];
            of_group = (before * of_group + groups[i * count + g]) * (1 / (before + 1));
        }
        if (count > 0 && work.sample == 0) ++with_groups_;
        const Rgb& radiance = traced[i]->radiance;
        radiance_[pixel] = work.sample == 0
                               ? radiance
                               : (before * radiance_[pixel] + radiance) * (1 / (before + 1));
        if (work.sample == 0) distance_[pixel] = traced[i]->distance;
        origins_[pixel] = {PixelOrigin::Kind::traced, static_cast<std::uint8_t>(work.sample + 1),
                           0};
    }
    std::erase_if(edges_.places, [&](const PixelPlace& place) {
        return origins_[at(place.x, place.y)].samples > edges_.sample;
    });
    if (edges_.places.empty()) choose_edges();
}

}  // namespace lightwalk
