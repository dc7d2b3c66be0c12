#include "parallel/ambient_rounds.h"

#include <algorithm>
#include <utility>

#include "core/error.h"

namespace lightwalk {
namespace {

// Limits of the number of values in a round, which grows with the number of known values, so that
// few are needless. Independent of the number of workers, for determinism.
constexpr std::size_t kFewestValues = 64, kMostValues = 1024;
constexpr std::size_t kKnownPerValue = 4;
constexpr std::size_t kPointsPerValue = 4;  ///< points looked at, per value that a round may have
constexpr std::size_t kLookupsPerTask = 64;

/// Sorts points in a pseudo-random order that depends on their contents only: any prefix is spread
/// evenly.
void put_in_order(std::vector<AmbientPoint>& points) {
    std::vector<std::pair<std::uint64_t, std::size_t>> order(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) order[i] = {hash_of(points[i]), i};
    std::sort(order.begin(), order.end());
    std::vector<AmbientPoint> sorted;
    sorted.reserve(points.size());
    for (const auto& [hash, i] : order) sorted.push_back(points[i]);
    points.swap(sorted);
}

/// For its lifetime the rays of all workers record missing ambient values.
class Collecting {
  public:
    explicit Collecting(WorkerContexts& contexts)
        : contexts_(contexts), missing_(static_cast<std::size_t>(contexts.size())) {
        for (int w = 0; w < contexts.size(); ++w)
            contexts[w].ambient.missing = &missing_[static_cast<std::size_t>(w)];
    }
    ~Collecting() {
        for (int w = 0; w < contexts_.size(); ++w) contexts_[w].ambient.missing = nullptr;
    }
    Collecting(const Collecting&) = delete;
    Collecting& operator=(const Collecting&) = delete;

    [[nodiscard]] bool left_out() const {
        return std::any_of(missing_.begin(), missing_.end(),
                           [](const MissingAmbient& missing) { return missing.left_out; });
    }
    [[nodiscard]] std::vector<AmbientPoint> points() const {
        std::vector<AmbientPoint> all;
        for (const MissingAmbient& missing : missing_)
            all.insert(all.end(), missing.points.begin(), missing.points.end());
        return all;
    }

  private:
    WorkerContexts& contexts_;
    std::vector<MissingAmbient> missing_;
};

/// For its lifetime the values that a worker computes on the way are recorded.
class RecordCollector {
  public:
    explicit RecordCollector(TraceContext& context) : context_(context) {
        context.ambient.new_records = &new_records_;
    }
    ~RecordCollector() { context_.ambient.new_records = nullptr; }
    RecordCollector(const RecordCollector&) = delete;
    RecordCollector& operator=(const RecordCollector&) = delete;
    [[nodiscard]] std::vector<NewAmbientRecord> take() {
        return std::move(new_records_.new_records);
    }

  private:
    TraceContext& context_;
    NewAmbientRecords new_records_;
};

}  // namespace

/// The queue of waiting points, in their order.
class AmbientRounds::Waiting {
  public:
    Waiting(AmbientRounds& rounds, std::vector<AmbientPoint> points)
        : rounds_(rounds), points_(std::move(points)) {
        put_in_order(points_);
    }

    /// Drop points from the head that have a usable value by now, and refill it to `size` or
    /// somewhat more.
    void look(std::size_t size) {
        drop_served(0);
        while (head_.size() < size && next_ < points_.size()) {
            const std::size_t count = std::min(points_.size() - next_, 2 * size),
                              first = head_.size();
            const auto from = points_.begin() + static_cast<std::ptrdiff_t>(next_);
            head_.insert(head_.end(), from, from + static_cast<std::ptrdiff_t>(count));
            drop_served(first);
            next_ += count;
        }
    }

    /// Remove up to `most` points from the head, in order, none close to an earlier one.
    [[nodiscard]] std::vector<AmbientPoint> choose(std::size_t most) {
        const SpacingGuess& guess = rounds_.guess_;
        ApartSet taken(guess.least(), guess.greatest());
        std::vector<AmbientPoint> chosen, rest;
        for (const AmbientPoint& point : head_) {
            if (chosen.size() >= most || taken.reached(point.query)) {
                rest.push_back(point);
                continue;
            }
            taken.add(point.query, guess(point.query));
            chosen.push_back(point);
        }
        head_.swap(rest);
        return chosen;
    }

    [[nodiscard]] std::size_t left() const { return head_.size() + points_.size() - next_; }

  private:
    /// Drop points with a usable value from index `first` of the head on.
    void drop_served(std::size_t first) {
        const std::vector<char> done = rounds_.served(head_.data() + first, head_.size() - first);
        std::size_t kept = first;
        for (std::size_t i = 0; i < done.size(); ++i) {
            if (done[i] == 0) head_[kept++] = head_[first + i];
        }
        head_.resize(kept);
    }

