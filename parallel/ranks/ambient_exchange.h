#pragma once
// Ambient values shared by ranks: one of them gathers all, and passes on to each what it lacks.
#include <cstddef>
#include <unordered_map>
#include <utility>
#include <vector>

#include "parallel/work_queue/outbox.h"

namespace lightwalk {

/// Gathers the ambient values of its clients and passes to each what the others found.
class AmbientMaster {
  public:
    explicit AmbientMaster(int self) : self_(self) {}
    /// An offer comes in, news go out. Of several scenes those of the last one are kept: the first
    /// values of a scene come when all ranks have left the one before.
    void handle(int from, AmbientValues offer, Outbox& out);
    [[nodiscard]] std::size_t size() const { return records_.size(); }

  private:
    int self_;
    std::vector<AmbientRecord> records_;         ///< in the order of their arrival
    std::vector<int> sources_;                   ///< ranks they came from
    std::unordered_map<int, std::size_t> told_;  ///< records that a rank knows
    std::uint32_t scene_ = 0;                    ///< that they are of
};

/// A rank's own new values go out by the batch, one offer at a time.
class AmbientClient {
  public:
    AmbientClient(int self, int master, std::size_t batch)
        : self_(self), master_(master), batch_(batch) {}
    /// Values of the own cache. None: it wants to know what there is.
    void offer(AmbientValues own, Outbox& out);
    /// The master's answer, for the own cache.
    void handle(AmbientValues news, Outbox& out);
    /// Ask, whether or not a batch is full.
    void ask(Outbox& out);
    [[nodiscard]] bool waits_for_answer() const { return asked_; }
    /// No more questions from now on.
    void close() { batch_ = static_cast<std::size_t>(-1); }

  private:
    int self_, master_;
    std::size_t batch_;
    bool asked_ = false;
    AmbientValues own_;  ///< of the scene at hand
};

}  // namespace lightwalk
