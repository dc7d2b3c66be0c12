#include "parallel/pixel_tracer.h"

namespace lightwalk {

void PixelTracer::operator()(std::span<const PixelPlace> places, std::span<PixelValue> values,
                             std::span<PixelHit> hits) {
    clear_groups(places.size());
    trace_sample(0, places, values, hits);
    if (pixel_rays_.samples() == 1) return;
    more_.resize(places.size());
    more_hits_.resize(hits.size());
    for (int sample = 1; sample < pixel_rays_.samples() && !stop_.requested(); ++sample) {
        trace_sample(sample, places, more_, more_hits_);
        for (std::size_t i = 0; i < places.size(); ++i) values[i].radiance += more_[i].radiance;
        for (std::size_t i = 0; i < hits.size(); ++i) hits[i].mirrored += more_hits_[i].mirrored;
    }
    const float share = 1 / static_cast<float>(pixel_rays_.samples());
    for (PixelValue& value : values) value.radiance *= share;
    for (PixelHit& hit : hits) hit.mirrored *= share;
    for (Rgb& value : groups_) value *= share;
    for (Rgb& value : mirrored_groups_) value *= share;
}

void PixelTracer::trace_one(int sample, std::span<const PixelPlace> places,
                            std::span<PixelValue> values, std::span<PixelHit> hits) {
    clear_groups(places.size());
    trace_sample(sample, places, values, hits);
}

void PixelTracer::clear_groups(std::size_t places) {
    if (!context_.groups) return;
    groups_.assign(places * context_.groups->size(), {});
    mirrored_groups_.assign(groups_.size(), {});
}

void PixelTracer::shade_by_groups() {
    GroupSums& sums = *context_.groups;
    tracer_.shade_hits(rays_, hits_, context_, [&](std::size_t k) {
        Rgb* to = &groups_[targets_[k] * sums.size()];
        for (const Rgb& value : sums.sums()) *to++ += value;
        if (!(brightness(rays_[k].mirrored) > 0)) return;
        to = &mirrored_groups_[targets_[k] * sums.size()];
        for (const Rgb& value : sums.reflected()) *to++ += value;
    });
}

void PixelTracer::trace_sample(int sample, std::span<const PixelPlace> places,
                               std::span<PixelValue> values, std::span<PixelHit> hits) {
    rays_.clear();
    segments_.clear();
    targets_.clear();
    for (std::size_t i = 0; i < places.size(); ++i) {
        values[i] = {};
        if (!hits.empty()) hits[i] = {true, kNoSurface, kVoid, Vec3{}, kHuge, Rgb{}};
        const PixelRay pixel = pixel_rays_(places[i].x, places[i].y, sample);
        if (!pixel.ray) continue;
        Ray& ray = rays_.emplace_back();
        tracer_.start_primary(ray, pixel.ray->origin, pixel.ray->direction, pixel.ray->limit,
                              pixel.random);
        RaySegment& segment = segments_.emplace_back();
        segment.origin = ray.origin;
        segment.direction = ray.direction;
        segment.t_max = farthest_hit(ray.limit);
        targets_.push_back(i);
    }
    hits_.resize(rays_.size());
    tracer_.scene().geometry().intersect(segments_, hits_);
    if (stop_.requested()) return;
    if (context_.groups)
        shade_by_groups();
    else
        tracer_.shade_hits(rays_, hits_, context_);
    for (std::size_t k = 0; k < rays_.size(); ++k) {
        const Ray& ray = rays_[k];
        values[targets_[k]] = {ray.value, static_cast<float>(ray.effective_distance())};
        if (hits.empty()) continue;
        // Shading finds sources at infinity; what is nearer was known before.
        const Hit& first = hits_[k].exists() ? hits_[k] : ray.hit;
        hits[targets_[k]] = {
            true,        first.surface, first.modifier, first.position, ray.reflected_path_length,
            ray.mirrored};
    }
}

}  // namespace lightwalk
