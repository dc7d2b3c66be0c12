#include "parallel/ambient_rounds.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/transport/light_groups.h"
#include "parallel/waiting_points.h"

namespace lightwalk {
namespace {

constexpr std::size_t kLookupsPerTask = 64;

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

AmbientRounds::AmbientRounds(const Tracer& tracer, PublishedCache& cache, Executor& executor,
                             WorkerContexts& contexts, Group& exchange, const StopFlag& stop,
                             std::function<void(std::size_t left)> after_round,
                             CheckpointSink* checkpoint)
    : tracer_(tracer),
      cache_(cache),
      executor_(executor),
      contexts_(contexts),
      exchange_(exchange),
      stop_(stop),
      after_round_(std::move(after_round)),
      checkpoint_(checkpoint),
      calculation_(tracer),
      guess_(cache.limits()),
      counts_(static_cast<std::size_t>(std::max(tracer.options().ambient_bounces, 1))) {
    calculation_.use_cache(&cache);
    cache_.freeze(true);
    agree_on_known();
}

/// Rounds that begin with another cache are others.
void AmbientRounds::agree_on_known() {
    const AmbientLogMean mean = cache_.log_mean();
    const std::string beginning = wire::encode(RoundsBeginning{mean.count, mean.sum});
    if (checkpoint_ != nullptr) {
        const std::vector<std::string> steps = checkpoint_->known_steps(beginning);
        known_.assign(steps.begin(), steps.end());
    }
    known_steps_ = known_.size();
    if (exchange_.parts() == 1) return;
    for (const std::string& told : exchange_.all_gather(wire::encode(RoundsKnown{known_steps_})))
        known_steps_ = std::max<std::size_t>(known_steps_, wire::decode<RoundsKnown>(told).steps);
}

/// Of the other processes nothing.
RoundShare AmbientRounds::take_known() {
    if (known_.empty()) return {};
    auto step = wire::decode<RoundShare>(known_.front());
    known_.pop_front();
    return step;
}

/// A step that is done, unless it was known.
void AmbientRounds::keep(const RoundShare& step) {
    const bool fresh = !is_known();
    ++steps_;
    if (fresh && checkpoint_ != nullptr) checkpoint_->keep_step(wire::encode(step));
}

/// Each process adds whether it was requested to stop, so that all stop at the same place, and
/// whether it left points out.
std::vector<RoundShare> AmbientRounds::gather(RoundShare mine) {
    mine.stop = stop_.requested();
    mine.left_out = mine.left_out || left_out_;
    std::vector<RoundShare> all;
    if (exchange_.parts() == 1) {
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
    if (is_known()) {
        mine = take_known();
    } else {
        const CollectingPoints collecting(contexts_);
        trace();
        mine.points = collecting.points();
        mine.left_out = collecting.left_out();
    }
    const std::vector<RoundShare> all = gather(std::move(mine));
    if (stopped_) return {};
    RoundShare found;
    found.left_out = left_out_;
    for (const RoundShare& share : all)
        found.points.insert(found.points.end(), share.points.begin(), share.points.end());
    keep(found);
    return std::move(found.points);
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
    WaitingPoints waiting(
        std::move(points), guess_,
        [this](const AmbientPoint* some, std::size_t count) { return served(some, count); });
    if (level == 0) left_ = waiting.left();
    while (!stopped_) {
        const std::vector<AmbientPoint> chosen =
            waiting.choose(WaitingPoints::most_values(counts_[level].values));
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
    if (is_known()) return look_up(chosen.size());
    RoundShare mine;
    mine.values.resize(chosen.size());
    const auto make = [&](std::size_t task, int worker) {
        if (!exchange_.does(task)) return;
        TraceContext& context = contexts_[worker];
        RecordCollector collector(context);
        const GroupSums::Part apart(context.groups, nullptr);
        RoundValue& value = mine.values[task];
        value.record = calculation_.record_at(chosen[task], context);
        value.new_records = collector.take();
        if (context.groups)
            value.groups.assign(context.groups->sums().begin(), context.groups->sums().end());
    };
    executor_.for_each(chosen.size(), make, stop_);
    std::vector<RoundShare> all = gather(std::move(mine));
    if (stopped_) return {};
    RoundShare made;
    made.left_out = left_out_;
    made.values.resize(chosen.size());
    for (const RoundShare& share : all)
        if (share.values.size() != made.values.size())
            throw InputError("another rank computes other ambient values");
    const auto workers = static_cast<std::size_t>(exchange_.size());
    for (std::size_t i = 0; i < chosen.size(); ++i)
        made.values[i] = std::move(all[i % workers].values[i]);
    keep(made);
    return std::move(made.values);
}

/// The values of a step that a checkpoint has.
std::vector<RoundValue> AmbientRounds::look_up(std::size_t count) {
    std::vector<RoundShare> all = gather(take_known());
    if (stopped_) return {};
    for (RoundShare& share : all) {
        if (share.values.size() != count) continue;
        keep(share);
        return std::move(share.values);
    }
    throw InputError("the checkpoint has ambient values of other rounds");
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
            if (!calculation_.is_served(find.point)) store(find.record, find.groups);
        }
        if (!values[i].record) continue;
        if (calculation_.is_served(chosen[i])) ++counts.needless;
        store(*values[i].record, values[i].groups);
    }
    cache_.freeze(true);
}

void AmbientRounds::store(const AmbientRecord& record, std::span<const Rgb> groups) {
    if (groups.empty())
        cache_.insert(record);
    else
        cache_.insert_with_groups(record, groups);
    guess_.add(record);
}

}  // namespace lightwalk
