#include "apps/session/parse_queue.h"

#include <utility>

namespace lightwalk {
namespace {

constexpr std::size_t kMostWaiting = 4;
constexpr std::size_t kShort = kPieceBytes / 2, kLong = 2 * kPieceBytes;

}  // namespace

ParseQueue::~ParseQueue() {
    {
        const std::lock_guard lock(mutex_);
        stopped_ = true;
    }
    close();
}

/// Ends the thread, if there is one.
void ParseQueue::close() {
    {
        const std::lock_guard lock(mutex_);
        closed_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void ParseQueue::throw_error() {
    if (error_) std::rethrow_exception(error_);
}

void ParseQueue::finish() {
    close();
    throw_error();
}

void ParseQueue::push(std::string_view piece) {
    const bool waits = thread_.joinable();
    if (!waits && (piece.size() < kShort || piece.size() > kLong)) return next_.push(piece);
    if (!waits) {
        closed_ = false;
        thread_ = std::thread([this] { hand_on(); });
    }
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return waiting_.size() < kMostWaiting || error_; });
    throw_error();
    waiting_.emplace_back(piece);
    changed_.notify_all();
}

void ParseQueue::hand_on() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [this] { return !waiting_.empty() || closed_; });
        if (waiting_.empty() || stopped_) return;
        const std::string piece = std::move(waiting_.front());
        waiting_.pop_front();
        changed_.notify_all();
        lock.unlock();
        std::exception_ptr error;
        try {
            next_.push(piece);
        } catch (...) {
            error = std::current_exception();
        }
        lock.lock();
        if (!error) continue;
        error_ = error;
        waiting_.clear();
        changed_.notify_all();
        return;
    }
}

}  // namespace lightwalk
