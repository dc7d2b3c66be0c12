#include "parallel/ranks/cloud_tracer.h"

#include <chrono>
#include <utility>

#include "core/error.h"
#include "parallel/ranks/cloud_roles.h"

namespace lightwalk {
namespace {

// A signal's handler cannot notify: look for its request now and then.
constexpr std::chrono::milliseconds kSignalPatience{20};

}  // namespace

void CloudTracer::take(Message message) {
    {
        const std::lock_guard lock(mutex_);
        if (auto* order = std::get_if<CloudOrder>(&message)) {
            orders_.push_back(std::move(*order));
        } else if (auto* uncached = std::get_if<GiveUncachedPixels>(&message)) {
            if (uncached->places.empty())
                frames_dealt_out_ = uncached->frame + 1;
            else
                uncached_.push_back(std::move(*uncached));
        } else if (auto* points = std::get_if<CloudPoints>(&message)) {
            points_.push_back(std::move(*points));
        } else if (auto* used = std::get_if<CloudUsed>(&message)) {
            used_.push_back(std::move(*used));
        } else if (auto* traced = std::get_if<TracedPixelResults>(&message)) {
            traced_.push_back(std::move(*traced));
        } else if (const auto* stage = std::get_if<CloudStage>(&message)) {
            (stage->kind == CloudStage::Kind::points ? points_there_ : pixels_there_) = true;
        } else {
            finished_ = true;
        }
    }
    changed_.notify_all();
}

std::optional<CloudOrder> CloudTracer::next_order(const StopFlag& stop) {
    const TimedActivity waiting(timeline_, 0, Activity::wait);
    std::unique_lock lock(mutex_);
    while (orders_.empty() && !finished_ && !stop.requested())
        changed_.wait_for(lock, kSignalPatience);
    if (orders_.empty() || stop.requested()) return std::nullopt;
    CloudOrder order = std::move(orders_.front());
    orders_.pop_front();
    return order;
}

/// False: stopped.
bool CloudTracer::wait_for(CloudStage::Kind stage, const StopFlag& stop) {
    const TimedActivity waiting(timeline_, 0, Activity::wait);
    bool& there = stage == CloudStage::Kind::points ? points_there_ : pixels_there_;
    std::unique_lock lock(mutex_);
    while (!there && !finished_ && !stop.requested()) changed_.wait_for(lock, kSignalPatience);
    return std::exchange(there, false) && !stop.requested();
}

/// Those of the next frame may be there already: where this one was none of the rank's business.
std::optional<GiveUncachedPixels> CloudTracer::next_uncached(WalkFrameId frame, int worker,
                                                             const StopFlag& stop) {
    const TimedActivity waiting(timeline_, worker, Activity::wait);
    std::unique_lock lock(mutex_);
    const auto here = [&] { return !uncached_.empty() && uncached_.front().frame == frame; };
    while (!here() && frames_dealt_out_ <= frame && !finished_ && !stop.requested())
        changed_.wait_for(lock, kSignalPatience);
    if (!here() || stop.requested()) return std::nullopt;
    GiveUncachedPixels uncached = std::move(uncached_.front());
    uncached_.pop_front();
    return uncached;
}

void CloudTracer::run(Executor& executor, const StopFlag& stop) {
    while (const std::optional<CloudOrder> order = next_order(stop)) draw(*order, executor, stop);
}

void CloudTracer::draw(const CloudOrder& order, Executor& executor, const StopFlag& stop) {
    const double budget = order.budget;
    const UncachedPixelTracer::Clock::time_point deadline =
        budget > 0 ? deadline_of(budget - last_keep_seconds_)
                   : UncachedPixelTracer::Clock::time_point::max();
    const std::unique_ptr<WalkRays> rays = make_(order);
    const auto probe = [&](std::span<const PixelPlace> places,
                           std::span<PixelVisibility> visibility,
                           int worker) { rays->probe(places, visibility, worker); };
    const auto trace = [&](std::span<const PixelPlace> places, std::span<TracedPixel> pixels,
                           int sample, int worker) { rays->trace(places, pixels, sample, worker); };
    const PixelCaster caster{probe, trace};
    const std::uint64_t rays_before = rays->traced();
    const Frame frame{order, caster, executor, stop};
    const bool owns = options_.index < options_.owners;
    if (owns) {
        const double keeping = begin(order, executor);
        region_->begin(rays->camera(), order.rules);
        region_->frame().report.keep_seconds = keeping;
        if (order.rests)
            refine(order);
        else if (!answer(frame))
            return;
    }
    const auto traces = UncachedPixelTracer::Clock::now();
    const double unknown = owns ? region_->unknown() : 0;
    serve(frame, UncachedPixelTracer(caster, options_.cloud.tolerance,
                                     tracing_deadline(deadline, budget, unknown)));
    if (!owns) return;
    region_->frame().report.trace_seconds =
        std::chrono::duration<double>(UncachedPixelTracer::Clock::now() - traces).count();
    if (!finish(frame, rays->traced() - rays_before)) return;
    last_keep_seconds_ = region_->frame().report.keep_seconds;
}

/// The points of the last frame, as far as there is room for them. The seconds that it took.
double CloudTracer::begin(const CloudOrder& order, Executor& executor) {
    constexpr int kMostPixels = 1 << 16;  // in a row or column
    if (order.width < 1 || order.width > kMostPixels || order.height < 1 ||
        order.height > kMostPixels)
        throw InputError("a frame of a walk is ordered in a size that cannot be");
    const bool same = region_ && width_ == order.width && height_ == order.height;
    width_ = order.width;
    height_ = order.height;
    parts_ = SubImages({0, 0, width_, height_}, options_.owners);
    if (!same || order.rules.empty) {
        region_.emplace(parts_[options_.index], width_, height_, options_.cloud);
        return 0;
    }
    double& seconds = region_->frame().report.keep_seconds;
    seconds = 0;
    region_->keep(order.rules.room, executor);
    return seconds;
}

/// False: stopped.
bool CloudTracer::answer(const Frame& frame) {
    const WalkFrameId id = frame.order.rules.frame;
    region_->project(frame.executor);
    send_points(id);
    if (!wait_for(CloudStage::Kind::points, frame.stop)) return false;
    std::vector<CloudPoints> points;
    {
        const std::lock_guard lock(mutex_);
        points.swap(points_);
    }
    for (const CloudPoints& others : points) region_->add(others.points);
    region_->answer(frame.caster, frame.executor, frame.stop,
                    checking_deadline(frame.order.budget));
    if (frame.stop.requested()) return false;
    send_used(id);
    send_uncached(id);
    return true;
}

void CloudTracer::send_points(WalkFrameId frame) {
    std::vector<CloudPoints> out(options_.owners);
    region_->leaving([&](const CloudPoint& point, const PixelPlace& place) {
        const PixelRectangle near =
            widened({place.x, place.y, place.x + 1, place.y + 1}, 1, width_, height_);
        for (const std::size_t owner : parts_.overlapping(near)) out[owner].points.push_back(point);
    });
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (i == options_.index) continue;
        out[i].frame = frame;
        post_(worker(i), std::move(out[i]));
    }
}

