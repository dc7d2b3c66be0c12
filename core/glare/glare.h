#pragma once
// Glare: the sources in a picture that disturb the eye, and how probably they do.
#include <cstddef>
#include <vector>

#include "core/glare/visual_field.h"
#include "core/view/view.h"

namespace lightwalk {

/// What counts as a source of glare. The defaults are those of the reference evaluation,
/// evalglare(1): a fixed threshold, -r 0.2 (the full angle of a search cone) and -y.
struct GlareParams {
    double threshold = 2000;   ///< brighter pixels are glare [cd/m²]
    double merge_angle = 0.1;  ///< largest angle between neighbouring pixels of one source [rad]
    double peak = 50000;       ///< brighter pixels form sources of their own [cd/m²]
    std::size_t outline_points = 64;  ///< at most, at least 4
    /// A source is where the pixel's centre is that its mean image position falls on, as in the
    /// reference evaluation, rather than at that position.
    bool whole_pixels = false;
};

struct GlareSource {
    double luminance = 0;    ///< mean over its solid angle [cd/m²]
    double solid_angle = 0;  ///< [sr]
    double illuminance = 0;  ///< at the eye, of all its pixels as they lie [lx]
    Vec3 direction;  ///< unit: to the mean image position of its pixels, weighted by their light
    double position_index = 1;
    double glare = 0;  ///< L² ω / P² [cd²/m⁴ sr]: its part of the sum in DGP
    bool peak = false;
    std::size_t pixels = 0;
    std::vector<Vec3> outline;  ///< see outline_of()
};

/// The sources of glare in a picture, the worst first. Pixels above the threshold that are at most
/// the merge angle apart belong to one source (single linkage); of these, pixels above the peak
/// value form separate sources among themselves. Pixels should be smaller than the merge angle:
/// else neighbouring ones would not be merged.
/// @param camera  the view of the picture, see visual_field() for which are possible
/// @param params  positive finite numbers, merge_angle at most π / 2, else InputError
[[nodiscard]] std::vector<GlareSource> find_glare_sources(const FieldPicture& picture,
                                                          const Camera& camera,
                                                          const GlareParams& params = {});

struct GlareReport {
    double dgp = 0;                   ///< daylight_glare_probability(), not corrected for low light
    double low_light_correction = 1;  ///< factor of dgp for dim surroundings
    bool within_assessments = false;  ///< within_assessments(); false: dgp is an extrapolation
    double vertical_illuminance = 0;  ///< Ev, at the eye, by the picture [lx]
    double average_luminance = 0;     ///< over the solid angle [cd/m²]
    std::vector<GlareSource> sources;  ///< the worst first
    std::size_t dropped = 0;           ///< pixels without a luminance, counted as not there
};

/// Daylight glare probability of a fisheye picture. A black one, or one all of whose pixels were
/// dropped, has no sources and an illuminance of 0.
/// @param view  type a or h, 180 degrees, neither shifted nor lifted, else InputError; InputError
///              also as of Camera, visual_field() and find_glare_sources()
/// Source: Wienold & Christoffersen 2006 (see dgp.h).
[[nodiscard]] GlareReport analyse_glare(const FieldPicture& picture, const View& view,
                                        const GlareParams& params = {});

/// What a pixel's luminance is to the glare probability.
struct GlareShare {
    PixelPlace place;      ///< y from the bottom
    double luminance = 0;  ///< [cd/m²]
    double slope = 0;      ///< of analyse_glare().dgp, by that luminance [m²/cd]
};

/// Of all pixels before the eye: how much dgp changes with each, while sources have the same pixels
/// and lie where they are. Arguments and errors as those of analyse_glare().
[[nodiscard]] std::vector<GlareShare> glare_shares(const FieldPicture& picture, const View& view,
                                                   const GlareParams& params = {});

}  // namespace lightwalk
