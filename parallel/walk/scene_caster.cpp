#include "parallel/walk/scene_caster.h"

#include "core/math/random.h"

namespace lightwalk {

SceneCaster::SceneCaster(const Tracer& tracer, const SceneSights& sights, const Camera& camera,
                         const FrameOptions& options, WorkerContexts& contexts,
                         const StopFlag& stop)
    : tracer_(tracer),
      sights_(sights),
      camera_(camera),
      options_(options),
      rays_(rays_of(0)),
      contexts_(contexts),
      stop_(stop),
      scratch_(static_cast<std::size_t>(contexts.size())) {}

/// Sample 0 is the picture's own. The others are those of pictures with other seeds; jittered even
/// where the picture is not, or they would all be the same.
PixelRays SceneCaster::rays_of(int sample) const {
    PixelOptions pixels = options_.pixels;
    std::uint64_t seed = options_.seed;
    if (sample > 0) {
        seed = mix_bits(seed + static_cast<std::uint64_t>(sample));
        if (!(pixels.jitter > 0)) pixels.jitter = PixelOptions{}.jitter;
    }
    return {camera_, options_.previous, options_.width, options_.height, pixels,
            seed,    options_.step};
}

void SceneCaster::look(std::span<const PixelPlace> places, std::span<PixelSights> sights,
                       int worker) {
    look_along(rays_, false, places, sights, scratch_[static_cast<std::size_t>(worker)]);
}

void SceneCaster::look_along(const PixelRays& rays, bool slopes, std::span<const PixelPlace> places,
                             std::span<PixelSights> sights, Scratch& s) const {
    s.segments.assign(places.size(), RaySegment{{}, {}, 0});
    for (std::size_t i = 0; i < places.size(); ++i) {
        sights[i] = {};
        const PixelRay pixel = rays(places[i].x, places[i].y);
        sights[i].ray = pixel.ray.has_value();
        if (!pixel.ray) continue;
        const double limit = pixel.ray->limit;
        s.segments[i] = {pixel.ray->origin, pixel.ray->direction, limit > kEpsilon ? limit : kHuge};
        sights[i].x = static_cast<float>(pixel.h * options_.width);
        sights[i].y = static_cast<float>(pixel.v * options_.height);
    }
    s.hits.resize(s.segments.size());
    tracer_.scene().geometry().intersect(s.segments, s.hits);
    sights_.find(s.segments, s.hits, slopes, sights, s.ways);
}

void SceneCaster::trace(std::span<const PixelPlace> places, std::span<TracedPixel> pixels,
                        int sample, int worker) {
    Scratch& s = scratch_[static_cast<std::size_t>(worker)];
    s.sights.resize(places.size());
    s.values.resize(places.size());
    s.pixel_hits.resize(places.size());
    const PixelRays rays = rays_of(sample);
    look_along(rays, true, places, s.sights, s);
    PixelTracer trace_pixels(tracer_, rays, contexts_[worker], stop_);
    trace_pixels(places, s.values, s.pixel_hits);
    for (std::size_t i = 0; i < places.size(); ++i)
        pixels[i] = {s.sights[i], s.values[i].radiance, s.pixel_hits[i].mirrored,
                     s.values[i].distance};
}

}  // namespace lightwalk
