#pragma once
// A frame drawn from points: what it is to be, what it took, what it is.
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/cloud/ageing.h"
#include "core/cloud/progressive.h"
#include "core/cloud/reuse.h"
#include "core/math/rgb.h"
#include "core/view/pixels.h"

namespace lightwalk {

/// Of which pixels a ray verifies what the points say.
enum class CloudCheck {
    none,      ///< of none: only the points' own depths tell what is hidden
    edges,     ///< where new things may come into view
    rotating,  ///< of all but those that a surface already shown seems to go through; of these by
               ///< lot, tile by tile, and others in each frame. Where there is a budget most of
               ///< it is left for other things: what rays come too late for, points tell alone
    all,
};

struct CloudOptions {
    bool supersaturated = true;  ///< keep points that a frame does not use
    CloudCheck check = CloudCheck::all;
    ReuseRules rules{};
    int age = 25;            ///< frames that a point outlives without use
    double limit = 4;        ///< most points, as a multiple of the pixels
    double tolerance = 0.1;  ///< how far a view-dependent colour may be off, as a share
    double audit = 0;        ///< share of the reused pixels that are traced all the same
    double audit_limit = 0;  ///< see ReuseErrorController
    double budget = 0;       ///< of a frame: what does not fit is filled from around; 0: none [s]
    double refine = 0;       ///< share of the pixels that are refined in a frame whose view is
                             ///< that of the frame before
    int samples = ProgressivePicture::kMostSamples;  ///< rays that edges get then
    std::uint64_t seed = 0;                          ///< of the audit's choice
    std::size_t light_groups = 0;  ///< whose light points keep, to be mixed anew; 0: none

    /// Most points of a picture's cloud.
    [[nodiscard]] std::size_t most_points(int width, int height) const {
        return static_cast<std::size_t>(limit * static_cast<double>(width) *
                                        static_cast<double>(height));
    }
};

/// What a frame took, or a part of it.
struct CloudReport {
    std::size_t pixels = 0;    ///< all of the picture
    std::size_t reused = 0;    ///< answered by points, audited and refined ones included
    std::size_t filled = 0;    ///< shown for a moment: there was no time for them
    std::size_t inferred = 0;  ///< of these: from points or pixels of the surface that they show
    std::array<std::size_t, kTraceCauses> uncached{};  ///< traced pixels, by cause (TraceCause)
    std::size_t points = 0;                            ///< in the cloud after the frame
    std::uint64_t rays = 0;                            ///< of all ranks, where many draw the frame
    double project_seconds = 0, check_seconds = 0, trace_seconds = 0, infer_seconds = 0,
           keep_seconds = 0;
    double tightness = 1;             ///< of reuse (ReuseErrorController)
    std::vector<float> audit_errors;  ///< of audited pixels: relative error of their luminance
    std::vector<float> audit_floors;  ///< of some of these: difference of two rays of the pixel
};

/// A drawn frame, or a part of it, row by row from the bottom.
struct CloudFrame {
    PixelRectangle area;             ///< of the picture
    std::vector<Rgb> radiance;       ///< [W/(m² sr)]
    std::vector<float> distance;     ///< along the pixels' rays; 0 where there is no ray [m]
    std::vector<TraceCause> causes;  ///< why each pixel was traced or filled; none: it was not
    /// Not 0 where a pixel shows something that is better than what its neighbours tell.
    std::vector<std::uint8_t> known;
    /// What the rays of known pixels meet (PrimaryVisibility::surface), where there is a budget; 0:
    /// something that tells nothing of what lies beside it.
    std::vector<std::uint32_t> surfaces;
    std::vector<std::uint8_t> patterns;  ///< of these surfaces there (encode_pattern)
    std::vector<PixelOrigin> origins;    ///< where pixels come from, where somebody wants to know
    CloudReport report;
    bool complete = false;  ///< false: stopped early
};

/// The rules of a frame, which all who draw parts of it must know.
struct CloudRules {
    std::uint64_t frame = 0;  ///< its number
    bool empty = true;        ///< no frame has left points yet
    double tightness = 1;     ///< of reuse (ReuseErrorController)
    friend bool operator==(const CloudRules&, const CloudRules&) = default;
};

}  // namespace lightwalk