void CloudTracer::send_used(WalkFrameId frame) {
    const UsedPixels used = region_->used_beside();
    for (const std::size_t i : owners_beside(parts_, options_.index, width_, height_))
        post_(worker(i), CloudUsed{frame, used});
}

void CloudTracer::send_uncached(WalkFrameId frame) {
    UncachedPixels message{frame, static_cast<std::uint32_t>(region_->noise_pairs().size()), {}};
    for (const UncachedPixel& uncached_pixel : region_->uncached())
        message.places.push_back(uncached_pixel.place);
    for (const std::uint32_t uncached_pixel : region_->noise_pairs())
        message.places.push_back(region_->uncached()[uncached_pixel].place);
    post_(worker(options_.index), std::move(message));
}

/// All threads trace what comes, until no more does.
void CloudTracer::serve(const Frame& frame, const UncachedPixelTracer& tracer) {
    const auto task = [&](std::size_t, int worker) {
        try {
            while (const std::optional<GiveUncachedPixels> uncached =
                       next_uncached(frame.order.rules.frame, worker, frame.stop))
                trace(*uncached, tracer, frame.order.sample, worker);
        } catch (...) {
            take(Finish{});  // for the other threads
            throw;
        }
    };
    frame.executor.for_each(static_cast<std::size_t>(frame.executor.concurrency()), task,
                            frame.stop);
}

