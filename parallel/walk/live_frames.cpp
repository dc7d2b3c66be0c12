#include "parallel/walk/live_frames.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/light/small_sources.h"
#include "parallel/pixel_tracer.h"
#include "parallel/walk/scene_caster.h"
#include "parallel/walk/uncached_pixel_tracer.h"

namespace lightwalk {
namespace {

constexpr std::size_t kPixelsALiveTask = 16;
constexpr std::size_t kMostDraftedValues = 1 << 25;  ///< of light groups, some 400 MB

}  // namespace

TracedValues trace_pixels(const Tracer& tracer, WorkerContexts& contexts, const Camera& camera,
                          const FrameOptions& options, const ProgressiveWork& work, double seconds,
                          Executor& executor, const StopFlag& stop, const LightMixture& mixture) {
    const PixelRays rays = rays_of_sample(camera, options, work.sample);
    const UncachedPixelTracer::Clock::time_point deadline = FrameClock().in(seconds);
    TracedValues traced(std::vector<std::optional<PixelValue>>(work.places.size()));
    const std::size_t groups = contexts.light_groups() ? contexts.light_groups()->size() : 0;
    traced.groups.resize(work.places.size() * groups);
    const auto mix = [&](const Rgb& whole, std::span<const Rgb> of_groups) {
        return groups > 0 ? mixture(whole, of_groups) : whole;
    };
    contexts.reset_counters();
    executor.for_each(
        (work.places.size() + kPixelsALiveTask - 1) / kPixelsALiveTask,
        [&](std::size_t task, int worker) {
            if (task > 0 && UncachedPixelTracer::Clock::now() > deadline) return;
            const std::size_t first = task * kPixelsALiveTask;
            const std::size_t count = std::min(kPixelsALiveTask, work.places.size() - first);
            std::array<PixelValue, kPixelsALiveTask> part;
            PixelTracer trace(tracer, rays, contexts[worker], stop);
            trace(std::span(work.places).subspan(first, count), {part.data(), count});
            if (stop.requested()) return;
            for (std::size_t i = 0; i < count; ++i) {
                const std::span<const Rgb> of_groups = trace.groups(i);
                part[i].radiance = mix(part[i].radiance, of_groups);
                traced.values[first + i] = part[i];
                std::ranges::copy(of_groups, traced.groups.begin() +
                                                 static_cast<std::ptrdiff_t>((first + i) * groups));
            }
        },
        stop);
    return traced;
}

Frame turned_over(const CloudFrame& drawn, Executor& executor) {
    constexpr int kRowsATask = 32;
    Frame frame;
    const int width = frame.width = drawn.area.width();
    const int height = frame.height = drawn.area.height();
    frame.radiance.resize(drawn.radiance.size());
    frame.distance.resize(drawn.distance.size());
    const auto copy_row = [&](int y, const auto& from, auto& to) {
        std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(y) * width, width,
                    to.begin() + static_cast<std::ptrdiff_t>(height - 1 - y) * width);
    };
    const auto tasks = static_cast<std::size_t>((height + kRowsATask - 1) / kRowsATask);
    executor.for_each(tasks, [&](std::size_t task, int) {
        const int first = static_cast<int>(task) * kRowsATask;
        for (int y = first; y < std::min(first + kRowsATask, height); ++y) {
            copy_row(y, drawn.radiance, frame.radiance);
            copy_row(y, drawn.distance, frame.distance);
        }
    });
    return frame;
}

void draw_small_sources(const Tracer& tracer, const Camera& camera, const FrameOptions& options,
                        Executor& executor, WorkerContexts& contexts, Frame& frame, int samples,
                        const LightMixture& mixture) {
    if (options.pixels.samples > 1) return;
    const PixelRays rays = rays_of_sample(camera, options, 0);
    const SmallSources sources(tracer, camera, options.width, options.height, 1,
                               samples > 0 ? &rays : nullptr, samples == 1);
    if (sources.empty()) return;
    const std::vector<Block> blocks = make_blocks(options.whole(), 64);
    executor.for_each(blocks.size(), [&](std::size_t i, int worker) {
        sources.draw(blocks[i], contexts[worker], [&](SourcePixel source) {
            if (const GroupSums* sums = contexts[worker].groups)
                source.radiance = mixture(source.radiance, sums->sums());
            const std::size_t at = static_cast<std::size_t>(frame.height - 1 - source.y) *
                                       static_cast<std::size_t>(frame.width) +
                                   static_cast<std::size_t>(source.x);
            blend_source(source, frame.radiance[at],
                         options.use_distances ? &frame.distance[at] : nullptr);
        });
    });
}

LiveFrames::LiveFrames(const Tracer& direct, const Tracer* indirect, const CloudOptions& cloud,
                       const FrameOptions& options, Executor& executor, WarningSink& warnings)
    : cloud_(cloud),
      options_(options),
      executor_(executor),
      direct_(std::make_unique<WalkLight>(direct, warnings, executor.concurrency())) {
    if (indirect != nullptr)
        indirect_ = std::make_unique<WalkLight>(*indirect, warnings, executor.concurrency());
}

