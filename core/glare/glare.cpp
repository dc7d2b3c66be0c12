#include "core/glare/glare.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/glare/dgp.h"
#include "core/glare/direction_groups.h"
#include "core/glare/outline.h"

namespace lightwalk {
namespace {

/// The pixels of a source, as indices into VisualField::pixels.
using SourcePixels = std::vector<std::uint32_t>;

void check(const GlareParams& params) {
    const auto positive = [](double x) { return x > 0 && std::isfinite(x); };
    if (!positive(params.threshold) || !positive(params.peak) || !positive(params.merge_angle) ||
        params.merge_angle > kPi / 2)
        throw InputError(
            "glare: threshold, peak and merge angle must be positive, the angle at most 90 "
            "degrees");
    if (params.outline_points < 4) throw InputError("glare: an outline needs at least 4 points");
}

/// The pixels brighter than a limit.
template <class Pixels>
SourcePixels brighter(const VisualField& field, const Pixels& among, double limit) {
    SourcePixels bright;
    for (const std::uint32_t i : among) {
        if (field.pixels[i].luminance > limit) bright.push_back(i);
    }
    return bright;
}

/// Groups of pixels connected by steps of at most an angle.
std::vector<SourcePixels> merged(const VisualField& field, const SourcePixels& pixels,
                                 double angle) {
    std::vector<Vec3> directions;
    for (const std::uint32_t i : pixels) directions.push_back(field.pixels[i].direction);
    const std::vector<std::uint32_t> groups = group_directions(directions, angle);
    std::vector<SourcePixels> sources;
    for (std::size_t k = 0; k < pixels.size(); ++k) {
        if (groups[k] == sources.size()) sources.emplace_back();
        sources[groups[k]].push_back(pixels[k]);
    }
    return sources;
}

/// What a picture and its camera are for the sources in it.
struct SourceView {
    const VisualField& field;
    const Camera& camera;
    int width = 0, height = 0;
};

/// The mean place of the light of some pixels, as a direction: the weighted mean of their places in
/// the picture, as in the reference evaluation, rather than of their directions.
Vec3 mean_direction(const SourceView& of, const SourcePixels& pixels, bool whole_pixels) {
    double x = 0, y = 0, sum = 0;
    for (const std::uint32_t i : pixels) {
        const FieldPixel& pixel = of.field.pixels[i];
        const double weight = pixel.luminance * pixel.solid_angle;
        x += weight * pixel.place.x;
        y += weight * pixel.place.y;
        sum += weight;
    }
    const auto centre = [&](double place) {
        return (whole_pixels ? std::floor(place) : place) + 0.5;
    };
    return field_direction(of.camera, centre(x / sum) / of.width, centre(y / sum) / of.height);
}

GlareSource source_of(const SourceView& of, const SourcePixels& pixels, const GlareParams& params,
                      bool peak) {
    GlareSource source;
    source.pixels = pixels.size();
    source.peak = peak;
    std::vector<PixelPlace> places;
    for (const std::uint32_t i : pixels) {
        const FieldPixel& pixel = of.field.pixels[i];
        source.luminance += pixel.luminance * pixel.solid_angle;
        source.solid_angle += pixel.solid_angle;
        source.illuminance +=
            pixel.luminance * pixel.solid_angle * dot(pixel.direction, of.camera.forward());
        places.push_back(pixel.place);
    }
    source.luminance /= source.solid_angle;
    source.direction = mean_direction(of, pixels, params.whole_pixels);
    source.position_index = position_index(source.direction, of.camera);
    source.glare = source.luminance * source.luminance * source.solid_angle /
                   (source.position_index * source.position_index);
    source.outline = outline_of(places, of.camera, of.width, of.height, params.outline_points);
    return source;
}

struct FoundSource {
    GlareSource source;
    SourcePixels pixels;
};

/// The worst first.
std::vector<FoundSource> sources_in(const SourceView& of, const GlareParams& params) {
    SourcePixels all(of.field.pixels.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    const SourcePixels bright = brighter(of.field, all, params.threshold);
    std::vector<FoundSource> found;
    const auto add = [&](SourcePixels& pixels, bool peak) {
        GlareSource source = source_of(of, pixels, params, peak);
        found.push_back({std::move(source), std::move(pixels)});
    };
    for (SourcePixels& pixels : merged(of.field, bright, params.merge_angle)) {
        std::erase_if(pixels,
                      [&](std::uint32_t i) { return of.field.pixels[i].luminance > params.peak; });
        if (!pixels.empty()) add(pixels, false);
    }
    const SourcePixels peaks = brighter(of.field, bright, params.peak);
    for (SourcePixels& pixels : merged(of.field, peaks, params.merge_angle)) add(pixels, true);
    std::stable_sort(found.begin(), found.end(), [](const FoundSource& a, const FoundSource& b) {
        return a.source.glare > b.source.glare;
    });
    return found;
}

std::vector<GlareSource> without_pixels(std::vector<FoundSource> found) {
    std::vector<GlareSource> sources;
    sources.reserve(found.size());
    for (FoundSource& one : found) sources.push_back(std::move(one.source));
    return sources;
}

void check_view(const View& view) {
    if (is_whole_fisheye(view)) return;
    throw InputError(std::string("glare: daylight glare probability needs a fisheye, -vta or "
                                 "-vth -vh 180 -vv 180, not a view of type '") +
                     view.type + "', " + std::to_string(view.horizontal) + " by " +
                     std::to_string(view.vertical) + " degrees");
}

/// What a pixel adds to the vertical illuminance for each cd/m² [sr].
double projected(const FieldPixel& pixel, const Camera& camera) {
    return pixel.solid_angle * dot(pixel.direction, camera.forward());
}

}  // namespace

std::vector<GlareSource> find_glare_sources(const FieldPicture& picture, const Camera& camera,
                                            const GlareParams& params) {
    check(params);
    const VisualField field = visual_field(picture, camera);
    return without_pixels(sources_in({field, camera, picture.width, picture.height}, params));
}

GlareReport analyse_glare(const FieldPicture& picture, const View& view,
                          const GlareParams& params) {
    check(params);
    check_view(view);
    const Camera camera(view);
    const VisualField field = visual_field(picture, camera);
    GlareReport report;
    double flux = 0, solid_angle = 0, glare = 0;
    for (const FieldPixel& pixel : field.pixels) {
        flux += pixel.luminance * pixel.solid_angle;
        solid_angle += pixel.solid_angle;
        report.vertical_illuminance += pixel.luminance * projected(pixel, camera);
    }
    report.average_luminance = solid_angle > 0 ? flux / solid_angle : 0;
    report.dropped = field.dropped;
    report.sources =
        without_pixels(sources_in({field, camera, picture.width, picture.height}, params));
    for (const GlareSource& source : report.sources) glare += source.glare;
    const double ev = report.vertical_illuminance;
    report.dgp = daylight_glare_probability(ev, glare);
    report.low_light_correction = low_light_correction(ev);
    report.within_assessments = within_assessments(report.dgp, ev);
    return report;
}

std::vector<GlareShare> glare_shares(const FieldPicture& picture, const View& view,
                                     const GlareParams& params) {
    check(params);
    check_view(view);
    const Camera camera(view);
    const VisualField field = visual_field(picture, camera);
    const std::vector<FoundSource> found =
        sources_in({field, camera, picture.width, picture.height}, params);
    double ev = 0, glare = 0;
    for (const FieldPixel& pixel : field.pixels) ev += pixel.luminance * projected(pixel, camera);
    for (const FoundSource& one : found) glare += one.source.glare;
    const DgpSlopes slopes = dgp_slopes(ev, glare);
    std::vector<GlareShare> shares;
    shares.reserve(field.pixels.size());
    for (const FieldPixel& pixel : field.pixels)
        shares.push_back({pixel.place, pixel.luminance, slopes.ev * projected(pixel, camera)});
    for (const auto& [source, pixels] : found) {
        // Of L² ω / P², where L is the mean over the solid angle ω.
        const double slope =
            slopes.sum * 2 * source.luminance / (source.position_index * source.position_index);
        for (const std::uint32_t i : pixels) shares[i].slope += slope * field.pixels[i].solid_angle;
    }
    return shares;
}

}  // namespace lightwalk
