#pragma once
// Processes that compute together, as threads of one process.
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "parallel/comm/group.h"

namespace lightwalk::test {

/// Processes in memory: threads that meet.
class Meeting {
  public:
    explicit Meeting(int count) : parts_(static_cast<std::size_t>(count)) {}
    std::vector<std::string> all_gather(std::size_t index, std::string mine) {
        std::unique_lock lock(mutex_);
        parts_[index] = std::move(mine);
        const std::uint64_t round = round_;
        if (++arrived_ == parts_.size()) {
            gathered_ = parts_;
            arrived_ = 0;
            ++round_;
            changed_.notify_all();
        } else {
            changed_.wait(lock, [&] { return round_ != round; });
        }
        return gathered_;
    }

  private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<std::string> parts_, gathered_;
    std::size_t arrived_ = 0;
    std::uint64_t round_ = 0;
};

class MeetingExchange final : public Group {
  public:
    /// @param listeners  0 or 1: those whose index is -1, who come last
    MeetingExchange(Meeting& meeting, int index, int count, int listeners = 0)
        : meeting_(meeting), index_(index), count_(count), listeners_(listeners) {}
    [[nodiscard]] int index() const override { return index_; }
    [[nodiscard]] int size() const override { return count_; }
    [[nodiscard]] int parts() const override { return count_ + listeners_; }
    [[nodiscard]] std::vector<std::string> all_gather(std::string mine) override {
        const int place = index_ < 0 ? count_ : index_;
        return meeting_.all_gather(static_cast<std::size_t>(place), std::move(mine));
    }

  private:
    Meeting& meeting_;
    int index_, count_, listeners_;
};

}  // namespace lightwalk::test
