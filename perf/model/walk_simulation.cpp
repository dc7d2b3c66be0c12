#include "perf/model/walk_simulation.h"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "parallel/ranks/topology.h"
#include "parallel/sub_images.h"

namespace lightwalk {
namespace {

constexpr double kPointBytes = 44;    ///< of a point in a message
constexpr double kTracedBytes = 100;  ///< of a traced pixel, with its points
constexpr std::size_t kViewBytes = 300;
/// A sleeping loop looks after 50, 100, 200 and then each 400 us (see RankLink): on average so much
/// later than a message is there [s].
constexpr double kMeanWait = 100e-6;

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
      owners_(owners_of(static_cast<std::size_t>(walk.ranks), walk.projectors)) {
    const SubImages parts({0, 0, walk.width, walk.height}, owners_);
    for (std::size_t i = 0; i < owners_; ++i) parts_.push_back(parts[i]);
    const Topology topology = make_topology(Variant::hybrid, walk.ranks, false, 1);
    RankSettings settings;
    settings.slots = walk.threads;
    settings.ahead = std::max(1, walk.threads / 2);
    settings.projectors = walk.projectors;
    for (int i = 0; i < walk.ranks; ++i) {
        ranks_.emplace_back(RankRoles(i, topology, settings));
        ranks_.back().free_threads = walk.threads;
    }
}

WalkPrediction WalkSimulation::run() {
    for (std::size_t rank = 0; rank < ranks_.size(); ++rank)
        take_step(rank, [](RankRoles& roles, Outbox& out) { roles.begin(out); });
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
    for (Rank& rank : ranks_) {
        rank.points = rank.used = rank.pixels = 0;
        rank.uncached.reset();
        rank.checks = rank.gathers = false;
    }
    FrameOrder next;
    next.number = frame();
    next.width = walk_.width;
    next.height = walk_.height;
    next.rules.frame = static_cast<std::uint64_t>(frames_done_);
    next.rules.empty = frames_done_ == 0;
    next.payload.assign(kViewBytes, ' ');
    take_step(0, [&](RankRoles& roles, Outbox& out) { roles.queue().start(next, out); });
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

/// Rank 0's threads unpack the parts of the others side by side; its own is not packed.
double WalkSimulation::unpack_seconds() const {
    if (!machine_.unpacks) return 0;
    const int parts = std::min(walk_.ranks, walk_.projectors);
    const int one_after_the_other = (parts - 1 + walk_.threads - 1) / walk_.threads;
    return costs_.decode * walk_.width * walk_.height * one_after_the_other / parts;
}

template <class Step>
void WalkSimulation::take_step(std::size_t rank, Step step) {
    Outbox out;
    step(ranks_[rank].roles, out);
    for (TracerNews& news : out.tracers) handle(rank, std::move(news));
    for (const ProgramNews& news : out.program) {
        if (!std::holds_alternative<FinishedFrame>(news)) continue;
        at(now_ + machine_.slowness * unpack_seconds(), [this] { end_frame(); });
    }
    send(std::move(out.messages));
}

void WalkSimulation::post(std::size_t rank, std::size_t to, Message message) {
    std::vector<Envelope> messages;
    messages.push_back({static_cast<int>(rank), static_cast<int>(to), std::move(message)});
    send(std::move(messages));
}

/// Local messages wake the rank's loop; what follows from one on the same rank is served at once.
void WalkSimulation::send(std::vector<Envelope> messages) {
    for (Envelope& envelope : messages) {
        const auto from = static_cast<std::size_t>(envelope.from);
        const auto to = static_cast<std::size_t>(envelope.to);
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
            at(receiver.loop_free, [this, carried, to] {
                take_step(to, [&](RankRoles& roles, Outbox& out) {
                    roles.handle(carried->from, std::move(carried->message), out);
                });
            });
        });
    }
}

/// Of the real message, and of what simulations leave out.
double WalkSimulation::bytes_of(const Envelope& envelope) const {
    const auto bytes = static_cast<double>(message_bytes(envelope.message));
    if (const auto* exchange = std::get_if<PointExchange>(&envelope.message)) {
        if (!std::holds_alternative<SharedPoints>(exchange->points)) return bytes;
        return bytes + kPointBytes * points_from(static_cast<std::size_t>(envelope.from),
                                                 static_cast<std::size_t>(envelope.to));
    }
    if (const auto* result = std::get_if<WorkResult>(&envelope.message))
        return bytes + kTracedBytes * std::get<TracedRun>(result->result).count;
    if (const auto* part = std::get_if<FinishedPart>(&envelope.message))
        return bytes + costs_.packed_bytes *
                           static_cast<double>(std::get<FramePart>(part->part).area.pixels());
    return bytes;
}

void WalkSimulation::handle(std::size_t number, TracerNews news) {
    Rank& rank = ranks_[number];
    std::visit(Overloaded{[](const PictureJob&) {}, [](const ChangeOrder&) {},
                          [&](const FrameOrder&) {
                              if (number < owners_) project(number);
                          },
                          [&](const WorkGrant& grant) {
                              for (const Work& piece : grant.pieces)
                                  trace(number, std::get<PixelRun>(piece));
                          },
                          [&](const PointExchange& exchange) {
                              const bool points =
                                  std::holds_alternative<SharedPoints>(exchange.points);
                              ++(points ? rank.points : rank.used);
                          },
                          [&](const TracedRun& run) { rank.pixels += run.count; }},
               news);
    look_on(number);
}

/// A part goes on as soon as its owner has all that it waits for.
void WalkSimulation::look_on(std::size_t number) {
    Rank& rank = ranks_[number];
    if (number >= owners_) return;
    if (rank.checks && rank.points == owners_ - 1) {
        rank.checks = false;
        check(number);
    }
    if (rank.uncached && rank.pixels == *rank.uncached && !rank.gathers &&
        rank.used == beside(number).size()) {
        rank.gathers = true;
        gather(number);
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
    use_all_threads(rank, seconds, [this, rank] {
        for (std::size_t i = 0; i < owners_; ++i)
            if (i != rank) post(rank, i, PointExchange{frame(), SharedPoints{}});
        ranks_[rank].checks = true;
        look_on(rank);
    });
}

void WalkSimulation::check(std::size_t rank) {
    last_projected_ = now_;
    use_all_threads(rank, costs_.check * pixels_of(rank), [this, rank] {
        last_checked_ = now_;
        for (const std::size_t i : beside(rank))
            post(rank, i, PointExchange{frame(), UsedPixels{}});
        const double varied = std::uniform_real_distribution<double>(0.5, 1.5)(random_);
        UncachedPixels uncached{frame(), 0, {}};
        uncached.places.resize(
            static_cast<std::size_t>(varied * costs_.uncached * pixels_of(rank) + 0.5));
        const auto count = static_cast<double>(uncached.places.size());
        most_uncached_ = std::max(most_uncached_, count);
        all_uncached_ += count;
        ranks_[rank].uncached = uncached.places.size();
        post(rank, 0, std::move(uncached));
        look_on(rank);
    });
}

void WalkSimulation::trace(std::size_t rank, const PixelRun& run) {
    const auto count = static_cast<std::uint32_t>(run.places.size());
    const TracedRun traced{run.frame, run.owner, run.first, count, {}};
    use_thread(rank, costs_.trace * count, [this, rank, traced] {
        take_step(rank, [&](RankRoles& roles, Outbox& out) {
            roles.worker().finish({FinishedWork::Payload::pixels, 0, traced.count, 0}, traced, out);
        });
    });
}

void WalkSimulation::gather(std::size_t rank) {
    last_traced_ = now_;
    const double seconds = (costs_.keep * costs_.points + costs_.encode) * pixels_of(rank);
    FramePart part;
    part.frame = frame();
    part.area = parts_[rank];
    use_all_threads(rank, seconds, [this, rank, part] { post(rank, 0, FinishedPart{part}); });
}

}  // namespace lightwalk
