#include "core/batch/shading_batch.h"

#include <algorithm>
#include <utility>

#include "core/transport/light_groups.h"

namespace lightwalk {
namespace {

/// Sets, for its lifetime, the batch in which the running code may wait.
class BatchScope {
  public:
    BatchScope(TraceContext& context, ShadingBatch* batch)
        : context_(context), before_(std::exchange(context.batches.current, batch)) {}
    ~BatchScope() { context_.batches.current = before_; }
    BatchScope(const BatchScope&) = delete;
    BatchScope& operator=(const BatchScope&) = delete;

  private:
    TraceContext& context_;
    ShadingBatch* before_;
};

}  // namespace

/// Nothing else is allocated while fibers wait: what would be thrown then would leave them behind,
/// in the midst of bodies whose caller is gone.
ShadingBatch::ShadingBatch(std::unique_ptr<Fibers> fibers)
    : fibers_(std::move(fibers)), tasks_(fibers_->size()) {
    waiting_.reserve(tasks_.size());
    answered_.reserve(tasks_.size());
    requests_.reserve(tasks_.size());
}

void ShadingBatch::run(std::size_t count, FunctionRef<void(std::size_t)> body, Calculate calculate,
                       TraceContext& context, BatchWaits waits) {
    waits_ = waits;
    nesting_ = context.path.nesting;
    level_ = context.path.ambient_level;
    around_ = context.batches.current;
    account_ = context.groups ? context.groups->account() : nullptr;
    for (std::size_t first = 0; first < count; first += tasks_.size())
        run_part(first, std::min(tasks_.size(), count - first), body, calculate, context);
}

void ShadingBatch::run_part(std::size_t first, std::size_t count,
                            FunctionRef<void(std::size_t)> body, Calculate calculate,
                            TraceContext& context) {
    if (nesting_.rays == 0) context.path.start();  // one for all
    const auto work = [&] {
        ShadingTask& own = tasks_[running_];
        try {
            body(first + running_);
        } catch (...) {
            own.failed = std::current_exception();
        }
    };
    const FunctionRef<void()> work_ref(work);
    const auto run_on = [&](std::size_t i, auto&& enter) {
        const BatchScope batch_scope(context, this);
        running_ = i;
        context.path.nesting = tasks_[i].nesting;
        const GroupSums::Turned turned(context.groups, tasks_[i].account);
        bool done = enter();
        while (!done && tasks_[i].outside) {
            go_outside(tasks_[i], context);
            context.path.nesting = tasks_[i].nesting;
            done = fibers_->resume(i);
        }
        if (!done) waiting_.push_back(i);
        context.path.nesting = nesting_;
    };
    waiting_.clear();
    std::size_t begun = 0;
    for (; begun < count && fibers_->prepare(begun); ++begun) {
        tasks_[begun] = {nullptr, nullptr, nesting_, account_, nullptr};
        run_on(begun, [&] { return fibers_->start(begun, work_ref); });
    }
    while (!waiting_.empty()) {
        calculate_all(calculate, context);
        answered_.swap(waiting_);
        waiting_.clear();
        for (const std::size_t i : answered_) run_on(i, [&] { return fibers_->resume(i); });
    }
    for (std::size_t i = 0; i < begun; ++i)
        if (tasks_[i].failed) std::rethrow_exception(std::exchange(tasks_[i].failed, nullptr));
    const BatchScope alone(
        context, around_);  // fallback without fibers, where there is no memory for stacks
    for (std::size_t i = begun; i < count; ++i) body(first + i);
}

void ShadingBatch::calculate_all(Calculate calculate, TraceContext& context) {
    requests_.clear();
    for (const std::size_t i : waiting_) requests_.push_back(*tasks_[i].request);
    const BatchScope outside(context, around_);
    const Nesting nesting = context.path.nesting;
    context.path.nesting =
        tasks_[waiting_.front()].nesting;  // the depth of the parents of shadow rays
    try {
        calculate(requests_);
    } catch (...) {
        for (const std::size_t i : waiting_) tasks_[i].failed = std::current_exception();
    }
    context.path.nesting = nesting;
}

void ShadingBatch::go_outside(ShadingTask& task, TraceContext& context) {
    const BatchScope outside(context, around_);
    context.path.nesting = task.nesting;
    try {
        (*task.outside)();
    } catch (...) {
        task.failed = std::current_exception();
    }
    task.outside = nullptr;
}

void ShadingBatch::leave(TraceContext& context) {
    const std::size_t own = running_;
    tasks_[own].nesting = context.path.nesting;
    if (context.groups) tasks_[own].account = context.groups->account();
    fibers_->wait();
    if (tasks_[own].failed) std::rethrow_exception(std::exchange(tasks_[own].failed, nullptr));
}

bool ShadingBatch::may_wait(const TraceContext& context) const {
    if (context.path.ambient_level != level_) return false;
    return waits_ == BatchWaits::anywhere ||
           context.path.nesting == Nesting{nesting_.rays + 1, nesting_.mixtures};
}

void ShadingBatch::wait(const DirectRequest& request, TraceContext& context) {
    tasks_[running_].request = &request;
    leave(context);
}

void ShadingBatch::outside(FunctionRef<void()> work, TraceContext& context) {
    tasks_[running_].outside = &work;
    leave(context);
}

}  // namespace lightwalk
