#include "apps/walk/picture_cleaner.h"

#include <exception>
#include <utility>

namespace lightwalk {

PictureCleaner::PictureCleaner(Denoise denoise)
    : denoise_(std::move(denoise)), thread_([this] { work(); }) {}

PictureCleaner::~PictureCleaner() {
    give_up();
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
    }
    news_.notify_one();
    thread_.join();
}

void PictureCleaner::begin(Picture picture) {
    {
        const std::lock_guard lock(mutex_);
        if (!problem_.empty()) return;
        ++begun_;
        wanted_ = true;
        clean_.reset();
        next_ = std::move(picture);
    }
    news_.notify_one();
}

void PictureCleaner::give_up() {
    const std::lock_guard lock(mutex_);
    wanted_ = false;
    next_.reset();
    clean_.reset();
}

bool PictureCleaner::is_busy() const {
    const std::lock_guard lock(mutex_);
    return wanted_;
}

std::optional<std::vector<Rgb>> PictureCleaner::take() {
    const std::lock_guard lock(mutex_);
    if (clean_) wanted_ = false;
    return std::exchange(clean_, std::nullopt);
}

std::string PictureCleaner::problem() const {
    const std::lock_guard lock(mutex_);
    return problem_;
}

bool PictureCleaner::is_wanted(std::uint64_t number) const {
    const std::lock_guard lock(mutex_);
    return wanted_ && begun_ == number;
}

void PictureCleaner::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        news_.wait(lock, [&] { return ends_ || next_; });
        if (ends_) return;
        Picture picture = *std::exchange(next_, std::nullopt);
        const std::uint64_t number = begun_;
        lock.unlock();
        bool whole = false;
        std::string problem;
        try {
            whole = denoise_(picture, [&] { return is_wanted(number); });
        } catch (const std::exception& error) {
            problem = error.what();
        }
        lock.lock();
        if (whole && wanted_ && begun_ == number) clean_ = std::move(picture.pixels);
        if (problem.empty()) continue;
        problem_ = std::move(problem);
        wanted_ = false;
        next_.reset();
        return;
    }
}

}  // namespace lightwalk
