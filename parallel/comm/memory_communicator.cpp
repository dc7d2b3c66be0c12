// Ranks that are threads of one process.
#include <condition_variable>
#include <deque>
#include <mutex>

#include "parallel/comm/communicator.h"

namespace lightwalk {
namespace {

struct Inbox {
    std::mutex mutex;
    std::condition_variable changed;
    std::deque<Communicator::Packet> packets;
    std::deque<std::string> broadcasts;  ///< of rank 0
    bool woken = false;
    std::optional<int> aborted;
};

class MemoryCommunicator final : public Communicator {
  public:
    MemoryCommunicator(std::shared_ptr<std::vector<Inbox>> inboxes, int rank)
        : inboxes_(std::move(inboxes)), rank_(rank) {}

    [[nodiscard]] int rank() const override { return rank_; }
    [[nodiscard]] int size() const override { return static_cast<int>(inboxes_->size()); }
    [[nodiscard]] std::string host() const override { return "memory"; }
    [[nodiscard]] bool on_one_machine() const override { return true; }
    [[nodiscard]] int first_on_machine() const override { return 0; }

    void send(int to, std::string bytes) override {
        change(to, [&](Inbox& inbox) { inbox.packets.push_back({rank_, std::move(bytes)}); });
    }

    [[nodiscard]] std::optional<Packet> receive() override {
        Inbox& inbox = of(rank_);
        const std::lock_guard lock(inbox.mutex);
        if (inbox.aborted) throw Aborted{*inbox.aborted};
        if (inbox.packets.empty()) return std::nullopt;
        Packet packet = std::move(inbox.packets.front());
        inbox.packets.pop_front();
        return packet;
    }

    void wait(std::chrono::microseconds most) override {
        Inbox& inbox = of(rank_);
        std::unique_lock lock(inbox.mutex);
        inbox.changed.wait_for(
            lock, most, [&] { return !inbox.packets.empty() || inbox.woken || inbox.aborted; });
        inbox.woken = false;
    }

    void wake() override {
        change(rank_, [](Inbox& inbox) { inbox.woken = true; });
    }

    [[nodiscard]] std::string broadcast(std::string bytes, FunctionRef<void()> meanwhile) override {
        if (rank_ == 0) {
            for (int to = 1; to < size(); ++to)
                change(to, [&](Inbox& inbox) { inbox.broadcasts.push_back(bytes); });
            return bytes;
        }
        Inbox& inbox = of(rank_);
        std::unique_lock lock(inbox.mutex);
        constexpr std::chrono::milliseconds kPatience{1};
        const auto there = [&] { return !inbox.broadcasts.empty() || inbox.aborted; };
        while (!inbox.changed.wait_for(lock, kPatience, there)) {
            lock.unlock();
            meanwhile();
            lock.lock();
        }
        if (inbox.aborted) throw Aborted{*inbox.aborted};
        std::string got = std::move(inbox.broadcasts.front());
        inbox.broadcasts.pop_front();
        return got;
    }

    void flush() override {}

    [[noreturn]] void abort(int status) override {
        for (int rank = 0; rank < size(); ++rank)
            change(rank, [&](Inbox& inbox) { inbox.aborted = status; });
        throw Aborted{status};
    }

  private:
    [[nodiscard]] Inbox& of(int rank) const { return (*inboxes_)[static_cast<std::size_t>(rank)]; }
    /// Change a rank's inbox, and wake it where it waits.
    template <class Change>
    void change(int rank, Change change_inbox) const {
        Inbox& inbox = of(rank);
        {
            const std::lock_guard lock(inbox.mutex);
            change_inbox(inbox);
        }
        inbox.changed.notify_one();
    }

    std::shared_ptr<std::vector<Inbox>> inboxes_;
    int rank_;
};

}  // namespace

std::vector<std::unique_ptr<Communicator>> make_memory_communicators(int ranks) {
    const auto inboxes = std::make_shared<std::vector<Inbox>>(static_cast<std::size_t>(ranks));
    std::vector<std::unique_ptr<Communicator>> ends;
    ends.reserve(static_cast<std::size_t>(ranks));
    for (int rank = 0; rank < ranks; ++rank)
        ends.push_back(std::make_unique<MemoryCommunicator>(inboxes, rank));
    return ends;
}

}  // namespace lightwalk