    AmbientRounds& rounds_;
    std::vector<AmbientPoint> points_;
    std::size_t next_ = 0;  ///< index of the first point that has not been moved to the head
    std::vector<AmbientPoint> head_;  ///< in the order of points_
};

AmbientRounds::AmbientRounds(const Tracer& tracer, PublishedCache& cache, Executor& executor,
                             WorkerContexts& contexts, Group& exchange, const StopFlag& stop,
                             std::function<void(std::size_t left)> after_round)
    : tracer_(tracer),
      cache_(cache),
      executor_(executor),
      contexts_(contexts),
      exchange_(exchange),
      stop_(stop),
      after_round_(std::move(after_round)),
      calculation_(tracer),
      guess_(cache.limits()),
      counts_(static_cast<std::size_t>(std::max(tracer.options().ambient_bounces, 1))) {
    calculation_.use_cache(&cache);
    cache_.freeze(true);
}

/// Each process adds whether it was requested to stop, so that all stop at the same place, and
/// whether it left points out.
std::vector<RoundShare> AmbientRounds::gather(RoundShare mine) {
    mine.stop = stop_.requested();
    mine.left_out = left_out_;
    std::vector<RoundShare> all;
    if (exchange_.size() == 1) {
        all.push_back(std::move(mine));
    } else {
        for (const std::string& bytes : exchange_.all_gather(wire::encode(mine))) {
            if (bytes.empty()) throw InputError("another rank takes no part in a round");
            all.push_back(wire::decode<RoundShare>(bytes));
        }
    }
    for (const RoundShare& share : all) {
        stopped_ = stopped_ || share.stop;
        left_out_ = left_out_ || share.left_out;
    }
    return all;
}

std::vector<AmbientPoint> AmbientRounds::collect(FunctionRef<void()> trace) {
    RoundShare mine;
    {
        const Collecting collecting(contexts_);
        trace();
        mine.points = collecting.points();
        left_out_ = left_out_ || collecting.left_out();
    }
    const std::vector<RoundShare> all = gather(std::move(mine));
    std::vector<AmbientPoint> points;
    for (const RoundShare& share : all)
        points.insert(points.end(), share.points.begin(), share.points.end());
    return stopped_ ? std::vector<AmbientPoint>() : points;
}

/// Whether the cache has a usable value for each of some points.
std::vector<char> AmbientRounds::served(const AmbientPoint* points, std::size_t count) {
    std::vector<char> result(count, 0);
    const auto look = [&](std::size_t task, int) {
        const std::size_t last = std::min(count, (task + 1) * kLookupsPerTask);
        for (std::size_t i = task * kLookupsPerTask; i < last; ++i)
            result[i] = calculation_.is_served(points[i]) ? 1 : 0;
    };
    executor_.for_each((count + kLookupsPerTask - 1) / kLookupsPerTask, look);
    return result;
}

void AmbientRounds::compute_in_rounds(std::vector<AmbientPoint> points) {
    if (points.empty()) return;
    const auto level = static_cast<std::size_t>(points.front().query.level);
    Waiting waiting(*this, std::move(points));
    if (level == 0) left_ = waiting.left();
    while (!stopped_) {
        const std::size_t most =
            std::clamp(counts_[level].values / kKnownPerValue, kFewestValues, kMostValues);
        waiting.look(kPointsPerValue * most);
        const std::vector<AmbientPoint> chosen = waiting.choose(most);
        if (chosen.empty()) return;
        prepare(chosen);
        if (stopped_) return;
        const std::vector<RoundValue> values = compute(chosen);
        if (stopped_) return;
        store(chosen, values);
        if (level == 0) left_ = waiting.left();
        after_round_(left_);
    }
}

/// Compute the values of the next level that the values of these points will need.
void AmbientRounds::prepare(const std::vector<AmbientPoint>& chosen) {
    if (chosen.front().query.level + 1 >= tracer_.options().ambient_bounces) return;
    compute_in_rounds(collect([&] {
        const auto prefetch = [&](std::size_t task, int worker) {
            if (exchange_.does(task)) calculation_.prefetch(chosen[task], contexts_[worker]);
        };
        executor_.for_each(chosen.size(), prefetch, stop_);
    }));
}

/// The values of the points, in their order; after a stop, nothing.
std::vector<RoundValue> AmbientRounds::compute(const std::vector<AmbientPoint>& chosen) {
    RoundShare mine;
    mine.values.resize(chosen.size());
    const auto make = [&](std::size_t task, int worker) {
        if (!exchange_.does(task)) return;
        RecordCollector collector(contexts_[worker]);
        mine.values[task].record = calculation_.record_at(chosen[task], contexts_[worker]);
        mine.values[task].new_records = collector.take();
    };
    executor_.for_each(chosen.size(), make, stop_);
    std::vector<RoundShare> all = gather(std::move(mine));
    if (stopped_) return {};
    std::vector<RoundValue> made(chosen.size());
    for (std::size_t other = 0; other < all.size(); ++other) {
        std::vector<RoundValue>& theirs = all[other].values;
        if (theirs.size() != made.size())
            throw InputError("another rank computes other ambient values");
        for (std::size_t i = other; i < made.size(); i += all.size())
            made[i] = std::move(theirs[i]);
    }
    return made;
}

/// Store the values of all chosen points; of those computed on the way, only the ones that no
/// stored value replaces.
void AmbientRounds::store(const std::vector<AmbientPoint>& chosen,
                          const std::vector<RoundValue>& values) {
    Counts& counts = counts_[static_cast<std::size_t>(chosen.front().query.level)];
    ++counts.rounds;
    counts.values += chosen.size();
    cache_.freeze(false);
    for (std::size_t i = 0; i < values.size(); ++i) {
        for (const NewAmbientRecord& find : values[i].new_records) {
            ++counts_.at(static_cast<std::size_t>(find.point.query.level)).new_records;
            if (!calculation_.is_served(find.point)) store(find.record);
        }
        if (!values[i].record) continue;
        if (calculation_.is_served(chosen[i])) ++counts.needless;
        store(*values[i].record);
    }
    cache_.freeze(true);
}

void AmbientRounds::store(const AmbientRecord& record) {
    cache_.insert(record);
    guess_.add(record);
}

}  // namespace lightwalk
