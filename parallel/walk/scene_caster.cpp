#include "parallel/walk/scene_caster.h"

#include "core/math/distance.h"
#include "core/math/random.h"

namespace lightwalk {

PixelRays rays_of_sample(const Camera& camera, const FrameOptions& options, int sample) {
    PixelOptions pixels = options.pixels;
    std::uint64_t seed = options.seed;
    if (sample > 0) {
        seed = mix_bits(seed + static_cast<std::uint64_t>(sample));
        if (!(pixels.jitter > 0)) pixels.jitter = PixelOptions{}.jitter;
    }
    return {camera, options.previous, options.width, options.height, pixels, seed, options.step};
}

namespace {

FrameOptions with_rays(FrameOptions options, bool passing) {
    if (passing) options.pixels.jitter = 0;
    return options;
}

}  // namespace

SceneCaster::SceneCaster(const Tracer& tracer, const VisibilityProbe& visibility,
                         const Camera& camera, const FrameOptions& options,
                         WorkerContexts& contexts, const StopFlag& stop, FrameUse use,
                         const LightMixture* mixture)
    : tracer_(tracer),
      probe_(visibility),
      camera_(camera),
      options_(with_rays(options, use == FrameUse::passing)),
      rays_(rays_of_sample(camera_, options_, 0)),
      contexts_(contexts),
      stop_(stop),
      steered_(use != FrameUse::picture),
      mixture_(contexts.light_groups() != nullptr ? mixture : nullptr),
      scratch_(static_cast<std::size_t>(contexts.size())) {}

void SceneCaster::probe(std::span<const PixelPlace> places, const ProbeOptions& options,
                        std::span<PixelVisibility> visibility, int worker) {
    probe_along(rays_, options.spacing,
                {false, options.patterns ? &contexts_[worker] : nullptr, steered_}, places,
                visibility, scratch_[static_cast<std::size_t>(worker)]);
}

namespace {

/// A ray and where it goes through its pixel.
void set_out(const Camera::ViewRay& ray, double x, double y, RaySegment& segment,
             PixelVisibility& visibility) {
    segment.origin = ray.origin;
    segment.direction = ray.direction;
    segment.t_max = farthest_hit(ray.limit);
    visibility.ray = true;
    visibility.x = static_cast<float>(x);
    visibility.y = static_cast<float>(y);
}

}  // namespace

void SceneCaster::set_out_plainly(const PixelRays& rays, std::span<const PixelPlace> places,
                                  std::span<RaySegment> segments,
                                  std::span<PixelVisibility> visibility) const {
    const Camera camera = camera_;  // copies: nothing that is written can change them
    const PixelRays from = rays;
    const double width = options_.width, height = options_.height;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const PixelRays::Place at = from.place(places[i].x, places[i].y);
        set_out(camera.perspective_ray(at.h, at.v), at.h * width, at.v * height, segments[i],
                visibility[i]);
    }
}

void SceneCaster::set_out_anyhow(const PixelRays& rays, std::span<const PixelPlace> places,
                                 std::span<RaySegment> segments,
                                 std::span<PixelVisibility> visibility) const {
    for (std::size_t i = 0; i < places.size(); ++i) {
        const PixelRay pixel = rays(places[i].x, places[i].y);
        visibility[i] = {};
        segments[i] = {{}, {}, 0};
        if (pixel.ray)
            set_out(*pixel.ray, pixel.h * options_.width, pixel.v * options_.height, segments[i],
                    visibility[i]);
    }
}

/// The rays of pixels and their nearest hits.
void SceneCaster::find_hits(const PixelRays& rays, int spacing, std::span<const PixelPlace> places,
                            std::span<PixelVisibility> visibility, Scratch& s) const {
    const Geometry& geometry = tracer_.scene().geometry();
    s.segments.resize(places.size());
    s.hits.resize(places.size());
    if (camera_.view().type != 'v' || !rays.pinhole()) {
        set_out_anyhow(rays, places, s.segments, visibility);
        geometry.intersect(s.segments, s.hits);
        return;
    }
    set_out_plainly(rays, places, s.segments, visibility);
    if (spacing == 1) return geometry.intersect(s.segments, s.hits);
    const std::span<const PixelPlace> corners = s.sparse.corners(places, spacing);
    s.segments.resize(places.size() + corners.size());
    s.hits.resize(s.segments.size());
    s.visibility.resize(corners.size());
    set_out_plainly(rays, corners, std::span(s.segments).subspan(places.size()), s.visibility);
    s.sparse.find(geometry, s.segments, s.hits);
    s.segments.resize(places.size());
    s.hits.resize(places.size());
}

void SceneCaster::probe_along(const PixelRays& rays, int spacing,
                              const VisibilityProbe::Needs& needs,
                              std::span<const PixelPlace> places,
                              std::span<PixelVisibility> visibility, Scratch& s) const {
    find_hits(rays, spacing, places, visibility, s);
    probe_.find(s.segments, s.hits, needs, visibility, s.ways);
}

namespace {

/// How far away a pixel shows something, by Ray::effective_distance()'s rule: a ray ends at a pane
/// or mirror with ripples, but its image moves as what it shows does [m].
float distance_of(const TracedPixel& pixel) {
    const PrimaryVisibility &ahead = pixel.visibility.ahead, &image = pixel.visibility.mirrored;
    const bool mirror =
        image.seen && brightness(pixel.mirrored) > 0.5f * brightness(pixel.radiance);
    if (mirror) return image.distance;
    return ahead.kind == PointKind::through ? ahead.distance : pixel.distance;
}

}  // namespace

void SceneCaster::trace(std::span<const PixelPlace> places, std::span<TracedPixel> pixels,
                        int sample, int worker) {
    Scratch& s = scratch_[static_cast<std::size_t>(worker)];
    s.visibility.resize(places.size());
    s.values.resize(places.size());
    s.pixel_hits.resize(places.size());
    const PixelRays rays = rays_of_sample(camera_, options_, sample);
    probe_along(rays, 1, {true, steered_ ? &contexts_[worker] : nullptr, steered_}, places,
                s.visibility, s);
    PixelTracer trace_pixels(tracer_, rays, contexts_[worker], stop_);
    trace_pixels(places, s.values, s.pixel_hits);
    for (std::size_t i = 0; i < places.size(); ++i) {
        pixels[i] = {s.visibility[i], s.values[i].radiance, s.pixel_hits[i].mirrored,
                     s.values[i].distance};
        if (steered_) pixels[i].distance = distance_of(pixels[i]);
    }
    s.groups.clear();
    s.mirrored_groups.clear();
    for (std::size_t i = 0; mixture_ != nullptr && i < places.size(); ++i) {
        const std::span<const Rgb> whole = trace_pixels.groups(i);
        const std::span<const Rgb> mirrored = trace_pixels.mirrored_groups(i);
        s.groups.insert(s.groups.end(), whole.begin(), whole.end());
        s.mirrored_groups.insert(s.mirrored_groups.end(), mirrored.begin(), mirrored.end());
    }
}

PixelGroups SceneCaster::groups(int worker) const {
    const Scratch& s = scratch_[static_cast<std::size_t>(worker)];
    return {s.groups, s.mirrored_groups, mixture_};
}

}  // namespace lightwalk
