#include "core/bsdf/through_part.h"

#include <algorithm>
#include <array>

#include "core/bsdf/bsdf_color.h"

namespace lightwalk {
namespace {

constexpr std::size_t kDirections = 29;
constexpr double kPeakArea = 1.5;         ///< a peak's cells are at most so many times the smallest
constexpr double kPeakDepth = 8;          ///< and at most so many times darker than their mean
constexpr double kLeastSurround = 0.2;    ///< area of the surround over that of the peak
constexpr double kLeastThrough = 0.0005;  ///< luminous transmittance of a part that counts

/// Offsets of the directions in which a peak is looked for, in units of the smallest cell's edge:
/// three rings of eight about the straight one, and four beyond.
constexpr std::array<ProjectedDirection, kDirections> offsets() {
    std::array<ProjectedDirection, kDirections> all{};
    std::size_t count = 1;
    for (const double size : {0.6, 1.2, 1.8}) {
        for (const double x : {-size, 0.0, size}) {
            for (const double y : {-size, 0.0, size}) {
                if (x != 0 || y != 0) all[count++] = {x, y};
            }
        }
    }
    all[count++] = {2.4, 0};
    all[count++] = {-2.4, 0};
    all[count++] = {0, 2.4};
    all[count++] = {0, -2.4};
    return all;
}

struct SeenCell {
    Rgb f;
    double solid_angle = 0, luminance = 0;
    std::uint64_t cell = 0;
};

/// The cells about the straight direction, bright ones first, each once.
struct SeenCells {
    std::array<SeenCell, kDirections> list;
    std::size_t count = 0;

    void add(const SeenCell& seen) {
        for (std::size_t i = 0; i < count; ++i) {
            if (list[i].cell == seen.cell) return;
        }
        std::size_t at = count++;
        for (; at > 0 && list[at - 1].luminance < seen.luminance; --at) list[at] = list[at - 1];
        list[at] = seen;
    }
};

SeenCells look_around(const BsdfComponent& transmission, const BsdfLookup& lookup, double least) {
    static constexpr std::array<ProjectedDirection, kDirections> kOffsets = offsets();
    const Rgb constant = transmission.lambertian * static_cast<float>(1 / kPi);
    const double scale = std::sqrt(least);
    const ProjectedDirection& e = lookup.direction;
    const double z = above_disk(e).z;
    SeenCells seen;
    for (const ProjectedDirection& offset : kOffsets) {
        const Vec3 l = normalize({-e.x + offset.x * scale, -e.y + offset.y * scale, z});
        const BsdfLobes::Value value = transmission.lobes->value_for(lookup, {l.x, l.y});
        const Rgb f = value.f + constant;
        seen.add({f, value.solid_angle, static_cast<double>(brightness(f)), value.cell});
    }
    return seen;
}

/// Sums over cells.
struct CellSum {
    Rgb flux;
    double solid_angle = 0;

    void add(const SeenCell& seen) {
        flux += seen.f * static_cast<float>(seen.solid_angle);
        solid_angle += seen.solid_angle;
    }
    [[nodiscard]] double mean_luminance() const {
        return static_cast<double>(brightness(flux)) / solid_angle;
    }
};

}  // namespace

ThroughPart find_through_part(const BsdfComponent& transmission, const ProjectedDirection& e) {
    if (!transmission.lobes) return {};
    return find_through_part(transmission, transmission.lobes->look_up(e));
}

ThroughPart find_through_part(const BsdfComponent& transmission, const BsdfLookup& looked_up) {
    if (!transmission.lobes) return {};
    const double least = transmission.lobes->least_solid_angle();
    const SeenCells seen = look_around(transmission, looked_up, least);
    if (!(seen.list[0].luminance > kEpsilon)) return {};
    CellSum peak, surround;
    for (std::size_t i = 0; i < seen.count; ++i) {
        const SeenCell& cell = seen.list[i];
        const bool small = cell.solid_angle <= kPeakArea * least;
        if (i == 0 && !small) return {};
        const bool bright = i == 0 || kPeakDepth * cell.luminance >= peak.mean_luminance();
        (small && bright ? peak : surround).add(cell);
    }
    if (surround.solid_angle < kLeastSurround * peak.solid_angle) return {};
    const Rgb constant = transmission.lambertian * static_cast<float>(1 / kPi);
    ThroughPart through;
    through.transmittance = without(peak.flux, constant * static_cast<float>(peak.solid_angle));
    if (static_cast<double>(brightness(through.transmittance)) < kLeastThrough) return {};
    through.surround =
        without(surround.flux * static_cast<float>(1 / surround.solid_angle), constant);
    return through;
}

const ThroughPart& RecentThroughPart::find(const BsdfComponent& of,
                                           const ProjectedDirection& from) {
    if (transmission != &of || e.x != from.x || e.y != from.y)
        *this = {&of, from, find_through_part(of, from)};
    return part;
}

bool in_through_part(const ProjectedDirection& e, const ProjectedDirection& l, double projected,
                     double least) {
    constexpr double kReach = 2.5 * 4 / kPi;
    const double x = l.x + e.x, y = l.y + e.y;
    return x * x + y * y <= kReach * (projected + least + 2 * std::sqrt(projected * least));
}

}  // namespace lightwalk
