#pragma once
// One rank's messages, served: to its roles, and to what is within it.
#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "parallel/ranks/chunk_roles.h"
#include "parallel/ranks/cloud_roles.h"
#include "parallel/ranks/local_end.h"
#include "parallel/ranks/message_counts.h"
#include "parallel/ranks/roles.h"
#include "parallel/ranks/timeline.h"
#include "parallel/ranks/topology.h"
#include "parallel/ranks/transport.h"
#include "parallel/stop_flag.h"

namespace lightwalk {

struct RankSettings {
    int slots = 1;                   ///< threads that trace on each worker
    int ahead = 1;                   ///< blocks that wait on each worker
    int block = 0, stride = 0;       ///< see BlockPolicy
    std::size_t ambient_batch = 16;  ///< values a message; 0: none are exchanged
    EncodePiece encode;
    bool rays = false;  ///< chunks of rays are traced, and no pictures; one master for all
    /// Frames of a walk are drawn from points, whose parts so many of the workers own at most; one
    /// master for all. 0: pictures are traced
    int projectors = 0;
};

/// How soon a rank's loop looks again after a message has come (soon there will be more), and how
/// late at most: each time it finds nothing it waits twice as long. Looking takes some 10 us of a
/// core: where threads have blocks ahead of them, and lose nothing by a later answer, it is done
/// less. Without other ranks nothing comes by itself but a signal's request to stop.
struct Patience {
    std::chrono::microseconds shortest, longest;
};
[[nodiscard]] Patience patience_of(const Topology& topology);

/// Serves the messages of one rank on the thread that calls run(). Where nothing is to be done it
/// sleeps: it takes no core from those who trace.
class RankLoop {
  public:
    /// `transport`, `topology` and `local` must outlive this.
    /// @param timeline  whose last row is this loop's; null: none
    RankLoop(Transport& transport, const Topology& topology, const RankSettings& settings,
             LocalEnd& local, Timeline* timeline = nullptr);

    /// A message to a role of this rank, or to any other's. From any thread.
    void post(Role from, Address to, Message message);

    /// Every rank gives bytes and gets everyone's, in the order of the ranks; waits for the
    /// slowest. From any thread but the one that runs run(), by one thread at a time, and by all
    /// ranks the same number of times. Throws Aborted when the loop ends before.
    [[nodiscard]] std::vector<std::string> all_gather(std::string bytes) {
        return gather(std::move(bytes), false);
    }
    /// The same among the workers alone, in the order of the topology's. Once one has begun, no
    /// more all_gather.
    [[nodiscard]] std::vector<std::string> gather_among_tracers(std::string bytes) {
        return gather(std::move(bytes), true);
    }
    /// Rank 0's bytes, on every rank; called as all_gather is. This rank's messages wait meanwhile.
    [[nodiscard]] std::string broadcast(std::string bytes);

    /// Until end() is called, or `stop` is requested. Asks for the first blocks by itself.
    /// False: stopped.
    [[nodiscard]] bool run(const StopFlag& stop);
    /// This rank has no more to say, from any thread. Its loop ends when all ranks' have been told
    /// so, and nothing is on its way to anyone any more.
    void end();

    /// What this rank has sent so far; from any thread.
    [[nodiscard]] MessageCounts counts() const {
        const std::lock_guard lock(counts_mutex_);
        return counts_;
    }

  private:
    void make_block_roles(const RankSettings& settings);
    void make_chunk_roles(const RankSettings& settings);
    void make_cloud_roles(const RankSettings& settings);
    void begin();
    void say_goodbye();
    void exchange_values_in_time();
    void exchange_values();
    void serve_broadcast();
    [[nodiscard]] bool serve_posted();
    [[nodiscard]] bool serve_arrived();
    void dispatch(Envelope envelope);
    void deliver(Envelope envelope, Outbox& out);
    [[nodiscard]] std::vector<std::string> gather(std::string bytes, bool tracers);
    void serve_gather(Envelope envelope, Outbox& out);
    [[nodiscard]] static Activity activity_of(const Message& message);
    [[nodiscard]] EncodePiece timed_encoding(EncodePiece encode) const;

    Transport& transport_;
    const Topology& topology_;
    LocalEnd& local_;
    Timeline* timeline_;
    std::optional<MasterRole> master_;
    std::optional<SubMasterRole> sub_master_;
    std::optional<WorkerRole> worker_;
    std::optional<ChunkMasterRole> chunk_master_;  ///< where rays are traced
    std::optional<ChunkWorkerRole> chunk_worker_;
    std::optional<CloudMasterRole> cloud_master_;  ///< where walks are drawn
    std::optional<CloudWorkerRole> cloud_worker_;
    std::optional<AmbientMasterRole> ambient_master_;
    std::optional<AmbientClientRole> ambient_client_;
    mutable std::mutex counts_mutex_;
    MessageCounts counts_;                             ///< guarded by it
    std::chrono::steady_clock::time_point exchanged_;  ///< when values were, last

    std::mutex mutex_;  ///< guards what follows
    std::condition_variable answered_;
    std::deque<Envelope> posted_;
    bool ended_ = false;  ///< by this rank
    bool over_ = false;   ///< the loop
    std::optional<std::vector<std::string>> gathered_;
    std::optional<std::string> to_broadcast_, broadcast_;
    std::uint32_t round_ = 0;

    enum class ShutdownPhase {
        none,     ///< this rank has not ended
        telling,  ///< its last ambient values
        told,     ///< waits until all have
        heard,    ///< all have
        hearing,  ///< what the others told
        said,     ///< goodbye: waits until all have
        over,
    };
    ShutdownPhase shutdown_ = ShutdownPhase::none;
    struct Round {
        std::vector<std::string> parts;
        int missing = 0;
    };
    std::map<std::uint32_t, Round> rounds_;  ///< on rank 0: not yet complete
};

}  // namespace lightwalk