/// Points of another light are of no use.
void LiveFrames::begin(int width, int height, bool indirect, std::uint64_t first) {
    options_.width = width;
    options_.height = height;
    walking_ = indirect ? indirect_.get() : direct_.get();
    start(first);
}

void LiveFrames::resize(int width, int height) {
    options_.width = width;
    options_.height = height;
    resized();
}

std::optional<double> LiveFrames::look_aside(const View& view, int width, int height, double budget,
                                             const StopFlag& stop) {
    const auto give_size = [&](int own_width, int own_height) {
        options_.width = own_width;
        options_.height = own_height;
    };
    const int rested_width = options_.width, rested_height = options_.height;
    const auto back = [&] {
        give_size(rested_width, rested_height);
        take_back();
    };
    put_aside();
    give_size(width, height);
    resized();
    WalkFrame drawn;
    try {
        drawn = draw(view, budget, 1, stop);
    } catch (...) {
        back();
        throw;
    }
    back();
    if (!drawn.frame.complete) return std::nullopt;
    return static_cast<double>(drawn.report.filled) / static_cast<double>(drawn.report.pixels);
}

void LiveFrames::add_small_sources(const View& view, Frame& frame, bool indirect) {
    WalkLight& light = indirect ? *indirect_ : *walking_;
    draw_small_sources(light.tracer, Camera(view), options_, executor_, light.contexts, frame,
                       cloud_.samples, mixture_);
}

void LiveFrames::keep_groups(const std::shared_ptr<const LightGroups>& groups) {
    direct_->contexts.sum_by(groups);
    if (indirect_) indirect_->contexts.sum_by(groups);
    cloud_.light_groups = groups->size();
}

void LiveFrames::change(const Tracer& direct, const Tracer* indirect,
                        const std::shared_ptr<const LightGroups>& groups, WarningSink& warnings) {
    const bool walks_indirect = walking_ != nullptr && walking_ == indirect_.get();
    draft_.reset();
    direct_ = std::make_unique<WalkLight>(direct, warnings, executor_.concurrency());
    indirect_ = indirect == nullptr
                    ? nullptr
                    : std::make_unique<WalkLight>(*indirect, warnings, executor_.concurrency());
    if (groups) keep_groups(groups);
    const std::optional<ShownMaterials> only = std::exchange(outdated_, std::nullopt);
    if (walking_ == nullptr) return;
    walking_ = walks_indirect && indirect_ ? indirect_.get() : direct_.get();
    kept_ = outdate(only ? &*only : nullptr);
}

ViewDraft LiveFrames::draft(const View& view, double seconds, const StopFlag& stop) {
    if (options_.whole().pixels() * cloud_.light_groups > kMostDraftedValues) return {};
    if (!draft_) {
        draft_ = std::make_unique<FirstLight>(indirect_->tracer, direct_->tracer, light_groups(),
                                              executor_.concurrency());
        draft_->mix(mixture_);
    }
    const ViewDraft made = draft_->step(view, options_, seconds, executor_, stop);
    rays_ = draft_->rays();
    return made;
}

/// Points show another light: there is nothing to be told by them.
double LocalFrames::outdate(const ShownMaterials* only) {
    if (only != nullptr && frames_) return frames_->drop(*only);
    start(0);
    return 0;
}

void LocalFrames::start(std::uint64_t first) {
    frames_ = std::make_unique<CloudFrames>(options_.width, options_.height, cloud_, first);
    (void)mixed();
}

const ProgressivePicture* LocalFrames::mixed() {
    return frames_ ? frames_->mix(mixture_) : nullptr;
}

WalkFrame LocalFrames::draw(const View& view, double budget, double refine, const StopFlag& stop) {
    frames_->set_budget(budget);
    frames_->set_refine(refine);
    WorkerContexts& contexts = walking_->contexts;
    contexts.reset_counters();
    const bool rests = frames_->refines(view);
    SceneCaster caster(walking_->tracer, walking_->visibility, Camera(view), options_, contexts,
                       stop, use_of_frame(budget, rests), &mixture_);
    const CloudFrame& drawn = frames_->draw(caster.camera(), caster, executor_, stop);
    WalkFrame result{turned_over(drawn, executor_), drawn.report};
    if (drawn.complete)
        draw_small_sources(walking_->tracer, caster.camera(), options_, executor_, contexts,
                           result.frame, rests ? cloud_.samples : 0, mixture_);
    result.frame.rays = contexts.rays();
    result.frame.ambient = contexts.ambient();
    result.frame.complete = drawn.complete && !stop.requested();
    rays_ = result.frame.rays.total();
    return result;
}

TracedValues LocalFrames::trace(const View& view, const ProgressiveWork& work, double seconds,
                                const StopFlag& stop) {
    TracedValues values = trace_pixels(indirect_->tracer, indirect_->contexts, Camera(view),
                                       options_, work, seconds, executor_, stop, mixture_);
    rays_ = indirect_->contexts.rays().total();
    return values;
}

}  // namespace lightwalk
