#pragma once
// What ranks share out: pictures in blocks, streams of rays in chunks, and the uncached pixels of
// walks in runs. Each is a payload of the one work queue.
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/cloud/region_points.h"
#include "core/cloud/trace_list.h"
#include "core/view/pixels.h"
#include "parallel/walk/frame_order.h"

namespace lightwalk {

/// Number of a picture, or of another area that is handed out in blocks.
using JobId = std::uint32_t;

/// A picture that is to be rendered; all ranks hear of it before its first block.
struct PictureJob {
    JobId job = 0;
    PixelRectangle area;         ///< all pixels of the job
    std::int32_t alignment = 1;  ///< blocks whose corners lie at multiples of it cost least
    bool keep = true;     ///< false: pixels are not wanted, only what tracing them leaves behind
    std::string payload;  ///< view and options, for whoever makes the renderer
    /// Pixels that an earlier run has left; the program sends them to their owners.
    std::vector<PixelRectangle> known;
    bool log = false;  ///< the program of rank 0 wants every finished block as well
    friend bool operator==(const PictureJob&, const PictureJob&) = default;
};

struct JobBlock {
    JobId job = 0;
    PixelRectangle block;
    friend bool operator==(const JobBlock&, const JobBlock&) = default;
};

/// Rays that one thread traces.
struct RayChunk {
    std::uint64_t number = 0;     ///< of the chunk, from 0
    std::uint64_t first = 0;      ///< number of its first ray among all rays of the input
    std::vector<double> numbers;  ///< six a ray: origin and direction
    [[nodiscard]] std::size_t rays() const { return numbers.size() / 6; }
    friend bool operator==(const RayChunk&, const RayChunk&) = default;
};

/// Uncached pixels of one part of a walk's frame.
struct PixelRun {
    FrameNumber frame = 0;
    std::uint32_t owner = 0;   ///< of the part, among the workers
    std::uint32_t first = 0;   ///< number of the first of them among the part's
    bool noise_pairs = false;  ///< to be traced by other rays than the pixels' own
    bool at_once = false;      ///< whatever the time is
    std::vector<PixelPlace> places;
    friend bool operator==(const PixelRun&, const PixelRun&) = default;
};

using Work = std::variant<JobBlock, RayChunk, PixelRun>;

// What tracing a piece of work gives.

struct Pixels {
    JobBlock work;
    std::vector<PixelValue> values;  ///< row by row from the bottom; none in simulations
    std::vector<Rgb> groups =
        {};  ///< what light groups add, by pixel, then group; empty: no layers
    friend bool operator==(const Pixels&, const Pixels&) = default;
};
/// What a chunk's rays say, as it is to be written.
struct RayAnswer {
    std::uint64_t number = 0;
    std::string bytes;
    friend bool operator==(const RayAnswer&, const RayAnswer&) = default;
};
struct TracedRun {
    FrameNumber frame = 0;
    std::uint32_t owner = 0, first = 0, count = 0;  ///< as in the run
    std::vector<TracedPixelResult> traced;     ///< the first ones; for the others it was too late
    std::vector<Rgb> groups = {}, ahead = {};  ///< of these; see TracedPixels
};
using TracedWork = std::variant<Pixels, RayAnswer, TracedRun>;

/// Which payload, how much of it, and how long it took.
struct FinishedWork {
    enum class Payload : std::uint8_t { block, rays, pixels };
    Payload payload = Payload::block;
    JobId job = 0;            ///< of blocks
    std::uint32_t count = 0;  ///< pixels or rays
    double seconds = 0;
    std::optional<FrameNumber> late = std::nullopt;  ///< frame of pixels that there was no time for
    friend bool operator==(const FinishedWork&, const FinishedWork&) = default;
};

}  // namespace lightwalk
