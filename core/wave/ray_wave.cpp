#include "core/wave/ray_wave.h"

#include <algorithm>
#include <utility>

namespace lightwalk {
namespace {

/// Says for its lifetime which wave the code that runs may wait in.
class InWave {
  public:
    InWave(TraceContext& context, RayWave* wave)
        : context_(context), before_(std::exchange(context.wave, wave)) {}
    ~InWave() { context_.wave = before_; }
    InWave(const InWave&) = delete;
    InWave& operator=(const InWave&) = delete;

  private:
    TraceContext& context_;
    RayWave* before_;
};

}  // namespace

void RayWave::run(std::size_t count, FunctionRef<void(std::size_t)> body, Serve serve,
                  TraceContext& context) {
    level_ = context.ambient_level;
    around_ = context.wave;
    for (std::size_t first = 0; first < count; first += strands_.size())
        run_part(first, std::min(strands_.size(), count - first), body, serve, context);
}

void RayWave::run_part(std::size_t first, std::size_t count, FunctionRef<void(std::size_t)> body,
                       Serve serve, TraceContext& context) {
    const int depth = context.depth;
    if (depth == 0) context.start_path();  // one for all
    const auto work = [&] {
        Strand& own = strands_[running_];
        try {
            body(first + running_);
        } catch (...) {
            own.failed = std::current_exception();
        }
    };
    const FunctionRef<void()> work_ref(work);
    const auto run_on = [&](std::size_t i, auto&& enter) {
        const InWave in_wave(context, this);
        running_ = i;
        context.depth = strands_[i].depth;
        bool done = enter();
        while (!done && strands_[i].outside) {
            go_outside(strands_[i], context);
            context.depth = strands_[i].depth;
            done = fibers_->resume(i);
        }
        if (!done) waiting_.push_back(i);
        context.depth = depth;
    };
    waiting_.clear();
    std::size_t begun = 0;
    for (; begun < count && fibers_->prepare(begun); ++begun) {
        strands_[begun] = {nullptr, nullptr, depth, nullptr};
        run_on(begun, [&] { return fibers_->start(begun, work_ref); });
    }
    while (!waiting_.empty()) {
        serve_all(serve, context);
        served_.swap(waiting_);
        waiting_.clear();
        for (const std::size_t i : served_) run_on(i, [&] { return fibers_->resume(i); });
    }
    for (std::size_t i = 0; i < begun; ++i)
        if (strands_[i].failed) std::rethrow_exception(std::exchange(strands_[i].failed, nullptr));
    const InWave alone(context, around_);  // where there is no memory for stacks
    for (std::size_t i = begun; i < count; ++i) body(first + i);
}

void RayWave::serve_all(Serve serve, TraceContext& context) {
    requests_.clear();
    for (const std::size_t i : waiting_) requests_.push_back(*strands_[i].request);
    const InWave outside(context, around_);
    const int depth = context.depth;
    context.depth = strands_[waiting_.front()].depth;  // of shadow rays' parents
    try {
        serve(requests_);
    } catch (...) {
        for (const std::size_t i : waiting_) strands_[i].failed = std::current_exception();
    }
    context.depth = depth;
}

void RayWave::go_outside(Strand& strand, TraceContext& context) {
    const InWave outside(context, around_);
    context.depth = strand.depth;
    try {
        (*strand.outside)();
    } catch (...) {
        strand.failed = std::current_exception();
    }
    strand.outside = nullptr;
}

void RayWave::leave(TraceContext& context) {
    const std::size_t own = running_;
    strands_[own].depth = context.depth;
    fibers_->wait();
    if (strands_[own].failed) std::rethrow_exception(std::exchange(strands_[own].failed, nullptr));
}

void RayWave::wait(const DirectRequest& request, TraceContext& context) {
    strands_[running_].request = &request;
    leave(context);
}

void RayWave::outside(FunctionRef<void()> work, TraceContext& context) {
    strands_[running_].outside = &work;
    leave(context);
}

}  // namespace lightwalk
