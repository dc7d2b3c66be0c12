#include "apps/session/checkpoint.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>

#include "parallel/ranks/piece_codec.h"

namespace lightwalk {
namespace {

constexpr std::chrono::seconds kOften{1};  ///< between two times of writing, which cost a sync

using Head = std::array<std::int32_t, 5>;  ///< frame, x0, y0, x1, y1
constexpr PixelRectangle kBeginning{-1, 0, 0, 0}, kStep{-1, 1, 0, 0}, kRun{-1, 2, 0, 0};

std::string bytes_of(int frame, const PixelRectangle& block) {
    const Head head{frame, block.x0, block.y0, block.x1, block.y1};
    return {reinterpret_cast<const char*>(head.data()), sizeof head};
}

bool contains(const PixelRectangle& whole, const PixelRectangle& part) {
    return whole.x0 <= part.x0 && whole.y0 <= part.y0 && part.x1 <= whole.x1 && part.y1 <= whole.y1;
}

bool overlap(const PixelRectangle& a, const PixelRectangle& b) {
    return a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1;
}

}  // namespace

class Checkpoint::Picture final : public CheckpointSink {
  public:
    Picture(Checkpoint& checkpoint, int frame, const PixelRectangle& whole)
        : checkpoint_(checkpoint), frame_(frame), whole_(whole) {}

    [[nodiscard]] std::vector<BlockPixels> known() override {
        std::vector<BlockPixels> blocks;
        for (const Known& known : checkpoint_.known_[frame_]) {
            const bool sound =
                contains(whole_, known.block) && !known.block.empty() &&
                std::none_of(blocks.begin(), blocks.end(), [&](const BlockPixels& other) {
                    return overlap(other.block, known.block);
                });
            if (sound) blocks.push_back({known.block, decode_piece(known.block, known.bytes), {}});
        }
        return blocks;
    }
    void keep(const BlockPixels& pixels) override {
        checkpoint_.keep({frame_, pixels.block, pixels.values});
    }
    [[nodiscard]] std::vector<std::string> known_steps(const std::string& beginning) override {
        KnownRounds rounds = std::exchange(checkpoint_.known_rounds_[frame_], {});
        if (rounds.beginning == beginning) return std::move(rounds.steps);
        checkpoint_.keep({frame_, kBeginning, {}, beginning});
        return {};
    }
    void keep_step(std::string step) override {
        checkpoint_.keep({frame_, kStep, {}, std::move(step)});
    }

  private:
    Checkpoint& checkpoint_;
    int frame_;
    PixelRectangle whole_;
};

Checkpoint::Checkpoint(const std::string& path, const std::string& header, WarningSink& warnings,
                       const std::string& beginning) {
    log_ = std::make_unique<RecordLog>(
        path, header, [&](std::string_view record) { read(record); }, warnings);
    if (beginning != known_beginning_) {
        const std::string record = bytes_of(0, kRun) + beginning;
        log_->append(record);
        log_->sync();
        read(record);
    }
    writer_ = std::jthread([this](const std::stop_token& ending) { write(ending); });
}

std::string Checkpoint::beginning_of(const std::string& path) {
    const std::string head = bytes_of(0, kRun);
    std::string beginning;
    RecordLog::look_through(path, [&](std::string_view record) {
        if (record.starts_with(head)) beginning = record.substr(head.size());
    });
    return beginning;
}

void Checkpoint::read(std::string_view record) {
    Head head{};
    if (record.size() < sizeof head) return;
    std::memcpy(head.data(), record.data(), sizeof head);
    const PixelRectangle block{head[1], head[2], head[3], head[4]};
    std::string rest(record.substr(sizeof head));
    if (block == kRun) {
        known_.clear();
        known_rounds_.clear();
        known_beginning_ = std::move(rest);
    } else if (block == kBeginning)
        known_rounds_[head[0]] = {std::move(rest), {}};
    else if (block == kStep)
        known_rounds_[head[0]].steps.push_back(std::move(rest));
    else
        known_[head[0]].push_back({block, std::move(rest)});
}

std::shared_ptr<CheckpointSink> Checkpoint::picture(int frame, const PixelRectangle& whole) {
    return std::make_shared<Picture>(*this, frame, whole);
}

void Checkpoint::forget(int frame) {
    known_.erase(frame);
    known_rounds_.erase(frame);
}

void Checkpoint::keep(Kept kept) {
    const std::lock_guard lock(mutex_);
    if (problem_) std::rethrow_exception(problem_);
    kept_.push_back(std::move(kept));
    if (kept_.size() == 1) changed_.notify_all();
}

void Checkpoint::write(const std::stop_token& ending) {
    std::unique_lock lock(mutex_);
    std::chrono::steady_clock::time_point next{};
    while (true) {
        changed_.wait(lock, ending, [&] { return !kept_.empty(); });
        changed_.wait_until(lock, ending, next, [] { return false; });
        if (kept_.empty()) return;
        next = std::chrono::steady_clock::now() + kOften;
        std::deque<Kept> kept;
        kept.swap(kept_);
        lock.unlock();
        try {
            for (const Kept& one : kept) {
                log_->append(
                    bytes_of(one.frame, one.block) +
                    (one.of_rounds.empty() ? encode_piece(one.block, one.values) : one.of_rounds));
            }
            log_->sync();
            lock.lock();
        } catch (const InputError&) {
            lock.lock();
            problem_ = std::current_exception();
            return;
        }
    }
}

void Checkpoint::remove() {
    log_->remove();
}

}  // namespace lightwalk
