#include "core/ambient/refined_hemisphere.h"

#include <algorithm>

namespace lightwalk {

RefinedHemisphere::RefinedHemisphere(const LightTransport& tracer,
                                     std::span<const std::uint8_t> lets_light, Ray& parent,
                                     const Sampling& sampling, TraceContext& context)
    : tracer_(tracer),
      lets_light_(lets_light),
      parent_(parent),
      sampling_(sampling),
      context_(context),
      frame_(sampling.normal, sampling_.random) {
    const auto n = static_cast<std::size_t>(sampling.divisions);
    for (Row& row : rows_) {
        row.rays.reserve(n);
        row.hits.reserve(n);
        row.place.resize(n);
        row.ray.resize(n);
        row.light.resize(n);
    }
}

Surroundings RefinedHemisphere::sample() {
    const int n = sampling_.divisions;
    for (int i = 0; i <= n; ++i) {
        if (i < n) look(i);
        if (i > 0) shade(i - 1);
    }
    return seen_;
}

/// Finds what the rays of a row meet.
void RefinedHemisphere::look(int i) {
    Row& row = rows_[static_cast<std::size_t>(i % 3)];
    row.clear();
    for (int j = 0; j < sampling_.divisions; ++j) {
        const auto cell = static_cast<std::size_t>(j);
        const double x = sampling_.random.next(), y = sampling_.random.next();
        row.place[cell] = static_cast<int>(y * sampling_.finer) * sampling_.finer +
                          static_cast<int>(x * sampling_.finer);
        row.light[cell] = 0;
        row.ray[cell] = -1;
        if (!start(row, j + x, i + y)) continue;
        row.ray[cell] = static_cast<int>(row.rays.size()) - 1;
        row.light[cell] = met_light(row.hits.back()) ? 1 : 0;
    }
}

/// Evaluates the rays of a row, and more where its neighbours met light.
void RefinedHemisphere::shade(int i) {
    Row& row = rows_[static_cast<std::size_t>(i % 3)];
    const int finer = sampling_.finer, places = finer * finer;
    const float share = 1 / static_cast<float>(places);
    more_.clear();
    for (int j = 0; j < sampling_.divisions && finer > 1; ++j) {
        const auto cell = static_cast<std::size_t>(j);
        if (!is_next_to_light(i, j)) continue;
        if (row.ray[cell] >= 0) row.rays[static_cast<std::size_t>(row.ray[cell])].coef *= share;
        for (int place = 0; place < places; ++place) {
            if (place == row.place[cell]) continue;
            const int up = place / finer, along = place % finer;
            const double x = along + sampling_.random.next(), y = up + sampling_.random.next();
            if (start(more_, j + x / finer, i + y / finer)) more_.rays.back().coef *= share;
        }
    }
    trace(row);
    trace(more_);
}

void RefinedHemisphere::trace(Rays& some) {
    tracer_.shade_hits(some.rays, some.hits, context_);
    for (const Ray& ray : some.rays) {
        if (ray.effective_distance() <= kEpsilon) continue;
        seen_.sum += ray.value * ray.coef;
        ++seen_.succeeded;
    }
}

/// A ray through a place of the grid of cells, and what it meets. False: it may not start.
bool RefinedHemisphere::start(Rays& some, double x, double y) {
    Ray& ray = some.rays.emplace_back();
    if (!tracer_.spawn(ray, sampling_.kind, parent_, &sampling_.coef)) {
        some.rays.pop_back();
        return false;
    }
    ray.coef *= sampling_.share;
    ray.direction = frame_.above(square_to_disk(x / sampling_.divisions, y / sampling_.divisions));
    some.hits.push_back(tracer_.scene().geometry().intersect(ray.segment()));
    return true;
}

bool RefinedHemisphere::met_light(const Hit& hit) const {
    return !hit.exists() || (hit.modifier != kVoid &&
                             lets_light_[static_cast<std::size_t>(index(hit.modifier))] != 0);
}

bool RefinedHemisphere::is_next_to_light(int i, int j) const {
    const int last = sampling_.divisions - 1;
    for (int a = std::max(i - 1, 0); a <= std::min(i + 1, last); ++a) {
        const Row& row = rows_[static_cast<std::size_t>(a % 3)];
        for (int b = std::max(j - 1, 0); b <= std::min(j + 1, last); ++b) {
            if ((a != i || b != j) && row.light[static_cast<std::size_t>(b)] != 0) return true;
        }
    }
    return false;
}

}  // namespace lightwalk
