#include "core/bsdf/angle_basis.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lightwalk {
namespace {

double squared_sine(double degrees) {
    if (degrees >= 90) return 1;
    const double sine = std::sin(degrees * (kPi / 180));
    return sine * sine;
}

/// From 0 to 4, rising with the azimuth from 0 to 2π, at the price of a division.
double pseudo_azimuth(const ProjectedDirection& p) {
    const double size = std::abs(p.x) + std::abs(p.y);
    const double height = size > 0 ? p.y / size : 0;
    if (p.x < 0) return 2 - height;
    return p.y < 0 ? 4 + height : height;
}

}  // namespace

AngleBasis::AngleBasis(std::vector<AngleRing> rings) : rings_(std::move(rings)) {
    double inner = 0;
    for (const AngleRing& ring : rings_) {
        const double outer = squared_sine(ring.upper);
        const double area = kPi * (outer - inner) / static_cast<double>(ring.sectors);
        places_.push_back({inner, outer, area, patch_count_, 0});
        patch_count_ += ring.sectors;
        areas_.insert(areas_.end(), ring.sectors, area);
        places_.back().ends = ends_.size();
        ends_.push_back(-1);
        for (std::size_t k = 0; k < ring.sectors; ++k) {
            const double azimuth =
                2 * kPi * (static_cast<double>(k) + 0.5) / static_cast<double>(ring.sectors);
            ends_.push_back(pseudo_azimuth({std::cos(azimuth), std::sin(azimuth)}));
        }
        ends_.push_back(5);
        inner = outer;
    }
    for (std::size_t ring = 0; ring + 1 < places_.size(); ++ring)
        outer_.push_back(places_[ring].outer);
}

std::size_t AngleBasis::index(const ProjectedDirection& p) const {
    const double square = p.x * p.x + p.y * p.y;
    // Counted without branches, which jittered directions would take at random.
    std::size_t ring = 0;
    for (const double outer : outer_) ring += square >= outer ? 1 : 0;
    return patch_of(ring, pseudo_azimuth(p));
}

/// Sums, divisions and choices are those of index(), of all directions at once.
PatchNumbers AngleBasis::indices(const NearDirections& p) const {
    alignas(32) std::array<double, kNearDirections> square, azimuth;
    alignas(32) std::array<std::uint64_t, kNearDirections> ring{};
    for (std::size_t i = 0; i < kNearDirections; ++i) square[i] = p.x[i] * p.x[i] + p.y[i] * p.y[i];
    for (const double outer : outer_) {
        for (std::size_t i = 0; i < kNearDirections; ++i) ring[i] += square[i] >= outer ? 1 : 0;
    }
    for (std::size_t i = 0; i < kNearDirections; ++i) {
        const double size = std::abs(p.x[i]) + std::abs(p.y[i]);
        const double height = p.y[i] / (size > 0 ? size : 1);
        const double right = height < 0 ? 4 + height : height;
        azimuth[i] = p.x[i] < 0 ? 2 - height : right;
    }
    PatchNumbers patches;
    for (std::size_t i = 0; i < kNearDirections; ++i) patches[i] = patch_of(ring[i], azimuth[i]);
    return patches;
}

/// @param azimuth  as pseudo_azimuth() has it
std::size_t AngleBasis::patch_of(std::size_t ring, double azimuth) const {
    const std::size_t sectors = rings_[ring].sectors;
    if (sectors == 1) return places_[ring].first;
    const double* ends = &ends_[places_[ring].ends];
    auto sector =
        static_cast<std::size_t>(std::floor(azimuth * 0.25 * static_cast<double>(sectors) + 0.5));
    // Of few sectors that is one off at most.
    sector -= azimuth < ends[sector] ? 1 : 0;
    sector += azimuth >= ends[sector + 1] ? 1 : 0;
    while (azimuth < ends[sector]) --sector;
    while (azimuth >= ends[sector + 1]) ++sector;
    return places_[ring].first + (sector < sectors ? sector : 0);
}

std::size_t AngleBasis::ring_of(std::size_t patch) const {
    std::size_t ring = places_.size() - 1;
    while (patch < places_[ring].first) --ring;
    return ring;
}

double AngleBasis::least_solid_angle() const {
    double least = kPi;
    for (const Place& place : places_) least = std::min(least, place.area);
    return least;
}

ProjectedDirection AngleBasis::sample(std::size_t patch, double xi1, double xi2) const {
    const std::size_t ring = ring_of(patch);
    const Place& place = places_[ring];
    const double radius = std::sqrt(place.inner + (place.outer - place.inner) * xi1);
    const double sector = static_cast<double>(patch - place.first) + xi2 - 0.5;
    const double azimuth = 2 * kPi * sector / static_cast<double>(rings_[ring].sectors);
    return {radius * std::cos(azimuth), radius * std::sin(azimuth)};
}

std::optional<AngleBasis> klems_basis(std::string_view name) {
    if (name == "LBNL/Klems Full") {
        return AngleBasis({{5, 1},
                           {15, 8},
                           {25, 16},
                           {35, 20},
                           {45, 24},
                           {55, 24},
                           {65, 24},
                           {75, 16},
                           {90, 12}});
    }
    if (name == "LBNL/Klems Half") {
        return AngleBasis(
            {{6.5, 1}, {19.5, 8}, {32.5, 12}, {45.5, 16}, {58.5, 20}, {71.5, 12}, {90, 8}});
    }
    if (name == "LBNL/Klems Quarter") {
        return AngleBasis({{9, 1}, {27, 8}, {45, 12}, {63, 12}, {90, 8}});
    }
    return std::nullopt;
}

AngleBasis old_klems_half_basis() {
    return AngleBasis(
        {{6.5, 1}, {19.5, 8}, {32.5, 12}, {46.5, 16}, {61.5, 20}, {76.5, 12}, {90, 4}});
}

}  // namespace lightwalk
