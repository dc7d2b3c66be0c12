#pragma once
// All that one rank is to the others: queue, sub-queue, worker, keeper of ambient values.
#include <algorithm>
#include <memory>
#include <optional>

#include "parallel/ranks/ambient_exchange.h"
#include "parallel/ranks/collectives.h"
#include "parallel/ranks/piece_codec.h"
#include "parallel/ranks/pulse.h"
#include "parallel/ranks/rank_threads.h"
#include "parallel/ranks/timeline.h"
#include "parallel/ranks/topology.h"
#include "parallel/work_queue/outbox.h"
#include "parallel/work_queue/work_queue.h"
#include "parallel/work_queue/worker.h"

namespace lightwalk {

struct RankSettings {
    int slots = 1;                   ///< threads that trace on each worker
    int ahead = 1;                   ///< pieces of work that wait on each worker
    int block = 0, stride = 0;       ///< see BlockPolicy
    bool makes_values = false;       ///< likewise
    std::size_t ambient_batch = 16;  ///< values a message; 0: none are exchanged
    EncodePiece encode = encode_piece;
    Pulse::Times pulse = {};  ///< of ranks on several machines
    bool rays = false;        ///< a stream of rays is traced
    int projectors = 0;  ///< so many of the workers own parts of a walk's frames, at most; 0: none
    std::shared_ptr<RankThreads> threads = std::make_shared<RankThreads>();
};

/// How many of the workers own parts of frames: no more than `most`.
[[nodiscard]] inline std::size_t owners_of(std::size_t workers, int most) {
    return std::min(workers, static_cast<std::size_t>(std::max(most, 0)));
}

/// What a timeline calls the time that a rank takes to handle the message. Beside the handlers, so
/// that a new kind of message is one more row in one file.
[[nodiscard]] Activity activity_of(const Message& message);

/// The roles of one rank: pure steps, see work_queue.h.
class RankRoles {
  public:
    RankRoles(int rank, const Topology& topology, const RankSettings& settings);

    /// The first requests.
    void begin(Outbox& out);
    /// A message to this rank.
    void handle(int from, Message message, Outbox& out);

    [[nodiscard]] WorkQueue& queue() { return queue_.value(); }  ///< on rank 0
    [[nodiscard]] Worker& worker() { return worker_.value(); }   ///< on ranks that trace
    [[nodiscard]] std::optional<AmbientClient>& ambient_client() { return ambient_client_; }
    [[nodiscard]] std::optional<AmbientMaster>& ambient_master() { return ambient_master_; }
    [[nodiscard]] const Collectives& collectives() const { return collectives_; }

  private:
    void handle_result(WorkResult result, Outbox& out);

    int rank_;
    bool rays_;
    Collectives collectives_;
    std::optional<WorkQueue> queue_;
    std::optional<SubQueue> sub_queue_;
    std::optional<Worker> worker_;
    std::optional<AmbientMaster> ambient_master_;
    std::optional<AmbientClient> ambient_client_;
};

}  // namespace lightwalk
