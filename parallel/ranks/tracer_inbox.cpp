#include "parallel/ranks/tracer_inbox.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/error.h"
#include "parallel/work_queue/worker.h"

namespace lightwalk {
namespace {

/// A signal's handler cannot notify: look for its request now and then.
constexpr std::chrono::milliseconds kSignalPatience{20};

template <class T>
std::optional<T> popped(std::deque<T>& queue) {
    if (queue.empty()) return std::nullopt;
    T first = std::move(queue.front());
    queue.pop_front();
    return first;
}

}  // namespace

void TracerInbox::push(TracerNews news) {
    {
        const std::lock_guard lock(mutex_);
        std::visit(Overloaded{[&](PictureJob& job) { push_picture(std::move(job)); },
                              [&](FrameOrder& order) { orders_.emplace_back(std::move(order)); },
                              [&](ChangeOrder& order) { orders_.emplace_back(std::move(order)); },
                              [&](WorkGrant& grant) { push_grant(std::move(grant)); },
                              [&](TracedRun& run) {
                                  FrameMail& mail = mail_[run.frame];
                                  mail.traced += run.count;
                                  mail.runs.push_back(std::move(run));
                              },
                              [&](PointExchange& exchange) {
                                  FrameMail& mail = mail_[exchange.frame];
                                  std::visit(
                                      Overloaded{[&](SharedPoints& shared) {
                                                     mail.points.push_back(std::move(shared));
                                                 },
                                                 [&](UsedPixels& used) {
                                                     mail.used.push_back(std::move(used));
                                                 }},
                                      exchange.points);
                              }},
                   news);
    }
    threads_->notify(changed_);
}

void TracerInbox::push_picture(PictureJob job) {
    const JobId id = job.job;
    std::erase_if(pictures_, [&](const auto& old) { return old.first + kJobsAtOnce <= id; });
    const auto picture = std::make_shared<OpenPicture>();
    picture->start = std::move(job);
    pictures_[id] = picture;
    items_.emplace_back(picture);
}

void TracerInbox::push_grant(WorkGrant grant) {
    for (Work& piece : grant.pieces) {
        std::visit(Overloaded{[&](JobBlock& block) {
                                  const auto picture = pictures_.find(block.job);
                                  if (picture == pictures_.end())
                                      throw InputError("a block of a picture that nobody began");
                                  items_.emplace_back(PictureBlock{block, picture->second});
                              },
                              [&](RayChunk& chunk) { items_.emplace_back(std::move(chunk)); },
                              [&](PixelRun& run) { runs_.push_back(std::move(run)); }},
                   piece);
    }
    if (grant.frame_over) frames_over_ = *grant.frame_over + 1;
}

void TracerInbox::close() {
    {
        const std::lock_guard lock(mutex_);
        closed_ = true;
    }
    threads_->notify(changed_);
}

void TracerInbox::reopen() {
    const std::lock_guard lock(mutex_);
    pictures_.clear();  // whose renderers go with what they were made for
    closed_ = false;
}

template <class Take>
auto TracerInbox::wait_for(const StopFlag& stop, Take take) -> decltype(take()) {
    std::unique_lock lock(mutex_);
    while (!stop.requested()) {
        if (auto found = take()) return found;
        if (closed_) break;
        threads_->wait_for(changed_, lock, kSignalPatience);
    }
    return std::nullopt;
}

std::optional<TracerInbox::Item> TracerInbox::next(const StopFlag& stop) {
    return wait_for(stop, [&] { return popped(items_); });
}

std::optional<TracerInbox::Order> TracerInbox::next_order(const StopFlag& stop) {
    return wait_for(stop, [&] { return popped(orders_); });
}

std::optional<PixelRun> TracerInbox::next_run(FrameNumber frame, const StopFlag& stop) {
    bool over = false;
    std::optional<PixelRun> run;
    (void)wait_for(stop, [&]() -> std::optional<bool> {
        if (!runs_.empty() && runs_.front().frame == frame) run = popped(runs_);
        over = frames_over_ > frame;
        return run || over ? std::optional(true) : std::nullopt;
    });
    return run;
}

std::optional<std::vector<SharedPoints>> TracerInbox::points(FrameNumber frame, std::size_t lists,
                                                             const StopFlag& stop) {
    return wait_for(stop, [&]() -> std::optional<std::vector<SharedPoints>> {
        FrameMail& mail = mail_[frame];
        if (mail.points.size() < lists) return std::nullopt;
        return std::exchange(mail.points, {});
    });
}

std::optional<FrameMail> TracerInbox::mail(FrameNumber frame, std::size_t pixels, std::size_t lists,
                                           const StopFlag& stop) {
    return wait_for(stop, [&]() -> std::optional<FrameMail> {
        FrameMail& mail = mail_[frame];
        if (mail.traced < pixels || mail.used.size() < lists) return std::nullopt;
        FrameMail whole = std::move(mail);
        mail_.erase(mail_.begin(), mail_.upper_bound(frame));
        return whole;
    });
}

std::size_t TracerInbox::waiting() const {
    const std::lock_guard lock(mutex_);
    return items_.size() + runs_.size() + orders_.size() + mail_.size();
}

void TracerInbox::wait_for_end(const StopFlag& stop) {
    (void)wait_for(stop, [] { return std::optional<bool>(); });
}

}  // namespace lightwalk
