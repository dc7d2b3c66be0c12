#include "parallel/block_renderer.h"

#include <algorithm>
#include <array>

#include "core/transport/light_groups.h"
#include "core/view/refine.h"
#include "parallel/filtered_block.h"

namespace lightwalk {
namespace {

constexpr int kPacketSide = 8;  ///< pixels traced together when every pixel is traced
/// Side of blocks whose pixels share samples: a block traces those around it again. With a Gaussian
/// they are .8 pixels wide, a tenth of its own at this size, a twentieth at the largest that
/// block_side() makes; with Mitchell's filter 1.5, twice as many.
constexpr int kSharingSide = 32;

/// Neighbours are there where every pixel is traced.
SampleUse sample_use(const FrameOptions& options) {
    const bool all = options.pixels.spacing == 1 && options.step == 1;
    const PixelOptions& pixels = options.pixels;
    return all && pixels.share_samples && pixels.samples > 1 ? SampleUse::shared : SampleUse::own;
}

}  // namespace

BlockRenderer::BlockRenderer(const Tracer& tracer, const Camera& camera,
                             const FrameOptions& options, WorkerContexts& contexts,
                             const StopFlag& stop)
    : tracer_(tracer),
      options_(options),
      rays_(camera, options.previous, options.width, options.height, options.pixels, options.seed,
            options.step, sample_use(options)),
      contexts_(contexts),
      stop_(stop) {
    // With several samples rays find small sources; drawing them as well would count them twice.
    if (rays_.pinhole() && options.step == 1 && options.pixels.samples == 1)
        small_sources_.emplace(tracer, camera, options.width, options.height,
                               options.pixels.spacing, &rays_);
}

int BlockRenderer::alignment() const {
    if (shares_samples()) return kSharingSide;
    return options_.pixels.spacing > 1 ? refine_tile_side(options_.pixels.spacing) : kPacketSide;
}

bool BlockRenderer::shares_samples() const {
    return sample_use(options_) == SampleUse::shared;
}

bool BlockRenderer::render(const Block& block, int worker, BlockPixels& pixels) const {
    pixels.block = block;
    pixels.values.assign(block.pixels(), PixelValue{});
    pixels.hits.assign(options_.hits ? block.pixels() : 0, PixelHit{});
    const std::size_t groups = contexts_[worker].groups ? contexts_[worker].groups->size() : 0;
    pixels.groups.assign(block.pixels() * groups, {});
    PixelTracer trace(tracer_, rays_, contexts_[worker], stop_);
    if (shares_samples())
        filter_samples(trace, pixels);
    else if (options_.pixels.spacing > 1)
        refine(trace, pixels);
    else
        trace_all(trace, pixels);
    if (small_sources_ && !stop_.requested()) draw_small_sources(worker, pixels);
    return !stop_.requested();
}

void BlockRenderer::trace_all(PixelTracer& trace, BlockPixels& pixels) const {
    constexpr std::size_t kPacket = std::size_t{kPacketSide} * kPacketSide;
    std::array<PixelPlace, kPacket> places;
    std::array<PixelValue, kPacket> values;
    std::array<PixelHit, kPacket> hits;
    const Block& block = pixels.block;
    for (int y0 = block.y0; y0 < block.y1; y0 += kPacketSide) {
        for (int x0 = block.x0; x0 < block.x1; x0 += kPacketSide) {
            if (options_.tiles != nullptr &&
                !options_.tiles->meets(
                    intersection({x0, y0, x0 + kPacketSide, y0 + kPacketSide}, block)))
                continue;
            std::size_t count = 0;
            for (int y = std::min(y0 + kPacketSide, block.y1); y-- > y0;) {  // from the top
                for (int x = x0; x < std::min(x0 + kPacketSide, block.x1); ++x)
                    places[count++] = {x, y};
            }
            trace({places.data(), count}, {values.data(), count},
                  {hits.data(), options_.hits ? count : 0});
            for (std::size_t i = 0; i < count; ++i) {
                const std::size_t at = pixels.index(places[i]);
                pixels.values[at] = values[i];
                if (options_.hits) pixels.hits[at] = hits[i];
                const std::span<const Rgb> groups = trace.groups(i);
                std::copy(groups.begin(), groups.end(), pixels.groups.data() + at * groups.size());
            }
        }
    }
}

/// All samples whose pixels the block's filters reach, sample by sample in packets.
void BlockRenderer::filter_samples(PixelTracer& trace, BlockPixels& pixels) const {
    const Block& block = pixels.block;
    if (options_.tiles != nullptr && !options_.tiles->meets(block)) return;
    FilteredBlock filtered(rays_, options_, block, pixels.groups.size() / block.pixels());
    const PixelRectangle& around = filtered.around();
    for (int y0 = around.y0; y0 < around.y1; y0 += kPacketSide) {
        for (int x0 = around.x0; x0 < around.x1; x0 += kPacketSide) {
            const PixelRectangle packet =
                intersection({x0, y0, x0 + kPacketSide, y0 + kPacketSide}, filtered.around());
            for (int sample = 0; sample < options_.pixels.samples && !stop_.requested(); ++sample)
                filtered.trace(trace, packet, sample, pixels);
        }
    }
    filtered.gather(pixels);
}

/// Whole tiles of the picture, whatever part of them the block covers: where a tile is refined does
/// not depend on blocks.
void BlockRenderer::refine(PixelTracer& trace, BlockPixels& pixels) const {
    const RefineOptions options{options_.pixels.spacing, options_.pixels.threshold,
                                options_.use_distances};
    const PixelRectangle picture = options_.whole();
    const Block& block = pixels.block;
    const int side = alignment();
    std::vector<PixelHit> hits;
    const auto trace_places = [&](std::span<const PixelPlace> places,
                                  std::span<PixelValue> values) {
        if (!options_.hits) return trace(places, values);
        hits.resize(places.size());
        trace(places, values, hits);
        for (std::size_t i = 0; i < places.size(); ++i) {
            if (block.contains(places[i])) pixels.hits[pixels.index(places[i])] = hits[i];
        }
    };
    const auto store = [&](const PixelPlace& place, const PixelValue& value) {
        if (block.contains(place)) pixels.values[pixels.index(place)] = value;
    };
    for (int y = block.y0 - block.y0 % side; y < block.y1; y += side) {
        for (int x = block.x0 - block.x0 % side; x < block.x1; x += side) {
            const PixelRectangle tile{x, y, std::min(x + side, picture.x1),
                                      std::min(y + side, picture.y1)};
            refine_tile(tile, options, trace_places, store);
        }
    }
}

void BlockRenderer::draw_small_sources(int worker, BlockPixels& pixels) const {
    small_sources_->draw(pixels.block, contexts_[worker], [&](const SourcePixel& source) {
        const std::size_t at = pixels.index({source.x, source.y});
        PixelValue& value = pixels.values[at];
        const SourceBlend blend = blend_source(source, value.radiance,
                                               options_.use_distances ? &value.distance : nullptr);
        const GroupSums* groups = contexts_[worker].groups;
        for (std::size_t g = 0; groups && g < groups->size(); ++g) {
            Rgb& of_group = pixels.groups[at * groups->size() + g];
            of_group = of_group * blend.pixel + groups->sums()[g] * blend.source;
        }
    });
}

}  // namespace lightwalk
