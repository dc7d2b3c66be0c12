#pragma once
// New ambient values on their way to other ranks, in batches.
#include <cstddef>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

#include "core/ambient/ambient_listener.h"

namespace lightwalk {

/// Any number of threads may tell it of values.
class AmbientSender final : public AmbientListener {
  public:
    /// @param batch  values that `send` is called with at once, at least 1; it is called by
    ///               whichever thread made the last of them
    AmbientSender(std::size_t batch, std::function<void(std::vector<AmbientRecord>)> send)
        : batch_(batch), send_(std::move(send)) {}

    void stored(const AmbientRecord& record) override {
        std::vector<AmbientRecord> full;
        {
            const std::lock_guard lock(mutex_);
            own_.push_back(record);
            if (own_.size() < batch_) return;
            full.swap(own_);
        }
        send_(std::move(full));
    }

    /// Values that do not make a batch yet; they are not sent any more.
    [[nodiscard]] std::vector<AmbientRecord> unsent() {
        const std::lock_guard lock(mutex_);
        return std::exchange(own_, {});
    }

  private:
    std::size_t batch_;
    std::function<void(std::vector<AmbientRecord>)> send_;
    std::mutex mutex_;  ///< guards own_
    std::vector<AmbientRecord> own_;
};

}  // namespace lightwalk
