#pragma once
// What ranks say to each other while they draw the frames of a walk. Kinds of Message; see there.
#include <cstdint>
#include <string>
#include <vector>

#include "core/cloud/ageing.h"
#include "core/cloud/point.h"
#include "core/cloud/progressive.h"
#include "core/view/pixels.h"
#include "parallel/walk/cloud_frame.h"
#include "parallel/walk/cloud_region.h"

namespace lightwalk {

/// Number of a frame of a walk: CloudRules::frame.
using WalkFrameId = std::uint64_t;

/// Program of rank 0 to the master, and that one to all workers: the next frame.
struct CloudOrder {
    std::int32_t width = 0, height = 0;
    CloudRules rules;
    std::string payload;        ///< what the tracer makes of it: the view
    double budget = 0;          ///< see CloudOptions [s]
    bool rest_follows = false;  ///< the next frame has the same view: say where pixels come from
    // Or the view is that of the frame before: nothing but these pixels is traced.
    bool rests = false;
    bool leaves = false;      ///< points of these pixels
    std::int32_t sample = 0;  ///< see PixelCaster
    std::vector<PixelPlace> refined;
};

/// Tracer to the worker of another rank that owns a part of the picture: points that the frame
/// shows there, or a pixel beside it. Each owner sends one to each other one.
struct CloudPoints {
    WalkFrameId frame = 0;
    std::vector<CloudPoint> points;
};

/// And which of these were used, to the owners of the parts beside the own one. It sends one to
/// each.
struct CloudUsed {
    WalkFrameId frame = 0;
    UsedPixels used;
};

/// Tracer to its own worker, and that one to the master: pixels of its part that are to be traced.
struct UncachedPixels {
    WalkFrameId frame = 0;
    std::uint32_t noise_pairs = 0;   ///< so many of the last places are to be traced by other rays
    std::vector<PixelPlace> places;  ///< that messages name by their number
};

/// Tracer to master: this many pieces of work more are wanted.
struct AskUncachedPixels {
    std::uint32_t count = 0;
};

/// Master to worker, and that one to its tracer: pixels of one part that are to be traced.
struct GiveUncachedPixels {
    WalkFrameId frame = 0;
    std::uint32_t owner = 0;         ///< of the part, among the workers
    std::uint32_t first = 0;         ///< number of the first of them
    bool noise_pairs = false;        ///< by other rays
    bool at_once = false;            ///< whatever the time is
    std::vector<PixelPlace> places;  ///< none: the frame has no more work
};

/// Tracer to the worker that owns the pixels.
struct TracedPixelResults {
    WalkFrameId frame = 0;
    std::uint32_t first = 0, count = 0;     ///< numbers of the pixels
    std::vector<TracedPixelResult> traced;  ///< none: it was too late for them
};

/// Worker to its own tracer: of the others ...
struct CloudStage {
    enum class Kind : std::uint8_t {
        points,  ///< all points are there
        pixels,  ///< all pixels are there, and it is known which points were used
    };
    WalkFrameId frame = 0;
    Kind kind = Kind::points;
};

/// Tracer to its own worker, and that one to the master: its part of the frame.
struct CloudPart {
    WalkFrameId frame = 0;
    PixelRectangle area;
    std::string pixels;  ///< compressed (encode_piece); where nothing is known the distance is -1
    CloudReport report;
    AgeCounts ages{};                  ///< of the points that it keeps
    std::vector<PixelOrigin> origins;  ///< row by row from the bottom, where they are wanted
    std::vector<PixelValue> refined;   ///< in the order of the order's, where the distance is -1
                                       ///< there was no time
};

/// Master to program: all parts are there.
struct FinishedFrame {
    WalkFrameId frame = 0;
    std::vector<CloudPart> parts;
};

}  // namespace lightwalk
