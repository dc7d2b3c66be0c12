#include "parallel/coefficient_rounds.h"

#include <utility>

#include "core/error.h"
#include "parallel/round_bytes.h"
#include "parallel/waiting_points.h"

namespace lightwalk {

template <class Wire>
void visit_fields(Wire& wire, CoefficientRecord& record) {
    wire(record.position, record.normal, record.reach, record.value);
}
template <class Wire>
void visit_fields(Wire& wire, CoefficientTerm& term) {
    wire(term.column, term.coefficient);
}
template <class Wire>
void visit_fields(Wire& wire, CoefficientRounds::Made& made) {
    wire(made.record, made.terms);
}
template <class Wire>
void visit_fields(Wire& wire, CoefficientRounds::Share& share) {
    wire(share.stop, share.points, share.made);
}

namespace {

constexpr std::size_t kPointsPerTask = 64;  ///< that are looked up

/// For its lifetime nobody is told the terms of rays, which are made of them all the same.
class Untold {
  public:
    explicit Untold(WorkerContexts& contexts) : contexts_(contexts) {
        for (int w = 0; w < contexts.size(); ++w)
            before_.push_back(std::exchange(contexts[w].contributions, &nobody_));
    }
    ~Untold() {
        for (int w = 0; w < contexts_.size(); ++w)
            contexts_[w].contributions = before_[static_cast<std::size_t>(w)];
    }
    Untold(const Untold&) = delete;
    Untold& operator=(const Untold&) = delete;

  private:
    class Nobody final : public ContributionSink {
      public:
        void add(const Contribution& /*term*/) override {}
    };
    WorkerContexts& contexts_;
    Nobody nobody_;
    std::vector<ContributionSink*> before_;
};

}  // namespace

CoefficientRounds::CoefficientRounds(const Tracer& tracer, CoefficientCache& cache,
                                     Executor& executor, WorkerContexts& contexts,
                                     std::vector<RayTally*> tallies, Group& exchange,
                                     const StopFlag& stop)
    : tracer_(tracer),
      cache_(cache),
      executor_(executor),
      contexts_(contexts),
      tallies_(std::move(tallies)),
      exchange_(exchange),
      stop_(stop),
      calculation_(tracer, cache),
      guess_(cache.limits()) {}

bool CoefficientRounds::fill(FunctionRef<void()> trace) {
    WaitingPoints waiting(
        collect(trace), guess_,
        [this](const AmbientPoint* some, std::size_t count) { return served(some, count); });
    while (!stopped_ && !cache_.full()) {
        const std::vector<AmbientPoint> chosen =
            waiting.choose(WaitingPoints::most_values(cache_.size()));
        if (chosen.empty()) break;
        for (const Made& one : compute(chosen)) {
            if (!one.record || cache_.full()) continue;
            cache_.insert(*one.record, one.terms);
            guess_.add(one.record->position, one.record->normal, CoefficientCache::kLevel,
                       one.record->reach);
        }
    }
    return !stopped_;
}

/// Each process adds whether it was requested to stop, so that all stop at the same place.
std::vector<CoefficientRounds::Share> CoefficientRounds::gather(Share mine) {
    mine.stop = stop_.requested();
    std::vector<Share> all;
    if (exchange_.size() == 1) {
        all.push_back(std::move(mine));
    } else {
        for (const std::string& bytes : exchange_.all_gather(wire::encode(mine))) {
            if (bytes.empty()) throw InputError("another rank takes no part in a round");
            all.push_back(wire::decode<Share>(bytes));
        }
    }
    for (const Share& share : all) stopped_ = stopped_ || share.stop;
    return all;
}

std::vector<AmbientPoint> CoefficientRounds::collect(FunctionRef<void()> trace) {
    Share mine;
    {
        const Untold untold(contexts_);
        const CollectingPoints collecting(contexts_);
        trace();
        mine.points = collecting.points();
    }
    std::vector<AmbientPoint> points;
    for (const Share& share : gather(std::move(mine)))
        points.insert(points.end(), share.points.begin(), share.points.end());
    return stopped_ ? std::vector<AmbientPoint>() : points;
}

/// Whether there is a record for each of some points.
std::vector<char> CoefficientRounds::served(const AmbientPoint* points, std::size_t count) {
    std::vector<char> result(count, 0);
    executor_.for_each((count + kPointsPerTask - 1) / kPointsPerTask, [&](std::size_t task, int) {
        const std::size_t last = std::min(count, (task + 1) * kPointsPerTask);
        CoefficientScratch scratch;
        for (std::size_t i = task * kPointsPerTask; i < last; ++i)
            result[i] = calculation_.is_served(points[i], scratch) ? 1 : 0;
    });
    return result;
}

/// The records of the points, in their order; after a stop, nothing.
std::vector<CoefficientRounds::Made> CoefficientRounds::compute(
    const std::vector<AmbientPoint>& chosen) {
    Share mine;
    mine.made.resize(chosen.size());
    executor_.for_each(
        chosen.size(),
        [&](std::size_t task, int worker) {
            if (!exchange_.does(task)) return;
            Made& own = mine.made[task];
            const std::optional<double> reach = calculation_.reach_at(chosen[task]);
            if (!reach) return;
            own.record = calculation_.record_at(chosen[task], *reach, contexts_[worker]);
            own.terms = tallies_[static_cast<std::size_t>(worker)]->take_terms();
        },
        stop_);
    std::vector<Share> all = gather(std::move(mine));
    if (stopped_) return {};
    std::vector<Made> made(chosen.size());
    for (std::size_t other = 0; other < all.size(); ++other) {
        std::vector<Made>& theirs = all[other].made;
        if (theirs.size() != made.size()) throw InputError("another rank computes other places");
        for (std::size_t i = other; i < made.size(); i += all.size())
            made[i] = std::move(theirs[i]);
    }
    return made;
}

}  // namespace lightwalk
