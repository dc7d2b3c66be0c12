#include "parallel/ranks/trace_work.h"

#include <chrono>
#include <utility>

namespace lightwalk {
namespace {

using Clock = std::chrono::steady_clock;
using Payload = FinishedWork::Payload;

/// One of the threads that trace.
class TracingThread {
  public:
    TracingThread(const TraceFunctions& functions, int worker, Timeline* timeline)
        : functions_(functions), worker_(worker), timeline_(timeline) {}

    void trace(const std::shared_ptr<OpenPicture>& picture) const { make(*picture); }

    void trace(const TracerInbox::PictureBlock& block) {
        make(*block.picture);
        const Clock::time_point begin = Clock::now();
        if (!block.picture->renderer->render(block.work.block, worker_, pixels_))
            return;  // stopped
        Pixels traced{block.work, {}};
        if (block.picture->start.keep) traced.values = pixels_.values;
        finish(begin, Payload::block, block.work.job, block.work.block.pixels(), std::move(traced));
    }

    void trace(const RayChunk& chunk) const {
        const Clock::time_point begin = Clock::now();
        RayAnswer answer{chunk.number, functions_.answer_chunk(chunk, worker_)};
        finish(begin, Payload::rays, 0, chunk.rays(), std::move(answer));
    }

  private:
    void make(OpenPicture& picture) const {
        std::call_once(picture.made,
                       [&] { picture.renderer = functions_.make_renderer(picture.start); });
    }
    void finish(Clock::time_point begin, Payload payload, JobId job, std::size_t count,
                TracedWork traced) const {
        const Clock::time_point end = Clock::now();
        if (timeline_ != nullptr) timeline_->add(worker_, Activity::trace, begin, end);
        const std::chrono::duration<double> seconds = end - begin;
        functions_.finish({payload, job, static_cast<std::uint32_t>(count), seconds.count()},
                          std::move(traced));
    }

    const TraceFunctions& functions_;
    int worker_;
    Timeline* timeline_;
    BlockPixels pixels_;
};

}  // namespace

void trace_work(TracerInbox& inbox, const TraceFunctions& functions, Executor& executor,
                const StopFlag& stop, Timeline* timeline) {
    run_on_all(inbox, executor, stop, [&](int worker) {
        TracingThread thread(functions, worker, timeline);
        const auto next = [&] {
            const TimedActivity waiting(timeline, worker, Activity::wait);
            return inbox.next(stop);
        };
        while (std::optional<TracerInbox::Item> item = next())
            std::visit([&](auto& kind) { thread.trace(kind); }, *item);
    });
}

}  // namespace lightwalk
