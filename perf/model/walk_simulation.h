#pragma once
// A walk on a machine that need not exist: the roles of the real program, and a clock.
#include <cstdint>
#include <deque>
#include <functional>
#include <queue>
#include <random>
#include <vector>

#include "parallel/ranks/rank_frame_exchange.h"
#include "parallel/ranks/rank_roles.h"
#include "perf/model/machine.h"

namespace lightwalk {

/// What the steps of a frame took in a real walk, of one core [s], and how much of what there was.
struct WalkCosts {
    double project = 0;             ///< a point
    double check = 0;               ///< a pixel
    double trace = 0;               ///< a pixel that no point answers
    double keep = 0;                ///< a point
    double encode = 0, decode = 0;  ///< a pixel of a part that goes to rank 0
    double packed_bytes = 8;        ///< of a part, a pixel
    double points = 1;              ///< a pixel
    double uncached = 0.03;         ///< share of the pixels that no point answers
    double shift = 0.01;            ///< by which points move in a frame, as a share of the width
};

/// A walk on `ranks` of `threads`, all of which trace, and whose rank 0 deals out the work.
struct SimulatedWalk {
    int ranks = 1, threads = 1;
    int projectors = 32;  ///< so many ranks at most keep points
    int width = 640, height = 480;
    int frames = 5;
    std::uint64_t seed = 1;
};

/// Means of the frames after the first [s].
struct WalkPrediction {
    double seconds = 0;  ///< from order to order
    // Of these, one after the other, until the last rank has
    double projected = 0;            ///< all points that its part shows,
    double checked = 0;              ///< found the pixels that none answers,
    double traced = 0;               ///< got these from those who traced them;
    double gathered = 0;             ///< then until the frame is there
    double master_busy = 0;          ///< share of the time that rank 0's messages took a core
    double bytes_a_frame = 0;        ///< between ranks
    double uncached_of_fullest = 0;  ///< most uncached pixels of one part, beside the mean
};

/// Each rank's threads have a core each, and so has the loop that serves its messages. Work is
/// spread evenly over a part; its uncached pixels vary by half.
class WalkSimulation {
  public:
    WalkSimulation(const WalkCosts& costs, const Machine& machine, const SimulatedWalk& walk);
    /// Throws std::logic_error when nothing happens any more before the last frame is there.
    [[nodiscard]] WalkPrediction run();

  private:
    struct Rank {
        explicit Rank(RankRoles its_roles) : roles(std::move(its_roles)) {}
        RankRoles roles;
        // Of the frame at hand, what the owner of a part has got from the others.
        std::size_t points = 0, used = 0, pixels = 0;
        std::optional<std::size_t> uncached;  ///< pixels that it waits for, once it has checked
        bool checks = false, gathers = false;
        int free_threads = 1;
        std::deque<std::pair<double, std::function<void()>>> work;  ///< that waits for a thread
        double loop_free = 0;                                       ///< when its loop is
        double wire_free = 0;  ///< when its next message may leave
        double handling = 0;   ///< processor time of messages
    };
    struct Event {
        double time = 0;
        std::uint64_t number = 0;  ///< events of one time come in the order of their making
        std::function<void()> act;
        bool operator<(const Event& other) const {
            return time != other.time ? time > other.time : number > other.number;
        }
    };

    void at(double time, std::function<void()> act);
    void order();
    void end_frame();

    // Threads.
    void use_thread(std::size_t rank, double seconds, std::function<void()> done);
    void use_all_threads(std::size_t rank, double seconds, std::function<void()> done);

    // Messages.
    template <class Step>
    void take_step(std::size_t rank, Step step);
    void post(std::size_t rank, std::size_t to, Message message);
    void send(std::vector<Envelope> messages);
    void handle(std::size_t rank, TracerNews news);
    void look_on(std::size_t rank);
    [[nodiscard]] double bytes_of(const Envelope& envelope) const;

    // Steps of a frame.
    void project(std::size_t rank);
    void check(std::size_t rank);
    void trace(std::size_t rank, const PixelRun& run);
    void gather(std::size_t rank);
    [[nodiscard]] double unpack_seconds() const;
    [[nodiscard]] double pixels_of(std::size_t owner) const;
    [[nodiscard]] FrameNumber frame() const { return static_cast<FrameNumber>(frames_done_) + 1; }
    [[nodiscard]] std::vector<std::size_t> beside(std::size_t owner) const {
        return owners_beside(SubImages({0, 0, walk_.width, walk_.height}, owners_), owner,
                             walk_.width, walk_.height);
    }
    [[nodiscard]] double points_from(std::size_t owner, std::size_t to) const;

    WalkCosts costs_;
    Machine machine_;
    SimulatedWalk walk_;
    std::mt19937_64 random_;
    std::size_t owners_;
    std::vector<PixelRectangle> parts_;
    std::vector<Rank> ranks_;
    std::priority_queue<Event> events_;
    std::uint64_t next_event_ = 0;
    double now_ = 0;
    int frames_done_ = 0;
    double ordered_ = 0, last_projected_ = 0, last_checked_ = 0, last_traced_ = 0;
    double most_uncached_ = 0, all_uncached_ = 0;
    WalkPrediction sums_;
    double measured_from_ = 0, handled_before_ = 0;
};

}  // namespace lightwalk
