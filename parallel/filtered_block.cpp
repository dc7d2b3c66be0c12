#include "parallel/filtered_block.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/view/pixel_samples.h"
#include "parallel/block_renderer.h"

namespace lightwalk {

FilteredBlock::FilteredBlock(const PixelRays& rays, const FrameOptions& options,
                             const PixelRectangle& block, std::size_t groups)
    : rays_(rays),
      options_(options),
      filter_(options.pixels.filter),
      reach_(pixel_filter_reach(filter_)),
      farthest_(reached_pixels(filter_)),
      side_(2 * farthest_ + 1),
      block_(block),
      around_{block.x0 - farthest_, block.y0 - farthest_, block.x1 + farthest_,
              block.y1 + farthest_},
      groups_(groups),
      layers_(1 + (options.hits ? 1 : 0) + groups),
      weights_(around_.pixels() * reached()),
      sums_(around_.pixels() * reached() * layers_),
      nearest_(block.pixels(), std::numeric_limits<double>::infinity()),
      layer_values_(layers_) {}

FilteredBlock::Sample FilteredBlock::sample_at(const PixelPlace& place, int sample) const {
    const PixelRays::Place at = rays_.place(place.x, place.y, sample);
    return {place, {at.h * options_.width - place.x - 0.5, at.v * options_.height - place.y - 0.5}};
}

/// Whether a pixel of the block reaches the sample.
bool FilteredBlock::counts(const Sample& sample) const {
    const double x = sample.place.x + sample.offset.x, y = sample.place.y + sample.offset.y;
    return x > block_.x0 - reach_ && x < block_.x1 - 1 + reach_ && y > block_.y0 - reach_ &&
           y < block_.y1 - 1 + reach_ && (options_.tiles == nullptr || reaches(x, y, reach_));
}

bool FilteredBlock::reaches(double x, double y, double reach) const {
    const PixelRectangle within{
        static_cast<int>(std::floor(x - reach)) + 1, static_cast<int>(std::floor(y - reach)) + 1,
        static_cast<int>(std::ceil(x + reach)), static_cast<int>(std::ceil(y + reach))};
    return options_.tiles->meets(intersection(within, block_));
}

void FilteredBlock::trace(PixelTracer& trace, const PixelRectangle& packet, int sample,
                          BlockPixels& pixels) {
    places_.clear();
    samples_.clear();
    for (int y = packet.y1; y-- > packet.y0;) {  // from the top
        for (int x = packet.x0; x < packet.x1; ++x) {
            if (options_.tiles != nullptr && !reaches(x, y, reach_ + 0.5)) continue;
            const Sample at = sample_at({x, y}, sample);
            if (!counts(at)) continue;
            places_.push_back(at.place);
            samples_.push_back(at);
        }
    }
    values_.resize(places_.size());
    hits_.resize(options_.hits ? places_.size() : 0);
    trace.trace_one(sample, places_, values_, hits_);
    for (std::size_t i = 0; i < samples_.size(); ++i) {
        const PixelHit* const hit = options_.hits ? &hits_[i] : nullptr;
        auto layer = layer_values_.begin();
        *layer++ = values_[i].radiance;
        if (hit) *layer++ = hit->mirrored;
        const std::span<const Rgb> groups = trace.groups(i);
        std::copy(groups.begin(), groups.end(), layer);
        keep_nearest(samples_[i], values_[i], hit, pixels);
        add(samples_[i]);
    }
}

void FilteredBlock::keep_nearest(const Sample& sample, const PixelValue& value, const PixelHit* hit,
                                 BlockPixels& pixels) {
    if (!block_.contains(sample.place)) return;
    const std::size_t at = block_.index(sample.place);
    const PixelOffset& off = sample.offset;
    const double squared = off.x * off.x + off.y * off.y;
    if (!(squared < nearest_[at])) return;
    nearest_[at] = squared;
    pixels.values[at].distance = value.distance;
    if (hit) pixels.hits[at] = *hit;
}

/// Adds layer_values_ to what the sample's pixel sends to those around it.
void FilteredBlock::add(const Sample& sample) {
    std::array<double, 2 * kFarthest + 1> across{}, up{};
    const auto side = static_cast<std::size_t>(side_);
    for (std::size_t k = 0; k < side; ++k) {
        const int step = static_cast<int>(k) - farthest_;
        across[k] = pixel_filter(filter_, sample.offset.x - step);
        up[k] = pixel_filter(filter_, sample.offset.y - step);
    }
    const std::size_t first = around_.index(sample.place) * reached();
    for (std::size_t k = 0; k < reached(); ++k) {
        const auto weight = static_cast<float>(up[k / side] * across[k % side]);
        if (weight == 0) continue;
        weights_[first + k] += weight;
        Rgb* sum = &sums_[(first + k) * layers_];
        for (const Rgb& value : layer_values_) *sum++ += value * weight;
    }
}

/// Sets `sums`, one a layer, to the pixel's filtered values.
void FilteredBlock::sum_up(const PixelPlace& place, std::span<Rgb> sums) const {
    std::fill(sums.begin(), sums.end(), Rgb{});
    float weight = 0;
    const int count = side_ * side_;
    for (int k = 0; k < count; ++k) {
        // The k-th pixel around this one, for which this one is the last but k.
        const PixelPlace from{place.x + k % side_ - farthest_, place.y + k / side_ - farthest_};
        const std::size_t sent =
            around_.index(from) * reached() + static_cast<std::size_t>(count - 1 - k);
        weight += weights_[sent];
        for (std::size_t layer = 0; layer < layers_; ++layer)
            sums[layer] += sums_[sent * layers_ + layer];
    }
    const float share = 1 / weight;
    for (Rgb& sum : sums) sum *= share;
    if (!has_negative_weights(filter_) || options_.tiles != nullptr) return;
    std::ranges::transform(sums, sums.begin(), positive_part);
}

void FilteredBlock::gather(BlockPixels& pixels) const {
    std::vector<Rgb> sums(layers_);
    for (std::size_t at = 0; at < block_.pixels(); ++at) {
        const auto width = static_cast<std::size_t>(block_.width());
        const PixelPlace place{block_.x0 + static_cast<int>(at % width),
                               block_.y0 + static_cast<int>(at / width)};
        if (options_.tiles != nullptr &&
            !options_.tiles->meets({place.x, place.y, place.x + 1, place.y + 1}))
            continue;
        sum_up(place, sums);
        auto layer = sums.cbegin();
        pixels.values[at].radiance = *layer++;
        if (options_.hits) pixels.hits[at].mirrored = *layer++;
        std::copy(layer, sums.cend(), pixels.groups.data() + at * groups_);
    }
}

}  // namespace lightwalk
