#pragma once
// One picture on a machine that need not exist: the roles of the real program, and a clock.
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <queue>
#include <random>
#include <variant>
#include <vector>

#include "parallel/ranks/rank_report.h"
#include "parallel/ranks/rank_roles.h"
#include "perf/model/ambient_sites.h"
#include "perf/model/cost_map.h"
#include "perf/model/machine.h"
#include "perf/model/processors.h"

namespace lightwalk {

/// A run: what its command line says.
struct SimulatedRun {
    Variant variant = Variant::ranks;
    int ranks = 2, threads = 1;
    int width = 640, height = 480;
    int alignment = 8;
    int block = 0, stride = 0, masters = 0;  ///< 0: auto
    int ambient_batch = 16;
    bool ambient = false;
    std::uint64_t seed = 1;
};

struct Prediction {
    double seconds = 0;          ///< from the request to the picture
    double tracing_seconds = 0;  ///< of all threads
    double master_seconds = 0;   ///< that rank 0's messages took a core
    double busiest_seconds = 0;  ///< that the messages of any other rank did
    std::size_t blocks = 0;
    std::uint64_t values_made = 0;  ///< by all ranks
    std::size_t values_needed = 0;  ///< by one that makes all
    /// Of 2 x workers Pixels messages in a row, those that go to one owner: the mean of the largest
    /// shares.
    double owner_share = 0;
    MessageCounts messages;
};

class Simulation {
  public:
    Simulation(const CostMap& map, const Machine& machine, const SimulatedRun& run);
    ~Simulation();
    /// Until the picture is there. Throws std::logic_error when nothing happens any more before.
    [[nodiscard]] Prediction run();

  private:
    struct Rank;
    struct Task;
    /// A message that has arrived, or something that a rank's threads or program want of its roles.
    using Step = std::function<void(RankRoles& roles, Outbox& out)>;
    struct Posted {
        Step step;
        double work = 0;  ///< processor time beyond that of any step [s]
    };
    using Input = std::variant<Envelope, Posted>;
    enum class Kind : std::uint8_t { arrive, wake, traced, trace, request };
    struct Event {
        double time = 0;
        std::uint64_t number = 0;  ///< events of one time come in the order of their making
        Kind kind = Kind::wake;
        std::uint32_t rank = 0;  ///< or node
        std::uint32_t what = 0;  ///< message or version
        bool operator<(const Event& other) const {
            return time != other.time ? time > other.time : number > other.number;
        }
    };

    void make_roles();
    void start_threads();
    void submit();
    void at(double time, Kind kind, std::size_t rank, std::uint32_t what = 0);
    void act(const Event& event);

    // Messages.
    void post(std::size_t rank, Posted posted);
    void put_in(std::size_t rank, Input input, double look);
    [[nodiscard]] double next_look(const Rank& rank) const;
    [[nodiscard]] double eager_looks(const Rank& rank) const;
    void handle_messages(std::size_t rank);
    void dispatch(std::size_t rank, Input input, double& clock);
    void take_step(std::size_t rank, const Step& step, std::vector<Envelope>& due, double& clock);
    void handle(std::size_t rank, TracerNews news, double& clock);
    void handle(std::size_t rank, const AmbientValues& news, double& clock);
    void handle(const ProgramNews& news, double& clock);
    void send(Envelope envelope, double& clock);
    [[nodiscard]] double bytes_of(const Envelope& envelope) const;

    // Tracing.
    void trace(std::size_t rank);
    void begin(std::size_t rank, const JobBlock& work);
    void next_step(int task);
    void end_step(int task);
    void finish(int task);
    void count_owner(int owner);
    [[nodiscard]] double make_values(Task& task, const PixelRectangle& part);
    void keep(std::size_t rank, std::uint32_t value);
    [[nodiscard]] std::size_t node_of(std::size_t rank) const;
    void look_ahead(std::size_t node);
    [[nodiscard]] bool is_prepass(JobId job) const { return job < picture_; }

    CostMap map_;
    Machine machine_;
    SimulatedRun run_;
    BlockCosts picture_costs_;
    BlockCosts prepass_costs_;
    PixelRectangle prepass_area_;
    std::unique_ptr<AmbientSites> sites_;
    Topology topology_;
    double shortest_wait_ = 0, longest_wait_ = 0;  ///< see Patience [s]
    JobId picture_ = 0;                            ///< number of the picture's job
    std::vector<Rank> ranks_;
    std::vector<Processors> nodes_;
    std::vector<std::uint32_t> versions_;  ///< of what is known of a node's next end
    std::vector<Task> tasks_;
    std::vector<int> free_tasks_;
    std::vector<Envelope> messages_;  ///< on their way
    std::vector<std::uint32_t> free_messages_;
    std::priority_queue<Event> events_;
    std::uint64_t next_event_ = 0;
    std::size_t threads_blocks_ = 0, threads_done_ = 0;  ///< without ranks
    double now_ = 0;
    double end_ = std::numeric_limits<double>::infinity();
    std::vector<std::uint32_t> needed_;
    std::vector<std::uint32_t> owners_;  ///< of the last Pixels messages: how many each got
    std::uint32_t owners_counted_ = 0, owner_windows_ = 0;
    Prediction prediction_;
};

/// What one thread of one process takes, without any message: the base of speed-ups.
[[nodiscard]] double seconds_on_one(const CostMap& map, const Machine& machine,
                                    const SimulatedRun& run);

}  // namespace lightwalk
