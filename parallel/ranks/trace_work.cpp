#include "parallel/ranks/trace_work.h"

#include <chrono>
#include <utility>

namespace lightwalk {
namespace {

using Clock = Timeline::Clock;
using Payload = FinishedWork::Payload;

void make_renderer(const TraceFunctions& functions, OpenPicture& picture) {
    std::call_once(picture.made,
                   [&] { picture.renderer = functions.make_renderer(picture.start); });
}

}  // namespace

void trace_work(RankLink& link, const TraceFunctions& functions, Executor& executor,
                const StopFlag& stop) {
    run_on_all(link.inbox(), executor, stop, [&](int worker) {
        BlockPixels pixels;
        const auto next = [&] {
            const TimedActivity waiting(link.timeline(), worker, Activity::wait);
            return link.inbox().next(stop);
        };
        const auto finish = [&](Clock::time_point begin, FinishedWork work, TracedWork traced) {
            const Clock::time_point end = Clock::now();
            link.timeline().add(worker, Activity::trace, begin, end);
            work.seconds = std::chrono::duration<double>(end - begin).count();
            link.finish_work(work, std::move(traced));
        };
        while (std::optional<TracerInbox::Item> item = next()) {
            std::visit(
                Overloaded{
                    [&](const std::shared_ptr<OpenPicture>& picture) {
                        make_renderer(functions, *picture);
                    },
                    [&](const TracerInbox::PictureBlock& block) {
                        OpenPicture& picture = *block.picture;
                        make_renderer(functions, picture);
                        const Clock::time_point begin = Clock::now();
                        const JobBlock& work = block.work;
                        if (!picture.renderer->render(work.block, worker, pixels))
                            return;  // stopped
                        Pixels traced{work, {}};
                        if (picture.start.keep) {
                            traced.values = pixels.values;
                            traced.groups = pixels.groups;
                        }
                        const auto count = static_cast<std::uint32_t>(work.block.pixels());
                        finish(begin, {Payload::block, work.job, count, 0}, std::move(traced));
                    },
                    [&](const RayChunk& chunk) {
                        const Clock::time_point begin = Clock::now();
                        RayAnswer answer{chunk.number, functions.answer_chunk(chunk, worker)};
                        const auto count = static_cast<std::uint32_t>(chunk.rays());
                        finish(begin, {Payload::rays, 0, count, 0}, std::move(answer));
                    }},
                *item);
        }
    });
}

}  // namespace lightwalk
