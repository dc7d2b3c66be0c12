#include "apps/ray_stream.h"

#include <unistd.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "apps/interrupt.h"

namespace lightwalk {

RayStream::RayStream(NumberFormat format) : reader_(STDIN_FILENO, format) {}

bool RayStream::skip(std::uint64_t rays) {
    for (std::uint64_t i = 0; i < rays; ++i, ++read_)
        if (!reader_.next()) return false;
    return true;
}

void RayStream::answer_all(Renderer& renderer, Take take, FunctionRef<void()> flush) {
    answer_all(
        std::span(&renderer, 1), [&](std::span<const std::string> bytes) { take(bytes.front()); },
        flush);
}

void RayStream::answer_all(std::span<Renderer> renderers, TakeEach take,
                           FunctionRef<void()> flush) {
    bool more = true, wanted = true;
    while (more || !lists_.empty()) {
        if (interrupt_flag().requested()) return;
        // Where there is nothing to read for, something else has to come.
        const RayDemand demand = renderers.front().ray_demand(!(more && wanted));
        wanted = demand.lists > 0;
        if (demand.answered) {
            if (!put_answer(renderers, take)) return;
        } else if (more && wanted) {
            more = read_batch(std::min(demand.rays, limits_.most));
            if (more) give_batch(renderers, take, flush);
        }
    }
    complete_ = true;
}

void RayStream::give_batch(std::span<Renderer> renderers, TakeEach take,
                           FunctionRef<void()> flush) {
    const std::uint64_t first = read_ - queries_.size();
    std::vector<Ticket<RayBytes>>& tickets = lists_.emplace_back();
    for (Renderer& renderer : renderers.first(renderers.size() - 1))
        tickets.push_back(renderer.start(RayTask{queries_, first}));
    tickets.push_back(renderers.back().start(RayTask{std::move(queries_), first}));
    if (!flush_due_) return;
    while (!lists_.empty() && put_answer(renderers, take)) {
    }
    flush();
}

/// Of the oldest list. False: stopped.
bool RayStream::put_answer(std::span<Renderer> renderers, TakeEach take) {
    const std::vector<Ticket<RayBytes>> tickets = std::move(lists_.front());
    lists_.pop_front();
    std::vector<std::string> answers;
    for (std::size_t k = 0; k < renderers.size(); ++k) {
        std::optional<RayBytes> answer = renderers[k].finish(tickets[k]);
        if (!answer) return false;
        answers.push_back(std::move(answer->bytes));
    }
    take(answers);
    return true;
}

/// Read rays until the batch is full or an answer is due. False: there are no more.
bool RayStream::read_batch(std::size_t most) {
    queries_.clear();
    flush_due_ = false;
    while (queries_.size() < most && !flush_due_ &&
           (limits_.expected == 0 || read_ < limits_.expected)) {
        const std::optional<InputRay> ray = reader_.next();
        if (!ray) break;
        queries_.push_back({ray->origin, ray->direction});
        ++read_;
        const bool row_ends = limits_.row > 0 && ++in_row_ >= limits_.row;
        if (row_ends) in_row_ = 0;
        // Who sends rays through a pipe and waits for answers does so at a row's end or with a
        // zero direction.
        flush_due_ = (ray->is_flush() || row_ends) && (limits_.waits || reader_.drained());
    }
    return !queries_.empty();
}

}  // namespace lightwalk
