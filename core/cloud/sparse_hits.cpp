#include "core/cloud/sparse_hits.h"

#include <algorithm>
#include <cmath>

namespace lightwalk {
namespace {

/// How far hits may be off a plane, as a share of their distance.
constexpr double kOffPlane = 1e-6;

/// Whether a second hit lies on the plane of the first one, and shows the same as far as a ray can
/// tell: meshes, whose places have coordinates of their own, do not.
bool is_same_plane(const Hit& a, const Hit& b) {
    if (!a.exists() || !b.exists()) return a.exists() == b.exists();
    return a.surface == b.surface && a.modifier == b.modifier && a.instance == b.instance &&
           a.normal == b.normal && a.perturbation == Vec3{} && b.perturbation == Vec3{} &&
           a.u == 0 && a.v == 0 && b.u == 0 && b.v == 0 &&
           std::abs(dot(a.normal, b.position - a.position)) <= kOffPlane * a.t;
}

/// Where a ray meets the plane of another ray's hit.
Hit on_plane(const Hit& other, const RaySegment& ray) {
    if (!other.exists()) return {};
    Hit hit = other;
    hit.cos_out = -dot(ray.direction, hit.normal);
    hit.t = dot(hit.normal, ray.origin - other.position) / hit.cos_out;
    hit.position = ray.origin + ray.direction * hit.t;
    return hit;
}

}  // namespace

std::span<const PixelPlace> SparseHits::corners(std::span<const PixelPlace> places, int spacing) {
    squares_.clear();
    corners_.clear();
    cells_.clear();
    wanted_.clear();
    places_ = places.size();
    known_.assign(places.size(), 0);
    const auto square_of = [](const PixelPlace& place) {
        return PixelPlace{place.x / kSide, place.y / kSide};
    };
    for (std::size_t first = 0, end = 0; first < places.size(); first = end) {
        const PixelPlace square = square_of(places[first]);
        while (end < places.size() && square_of(places[end]) == square) ++end;
        if (end - first < kWorthCorners) {
            for (std::size_t i = first; i < end; ++i) want(static_cast<std::int32_t>(i));
            continue;
        }
        squares_.emplace_back().fill(kNone);
        const auto number = static_cast<std::uint32_t>(squares_.size() - 1);
        for (std::size_t i = first; i < end; ++i)
            at(number, places[i].x % kSide, places[i].y % kSide) = static_cast<std::int32_t>(i);
        begin_square(places.subspan(first, end - first), spacing);
    }
    return corners_;
}

/// The cells of the newest square, and their corners.
void SparseHits::begin_square(std::span<const PixelPlace> pixels, int spacing) {
    const auto number = static_cast<std::uint32_t>(squares_.size() - 1);
    const PixelPlace origin{pixels[0].x - pixels[0].x % kSide, pixels[0].y - pixels[0].y % kSide};
    const auto end = [&](int begin) { return std::min(begin + spacing, kSide - 1); };
    for (int y = 0; y < kSide - 1; y += spacing) {
        for (int x = 0; x < kSide - 1; x += spacing) {
            cells_.push_back({number, static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y),
                              static_cast<std::uint8_t>(end(x)),
                              static_cast<std::uint8_t>(end(y))});
            for (const int v : {y, end(y)}) {
                for (const int u : {x, end(x)}) {
                    std::int32_t& ray = at(number, u, v);
                    if (ray == kNone) {
                        ray = static_cast<std::int32_t>(known_.size());
                        corners_.push_back({origin.x + u, origin.y + v});
                        known_.push_back(0);
                    }
                    want(ray);
                }
            }
        }
    }
}

void SparseHits::want(std::int32_t ray) {
    if (ray == kNone || known_[static_cast<std::size_t>(ray)] != 0) return;
    known_[static_cast<std::size_t>(ray)] = 1;
    wanted_.push_back(static_cast<std::uint32_t>(ray));
}

void SparseHits::cast(const Geometry& geometry, std::span<const RaySegment> rays,
                      std::span<Hit> hits) {
    segments_.clear();
    for (const std::uint32_t ray : wanted_) segments_.push_back(rays[ray]);
    found_.resize(segments_.size());
    geometry.intersect(segments_, found_);
    for (std::size_t i = 0; i < wanted_.size(); ++i) hits[wanted_[i]] = found_[i];
    wanted_.clear();
}

/// Whether the corners of a cell that have a ray lie on one plane. Without all four it may not be
/// filled.
bool SparseHits::is_plane(const Cell& cell, std::span<const Hit> hits) {
    const Hit* first = nullptr;
    for (const int y : {cell.y0, cell.y1}) {
        for (const int x : {cell.x0, cell.x1}) {
            const std::int32_t ray = at(cell.square, x, y);
            if (ray == kNone) return false;
            const Hit& hit = hits[static_cast<std::size_t>(ray)];
            if (first == nullptr)
                first = &hit;
            else if (!is_same_plane(*first, hit))
                return false;
        }
    }
    return true;
}

void SparseHits::fill(const Cell& cell, std::span<const RaySegment> rays, std::span<Hit> hits) {
    const Hit& corner = hits[static_cast<std::size_t>(at(cell.square, cell.x0, cell.y0))];
    for (int y = cell.y0; y <= cell.y1; ++y) {
        for (int x = cell.x0; x <= cell.x1; ++x) {
            const std::int32_t ray = at(cell.square, x, y);
            if (ray == kNone || known_[static_cast<std::size_t>(ray)] != 0) continue;
            known_[static_cast<std::size_t>(ray)] = 1;
            hits[static_cast<std::size_t>(ray)] =
                on_plane(corner, rays[static_cast<std::size_t>(ray)]);
        }
    }
}

/// The quarters of a cell; none where it has no pixels but its corners.
void SparseHits::split(const Cell& cell, std::vector<Cell>& parts) const {
    const auto middle = [](int begin, int end) {
        return static_cast<std::uint8_t>(end - begin > 1 ? (begin + end + 1) / 2 : end);
    };
    const std::uint8_t x = middle(cell.x0, cell.x1), y = middle(cell.y0, cell.y1);
    if (x == cell.x1 && y == cell.y1) return;
    parts.push_back({cell.square, cell.x0, cell.y0, x, y});
    if (x < cell.x1) parts.push_back({cell.square, x, cell.y0, cell.x1, y});
    if (y < cell.y1) parts.push_back({cell.square, cell.x0, y, x, cell.y1});
    if (x < cell.x1 && y < cell.y1) parts.push_back({cell.square, x, y, cell.x1, cell.y1});
}

void SparseHits::find(const Geometry& geometry, std::span<const RaySegment> rays,
                      std::span<Hit> hits) {
    cast(geometry, rays, hits);
    while (!cells_.empty()) {
        parts_.clear();
        for (const Cell& cell : cells_) {
            if (is_plane(cell, hits))
                fill(cell, rays, hits);
            else
                split(cell, parts_);
        }
        for (const Cell& part : parts_)
            for (const int y : {part.y0, part.y1})
                for (const int x : {part.x0, part.x1}) want(at(part.square, x, y));
        if (!wanted_.empty()) cast(geometry, rays, hits);
        cells_.swap(parts_);
    }
}

}  // namespace lightwalk
