#pragma once
// What a step of a rank's roles gives out.
#include <utility>
#include <variant>
#include <vector>

#include "parallel/work_queue/message.h"

namespace lightwalk {

/// How far a picture is.
struct Progress {
    JobId job = 0;
    double done = 0;  ///< share of its pixels, 0 ... 1
};
/// All parts of a picture are there.
struct FinishedPicture {
    JobId job = 0;
    std::vector<PicturePart> parts;
};
/// Backpressure of a stream of rays: this many chunks more are wanted.
struct ChunksWanted {
    std::uint32_t chunks = 0;
    std::uint32_t rays = 0;  ///< about so many in each
};

/// Another rank's program has something to say.
struct RankNotice {
    int from = 0;
    Notice notice;
};

/// For the program of this rank.
using ProgramNews = std::variant<Progress, FinishedPicture, ChunksWanted, RayAnswer, FinishedFrame,
                                 LoggedPixels, RankNotice>;
/// For the threads of this rank that trace.
using TracerNews =
    std::variant<PictureJob, FrameOrder, ChangeOrder, WorkGrant, PointExchange, TracedRun>;

struct Outbox {
    std::vector<Envelope> messages;  ///< to ranks, the own one included, in order
    std::vector<TracerNews> tracers;
    std::vector<ProgramNews> program;
    std::vector<AmbientValues> cache;
    std::vector<Collective> results;  ///< of collective operations
};

}  // namespace lightwalk