void CloudTracer::trace(const GiveUncachedPixels& uncached, const UncachedPixelTracer& tracer,
                        int sample, int worker) {
    if (uncached.owner >= options_.owners) throw InputError("pixels of a part that nobody owns");
    const auto count = static_cast<std::uint32_t>(uncached.places.size());
    TracedPixelResults result{uncached.frame, uncached.first, count, {}};
    if (uncached.at_once || !tracer.is_late()) {
        const TimedActivity tracing(timeline_, worker, Activity::trace);
        result.traced.resize(count);
        const auto keep = [&](std::size_t first, std::span<const TracedPixelResult> traced) {
            std::copy(traced.begin(), traced.end(),
                      result.traced.begin() + static_cast<std::ptrdiff_t>(first));
        };
        tracer.trace_part(uncached.places, uncached.noise_pairs ? 1 : sample, worker, keep);
    }
    post_(this->worker(uncached.owner), std::move(result));
    post_({0, Role::master}, AskUncachedPixels{1});
}

/// The own part of the frame, when all its pixels are there. False: stopped.
bool CloudTracer::finish(const Frame& frame, std::uint64_t rays) {
    if (!wait_for(CloudStage::Kind::pixels, frame.stop)) return false;
    take_traced();
    CloudPart part = part_of(frame.order);
    part.ages =
        frame.order.rests ? region_->rest(frame.order.leaves) : region_->age(frame.executor);
    part.report = region_->frame().report;
    part.report.rays = rays;
    post_(worker(options_.index), std::move(part));
    return true;
}

/// What it shows.
CloudPart CloudTracer::part_of(const CloudOrder& order) {
    CloudPart part;
    part.frame = order.rules.frame;
    part.area = region_->area();
    if (order.rests) {
        for (std::size_t i = 0; i < region_->uncached().size(); ++i)
            part.refined.push_back(region_->is_traced(i) ? region_->traced(i).value
                                                         : PixelValue{{}, -1});
    } else {
        region_->show();
        part.pixels = encoded();
    }
    if (order.rest_follows)
        part.origins.assign(region_->origins().begin(), region_->origins().end());
    return part;
}

/// The view stands still: the order says what is to be traced.
void CloudTracer::refine(const CloudOrder& order) {
    std::vector<PixelPlace> own;
    for (const PixelPlace& place : order.refined)
        if (region_->area().contains(place)) own.push_back(place);
    region_->refine(own);
    send_uncached(order.rules.frame);
}

void CloudTracer::take_traced() {
    std::vector<CloudUsed> used;
    std::vector<TracedPixelResults> all;
    {
        const std::lock_guard lock(mutex_);
        used.swap(used_);
        all.swap(traced_);
    }
    for (const CloudUsed& others : used) region_->mark_used(others.used);
    const std::size_t uncached = region_->uncached().size();
    for (const TracedPixelResults& some : all) {
        // What is dealt out together is either of the one kind or of the other.
        if (some.first >= uncached)
            region_->record_noise_pairs(some.first - uncached, some.traced);
        else if (some.first + some.traced.size() <= uncached)
            region_->record(some.first, some.traced);
        else
            throw InputError("a rank has traced pixels together that do not belong together");
    }
}

std::string CloudTracer::encoded() {
    const CloudFrame& frame = region_->frame();
    std::vector<PixelValue> values(frame.radiance.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = {frame.radiance[i], frame.distance[i]};
    if (frame.report.filled > 0) {
        const std::span<const std::uint8_t> known = region_->known();
        for (std::size_t i = 0; i < values.size(); ++i)
            if (known[i] == 0) values[i].distance = -1;
    }
    return options_.encode(region_->area(), std::move(values));
}

}  // namespace lightwalk
