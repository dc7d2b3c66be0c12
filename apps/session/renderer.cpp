#include "apps/session/lightwalk/renderer.h"

#include <condition_variable>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include "apps/session/local_backend.h"
#include "apps/session/render_backend.h"

namespace lightwalk {

/// The tasks that were started. One is done at a time, by whoever waits for it, or, where somebody
/// only asks how far it is, by a thread of its own.
struct Renderer::Impl {
    explicit Impl(std::unique_ptr<RenderBackend> with) : backend(std::move(with)) {}
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
    ~Impl() {
        if (!background.joinable()) return;
        backend->stop().request();
        background.join();
    }

    struct Pending {
        std::uint64_t number = 0;
        std::shared_ptr<const PictureRequest> picture;  ///< null: rays
        RayTask rays;
        bool begun = false;
    };
    /// Neither a picture nor bytes nor an error: cancelled.
    struct Outcome {
        std::optional<RenderedPicture> picture;
        std::optional<std::string> bytes;
        std::exception_ptr error;
    };

    std::uint64_t start(Pending task) {
        const std::lock_guard lock(mutex);
        if (cancelled && pending.empty()) {
            backend->stop().clear();
            cancelled = false;
        }
        task.number = next++;
        pending.push_back(std::move(task));
        if (!busy) begin_all();
        return pending.back().number;
    }

    /// As many as may be under way. Not while the backend works: it need not be able to begin
    /// others then.
    void begin_all() {
        std::size_t pictures = 0;
        for (Pending& task : pending) {
            if (task.picture && ++pictures > backend->pictures_ahead()) return;
            if (std::exchange(task.begun, true)) continue;
            if (task.picture)
                backend->begin(*task.picture);
            else
                backend->begin(task.rays);
        }
    }

    void make(const Pending& task, Outcome& outcome) {
        if (!task.picture) {
            outcome.bytes = backend->finish(task.rays);
        } else if (std::optional<Frame> frame = backend->finish(*task.picture)) {
            outcome.picture = {frame->width,
                               frame->height,
                               std::move(frame->radiance),
                               std::move(frame->distance),
                               frame->rays.total(),
                               std::move(frame->error),
                               std::move(frame->half),
                               {}};
            for (std::size_t g = 0; g < frame->groups.size(); ++g)
                outcome.picture->layers.push_back(
                    {backend->light_groups()->names[g], std::move(frame->groups[g])});
        }
    }

    /// Does the oldest task. `busy` has been set.
    void do_oldest(std::unique_lock<std::mutex>& lock) {
        const Pending& task = pending.front();
        lock.unlock();
        Outcome outcome;
        try {
            make(task, outcome);
        } catch (...) {
            outcome.error = std::current_exception();
        }
        lock.lock();
        outcomes[task.number] = std::move(outcome);
        pending.pop_front();
        begin_all();
        busy = false;
        changed.notify_all();
    }

    void begin_background() {
        if (busy || pending.empty()) return;
        busy = true;
        if (background.joinable()) background.join();  // has ended: it clears `busy` last
        background = std::thread([this] {
            std::unique_lock lock(mutex);
            do_oldest(lock);
        });
    }

    Outcome finish(std::uint64_t number) {
        std::unique_lock lock(mutex);
        while (!outcomes.contains(number)) {
            if (pending.empty() || number < pending.front().number)
                throw std::invalid_argument("this task was finished before, or never started");
            if (busy) {
                changed.wait(lock);
            } else {
                busy = true;
                do_oldest(lock);
            }
        }
        Outcome outcome = std::move(outcomes[number]);
        outcomes.erase(number);
        lock.unlock();
        if (outcome.error) std::rethrow_exception(outcome.error);
        return outcome;
    }

    RenderProgress poll(std::uint64_t number) {
        const std::lock_guard lock(mutex);
        RenderProgress progress;
        if (const auto found = outcomes.find(number); found != outcomes.end()) {
            const Outcome& outcome = found->second;
            const bool cancelled_task = !outcome.picture && !outcome.bytes && !outcome.error;
            progress.stage =
                cancelled_task ? RenderProgress::Stage::cancelled : RenderProgress::Stage::finished;
            progress.done = cancelled_task ? 0 : 1;
            return progress;
        }
        begin_background();
        // The report may still be that of the task before.
        if (!pending.empty() && pending.front().number == number) progress = backend->progress();
        const bool ended = progress.stage == RenderProgress::Stage::finished ||
                           progress.stage == RenderProgress::Stage::cancelled;
        return ended ? RenderProgress{} : progress;
    }

    std::unique_ptr<RenderBackend> backend;
    std::mutex mutex;  ///< guards what follows
    std::condition_variable changed;
    std::deque<Pending> pending;  ///< the front one is worked on while `busy`
    std::map<std::uint64_t, Outcome> outcomes;
    std::uint64_t next = 1;
    bool busy = false, cancelled = false;
    std::thread background;
};

Renderer::Renderer(const LoadedScene& scene, const RendererOptions& options)
    : Renderer(std::make_unique<LocalBackend>(scene.compiled(), options)) {}

Renderer::Renderer(std::unique_ptr<RenderBackend> backend)
    : impl_(std::make_unique<Impl>(std::move(backend))) {}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Ticket<RenderedPicture> Renderer::start(PictureTask task) {
    const FrameOptions options = impl_->backend->frame_options(task.width, task.height);
    if (task.width < 1 || task.height < 1) throw InputError("a picture without pixels");
    const auto request =
        std::make_shared<PictureRequest>(task.view, task.before ? &*task.before : nullptr, options);
    request->checkpoint = std::move(task.checkpoint);
    Impl::Pending pending;
    pending.picture = request;
    return {impl_->start(std::move(pending))};
}

Ticket<RayBytes> Renderer::start(RayTask task) {
    Impl::Pending pending;
    pending.rays = std::move(task);
    return {impl_->start(std::move(pending))};
}

RenderProgress Renderer::poll_task(std::uint64_t number) {
    return impl_->poll(number);
}

std::optional<RenderedPicture> Renderer::finish(Ticket<RenderedPicture> ticket) {
    return impl_->finish(ticket.number).picture;
}

std::optional<RayBytes> Renderer::finish(Ticket<RayBytes> ticket) {
    std::optional<std::string> bytes = impl_->finish(ticket.number).bytes;
    if (!bytes) return std::nullopt;
    return RayBytes{std::move(*bytes)};
}

void Renderer::cancel() {
    const std::lock_guard lock(impl_->mutex);
    if (impl_->pending.empty()) return;
    impl_->cancelled = true;
    impl_->backend->stop().request();
}

std::size_t Renderer::pictures_ahead() const {
    return impl_->backend->pictures_ahead();
}

RayDemand Renderer::ray_demand(bool wait) {
    std::unique_lock lock(impl_->mutex);
    const bool begun = !impl_->pending.empty();
    lock.unlock();
    RayDemand demand = impl_->backend->ray_demand(wait, begun);
    lock.lock();
    demand.answered = demand.answered || !impl_->outcomes.empty();
    return demand;
}

void Renderer::run(FunctionRef<void()> lead) {
    impl_->backend->run(lead);
}

RenderBackend& Renderer::backend() {
    return *impl_->backend;
}

}  // namespace lightwalk
