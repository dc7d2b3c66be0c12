#pragma once
// Ambient values shared by ranks: one of them gathers all, and passes on to each what it lacks.
#include <cstddef>
#include <functional>
#include <mutex>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/ambient/ambient_listener.h"
#include "parallel/published_cache.h"
#include "parallel/work_queue/outbox.h"

namespace lightwalk {

/// Gathers the ambient values of its clients and passes to each what the others found: those of the
/// newest scene that it has heard of.
class AmbientMaster {
  public:
    explicit AmbientMaster(int self) : self_(self) {}
    /// An offer comes in, news go out.
    void handle(int from, const AmbientValues& offer, Outbox& out);
    /// The scene that the values are of is done with: forgets them.
    void clear();
    [[nodiscard]] std::size_t size() const { return known_.records.size(); }

  private:
    int self_;
    AmbientValues known_;                        ///< in the order of their arrival
    std::vector<int> sources_;                   ///< ranks they came from
    std::unordered_map<int, std::size_t> told_;  ///< records that a rank knows
};

/// A rank's own new values go out by the batch, one offer at a time.
class AmbientClient {
  public:
    AmbientClient(int self, int master, std::size_t batch)
        : self_(self), master_(master), batch_(batch) {}
    /// Values of the own cache.
    void offer(const AmbientValues& own, Outbox& out);
    /// The master's answer, for the own cache.
    void handle(AmbientValues news, Outbox& out);
    /// Ask, whether or not a batch is full; where an offer is out, after its answer.
    void ask(Outbox& out);
    /// The scenes that the values are of are done with.
    void clear() { own_ = {}; }
    /// Nothing that was offered or asked so far is still to be sent or answered.
    [[nodiscard]] bool is_flushed() const { return !asked_; }

  private:
    int self_, master_;
    std::size_t batch_;
    bool asked_ = false, again_ = false;
    AmbientValues own_;  ///< of the newest scene
};

/// A rank's cache as one of those that share their values, scene after scene.
class SharedCache final : public AmbientListener {
  public:
    /// @param batch  values that `send` is called with at once, at least 1; it is called by
    ///               whichever thread made the last of them
    SharedCache(std::size_t batch, std::function<void(AmbientValues)> send)
        : batch_(batch), send_(std::move(send)) {}

    /// From now on new values of the cache go to the others, and it gets theirs; the one before
    /// gets none. Not while rays are traced.
    /// @param cache  must outlive what traces, and close() or the next open()
    /// @param scene  see AmbientValues
    void open(PublishedCache& cache, std::uint64_t scene = 0);
    void close();
    [[nodiscard]] bool is_open() const;

    /// A value that was made here; from any thread.
    void stored(const AmbientRecord& record, std::span<const Rgb> groups) override;
    /// Values that do not make a batch yet; they are not sent any more.
    [[nodiscard]] AmbientValues unsent();
    /// Values of others.
    void merge(const AmbientValues& news);

  private:
    std::size_t batch_;
    std::function<void(AmbientValues)> send_;
    mutable std::mutex mutex_;  ///< guards what follows
    PublishedCache* cache_ = nullptr;
    AmbientValues own_;  ///< of the cache's scene
};

}  // namespace lightwalk
