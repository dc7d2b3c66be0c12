#include "perf/model/walk_simulation.h"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "parallel/ranks/topology.h"

namespace lightwalk {
namespace {

constexpr double kPointBytes = 44;    ///< of a point in a message
constexpr double kTracedBytes = 100;  ///< of a traced pixel, with its points
constexpr std::size_t kViewBytes = 300;
/// A sleeping loop looks after 50, 100, 200 and then each 400 us (see RankLoop): on average so much
/// later than a message is there [s].
constexpr double kMeanWait = 100e-6;

Address tracer_of(std::size_t rank) {
    return {static_cast<int>(rank), Role::tracer};
}
Address worker_of(std::size_t rank) {
    return {static_cast<int>(rank), Role::worker};
}

std::vector<int> first_ranks(int count) {
    std::vector<int> ranks;
    for (int rank = 0; rank < count; ++rank) ranks.push_back(rank);
    return ranks;
}

PixelRectangle moved(PixelRectangle area, int by) {
    area.x0 += by;
    area.x1 += by;
    return area;
}

double shared_pixels(const PixelRectangle& a, const PixelRectangle& b) {
    const int width = std::min(a.x1, b.x1) - std::max(a.x0, b.x0);
    const int height = std::min(a.y1, b.y1) - std::max(a.y0, b.y0);
    return width > 0 && height > 0 ? static_cast<double>(width) * height : 0;
}

}  // namespace

WalkSimulation::WalkSimulation(const WalkCosts& costs, const Machine& machine,
                               const SimulatedWalk& walk)
    : costs_(costs),
      machine_(machine),
      walk_(walk),
      random_(walk.seed),
      owners_(owners_of(static_cast<std::size_t>(walk.ranks), walk.projectors)),
      master_({0, Role::master}, first_ranks(walk.ranks), owners_, walk.ranks * walk.threads) {
    const SubImages parts({0, 0, walk.width, walk.height}, owners_);
    for (std::size_t i = 0; i < owners_; ++i) parts_.push_back(parts[i]);
    for (std::size_t i = 0; i < static_cast<std::size_t>(walk.ranks); ++i) {
        ranks_.emplace_back(CloudWorkerOptions{worker_of(i),
                                               {0, Role::master},
                                               i,
                                               owners_,
                                               walk.threads,
                                               std::max(1, walk.threads / 2)});
        ranks_.back().free_threads = walk.threads;
    }
}

WalkPrediction WalkSimulation::run() {
    Outbox out;
    for (Rank& rank : ranks_) rank.role.begin(out);
    send(out);
    order();
    while (frames_done_ < walk_.frames) {
        if (events_.empty()) throw std::logic_error("walk simulation: a frame is never finished");
        const Event event = events_.top();
        events_.pop();
        now_ = event.time;
        event.act();
    }
    WalkPrediction mean = sums_;
    const double frames = walk_.frames - 1;
    for (double* sum :
         {&mean.projected, &mean.checked, &mean.traced, &mean.gathered, &mean.bytes_a_frame})
        *sum /= frames;
    mean.seconds = (now_ - measured_from_) / frames;
    mean.master_busy = (ranks_[0].handling - handled_before_) / (now_ - measured_from_);
    mean.uncached_of_fullest = most_uncached_ * static_cast<double>(owners_) / all_uncached_;
    return mean;
}

void WalkSimulation::at(double time, std::function<void()> act) {
    events_.push({time, next_event_++, std::move(act)});
}

void WalkSimulation::order() {
    ordered_ = now_;
    most_uncached_ = all_uncached_ = 0;
    CloudOrder next;
    next.width = walk_.width;
    next.height = walk_.height;
    next.rules.frame = static_cast<std::uint64_t>(frames_done_);
    next.rules.empty = frames_done_ == 0;
    next.payload.assign(kViewBytes, ' ');
    Outbox out{{{0, Role::program}, {0, Role::master}, std::move(next)}};
    send(out);
}

void WalkSimulation::end_frame() {
    if (frames_done_ == 0) {
        sums_ = {};
        measured_from_ = now_;
        handled_before_ = ranks_[0].handling;
    } else {
        sums_.projected += last_projected_ - ordered_;
        sums_.checked += last_checked_ - last_projected_;
        sums_.traced += last_traced_ - last_checked_;
        sums_.gathered += now_ - last_traced_;
    }
    if (++frames_done_ < walk_.frames) order();
}

void WalkSimulation::use_thread(std::size_t rank, double seconds, std::function<void()> done) {
    Rank& r = ranks_[rank];
    if (r.free_threads == 0) {
        r.work.emplace_back(seconds, std::move(done));
        return;
    }
    --r.free_threads;
    at(now_ + machine_.slowness * seconds, [this, rank, done = std::move(done)] {
        Rank& owner = ranks_[rank];
        ++owner.free_threads;
        if (!owner.work.empty()) {
            auto [next, then] = std::move(owner.work.front());
            owner.work.pop_front();
            use_thread(rank, next, std::move(then));
        }
        done();
    });
}

void WalkSimulation::use_all_threads(std::size_t rank, double seconds, std::function<void()> done) {
    const auto left = std::make_shared<int>(walk_.threads);
    for (int i = 0; i < walk_.threads; ++i) {
        use_thread(rank, seconds / walk_.threads, [left, done] {
            if (--*left == 0) done();
        });
    }
}

void WalkSimulation::post(std::size_t rank, Address to, Message message) {
    Outbox out{{tracer_of(rank), to, std::move(message)}};
    send(out);
}

/// Local messages wake the rank's loop; what follows from one on the same rank is served at once.
void WalkSimulation::send(Outbox& out) {
    for (Envelope& envelope : out) {
        const auto from = static_cast<std::size_t>(envelope.from.rank);
        const auto to = static_cast<std::size_t>(envelope.to.rank);
        double arrives = now_ + machine_.wake * machine_.slowness;
        if (from != to) {
            const double bytes = bytes_of(envelope);
            sums_.bytes_a_frame += bytes;
            const double work =
                machine_.slowness * (machine_.overhead + machine_.byte_work * bytes);
            Rank& sender = ranks_[from];
            sender.handling += work;
            sender.loop_free = std::max(now_, sender.loop_free) + work;
            const double leaves = std::max(sender.loop_free, sender.wire_free);
            sender.wire_free = leaves + std::max(machine_.gap, machine_.byte_gap * bytes);
            arrives = leaves + machine_.byte_gap * bytes + machine_.latency;
            if (machine_.sleeps) arrives += kMeanWait + machine_.oversleep;
        }
        const auto carried = std::make_shared<Envelope>(std::move(envelope));
        at(arrives, [this, carried, from, to] {
            Rank& receiver = ranks_[to];
            double work = machine_.step;
            if (from != to) work += machine_.overhead + machine_.byte_work * bytes_of(*carried);
            work *= machine_.slowness;
            receiver.handling += work;
            receiver.loop_free = std::max(now_, receiver.loop_free) + work;
            at(receiver.loop_free, [this, carried] { deliver(std::move(*carried)); });
        });
    }
    out.clear();
}

/// Of the real message, and of what simulations leave out.
double WalkSimulation::bytes_of(const Envelope& envelope) const {
    const auto bytes = static_cast<double>(message_bytes(envelope.message));
    if (std::holds_alternative<CloudPoints>(envelope.message))
        return bytes + kPointBytes * points_from(static_cast<std::size_t>(envelope.from.rank),
                                                 static_cast<std::size_t>(envelope.to.rank));
    if (const auto* traced = std::get_if<TracedPixelResults>(&envelope.message))
        return bytes + kTracedBytes * traced->count;
    if (const auto* part = std::get_if<CloudPart>(&envelope.message))
        return bytes + costs_.packed_bytes * static_cast<double>(part->area.pixels());
    return bytes;
}

void WalkSimulation::deliver(Envelope envelope) {
    Outbox out;
    const auto rank = static_cast<std::size_t>(envelope.to.rank);
    if (envelope.to.role == Role::master) {
        master_.handle(std::move(envelope), out);
    } else if (envelope.to.role == Role::worker) {
        ranks_[rank].role.handle(std::move(envelope), out);
    } else if (envelope.to.role == Role::program) {
        // One thread unpacks the parts.
        const double unpacking = machine_.unpacks ? costs_.decode * walk_.width * walk_.height : 0;
        at(now_ + machine_.slowness * unpacking, [this] { end_frame(); });
    } else {
        tell_tracer(rank, std::move(envelope.message));
    }
    send(out);
}

void WalkSimulation::tell_tracer(std::size_t rank, Message message) {
    if (std::holds_alternative<CloudOrder>(message)) {
        if (rank < owners_) project(rank);
    } else if (const auto* stage = std::get_if<CloudStage>(&message)) {
        if (stage->kind == CloudStage::Kind::points)
            check(rank);
        else
            gather(rank);
    } else if (auto* uncached = std::get_if<GiveUncachedPixels>(&message)) {
        if (!uncached->places.empty()) trace(rank, std::move(*uncached));
    }
}

double WalkSimulation::pixels_of(std::size_t owner) const {
    return static_cast<double>(parts_[owner].pixels());
}

/// That lie in another part, or beside it, when all have moved on.
double WalkSimulation::points_from(std::size_t owner, std::size_t to) const {
    const int by = static_cast<int>(costs_.shift * walk_.width + 0.5);
    return costs_.points * shared_pixels(moved(parts_[owner], by),
                                         widened(parts_[to], 1, walk_.width, walk_.height));
}

void WalkSimulation::project(std::size_t rank) {
    const double seconds = costs_.project * costs_.points * pixels_of(rank);
    const auto frame = static_cast<WalkFrameId>(frames_done_);
    use_all_threads(rank, seconds, [this, rank, frame] {
        for (std::size_t i = 0; i < owners_; ++i) {
            if (i != rank) post(rank, worker_of(i), CloudPoints{frame, {}});
        }
    });
}

void WalkSimulation::check(std::size_t rank) {
    last_projected_ = now_;
    const auto frame = static_cast<WalkFrameId>(frames_done_);
    use_all_threads(rank, costs_.check * pixels_of(rank), [this, rank, frame] {
        last_checked_ = now_;
        const SubImages parts({0, 0, walk_.width, walk_.height}, owners_);
        for (const std::size_t i : owners_beside(parts, rank, walk_.width, walk_.height))
            post(rank, worker_of(i), CloudUsed{frame, {}});
        const double varied = std::uniform_real_distribution<double>(0.5, 1.5)(random_);
        UncachedPixels uncached{frame, 0, {}};
        uncached.places.resize(
            static_cast<std::size_t>(varied * costs_.uncached * pixels_of(rank) + 0.5));
        const auto count = static_cast<double>(uncached.places.size());
        most_uncached_ = std::max(most_uncached_, count);
        all_uncached_ += count;
        post(rank, worker_of(rank), std::move(uncached));
    });
}

void WalkSimulation::trace(std::size_t rank, GiveUncachedPixels uncached) {
    const auto count = static_cast<std::uint32_t>(uncached.places.size());
    use_thread(rank, costs_.trace * count,
               [this, rank, count, owner = uncached.owner, frame = uncached.frame,
                first = uncached.first] {
                   post(rank, worker_of(owner), TracedPixelResults{frame, first, count, {}});
                   post(rank, {0, Role::master}, AskUncachedPixels{1});
               });
}

void WalkSimulation::gather(std::size_t rank) {
    last_traced_ = now_;
    const double seconds = (costs_.keep * costs_.points + costs_.encode) * pixels_of(rank);
    CloudPart part;
    part.frame = static_cast<WalkFrameId>(frames_done_);
    part.area = parts_[rank];
    use_all_threads(rank, seconds, [this, rank, part] { post(rank, worker_of(rank), part); });
}

}  // namespace lightwalk
