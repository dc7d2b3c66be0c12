#include "apps/session/render_backend.h"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "apps/session/stopwatch.h"
#include "core/error.h"
#include "core/light/find_light_groups.h"
#include "core/trace/trace_rays.h"
#include "core/transport/ray.h"
#include "core/view/pixel_samples.h"

namespace lightwalk {
namespace {

/// Three channels and a distance.
constexpr std::size_t kAnswerNumbers = 4;
constexpr std::size_t kAnswerBytes = kAnswerNumbers * sizeof(double);

/// Pixels and layers that negative weights have left below it.
void cut_off_at_zero(Frame& frame) {
    std::ranges::transform(frame.radiance, frame.radiance.begin(), positive_part);
    for (std::vector<Rgb>& group : frame.groups)
        std::ranges::transform(group, group.begin(), positive_part);
}

/// A deterministic run computes all that was not in its ambient file when it began.
OthersValues use_of_others(const RendererOptions& options) {
    return options.deterministic && !options.steered ? OthersValues::left : OthersValues::taken;
}

}  // namespace

RenderBackend::RenderBackend(std::shared_ptr<const CompiledScene> scene, RendererOptions options,
                             bool leads)
    : options_(std::move(options)),
      warnings_(options_.warn),
      session_(std::make_unique<SceneSession>(std::move(scene), options_.light,
                                              leads ? options_.ambient_file : std::string(),
                                              use_of_others(options_), options_.keep_coefficients,
                                              warnings_, options_.ambient_beginning)),
      executor_(make_executor(options_.executor.value_or(kDefaultExecutor),
                              options_.threads > 0 ? options_.threads : hardware_threads())),
      contexts_(session_->tracer(), warnings_, executor_->concurrency()) {
    if (!options_.record)
        options_.record = [](const RayQuery&, const Ray& ray, const Hit& first,
                             std::string& bytes) { append_ray_answer(ray, first, bytes); };
    if (options_.light_groups) {
        if (options_.reuse && !options_.steered)
            throw InputError("light groups are for pictures that are traced by themselves");
        if (session_->ambient_store)
            throw InputError("an ambient file holds no values of light groups");
        contexts_.sum_by(find_groups(*session_));
    }
    for (int worker = 0; options_.make_tally && worker < contexts_.size(); ++worker) {
        tallies_.push_back(options_.make_tally(session_->tracer()));
        contexts_[worker].contributions = tallies_.back().get();
        contexts_[worker].observer = tallies_.back()->observer();
    }
    direct_ = make_direct(*session_, warnings_);
}

std::unique_ptr<const Tracer> RenderBackend::make_direct(const SceneSession& session,
                                                         WarningSink& warnings) const {
    RenderOptions direct = session.tracer().options();
    if (!options_.steered || direct.ambient_bounces == 0) return nullptr;
    direct.ambient_bounces = 0;
    return std::make_unique<const Tracer>(session.scene(), direct, warnings, SerialTaskRunner(),
                                          &session.tracer().lights().measures());
}

std::shared_ptr<const LightGroups> RenderBackend::find_groups(const SceneSession& session) const {
    if (!options_.light_groups) return nullptr;
    return std::make_shared<const LightGroups>(
        find_light_groups(session.scene(), options_.light, *options_.light_groups));
}

void RenderBackend::change(const std::shared_ptr<const CompiledScene>& /*scene*/) {
    throw InputError("the scene of a walk on ranks is changed by its description");
}

void RenderBackend::change_model(const ModelChange& change) {
    this->change(changed_scene(change));
}

std::shared_ptr<const CompiledScene> RenderBackend::changed_scene(const ModelChange& change) const {
    const std::shared_ptr<const CompiledScene>& now = session_->shared_compiled();
    return std::make_shared<const CompiledScene>(now, change, now->warnings());
}

/// An ambient file is of the light that the scene has been read with.
RenderBackend::ChangedScene RenderBackend::make_changed(
    const std::shared_ptr<const CompiledScene>& scene) {
    ChangedScene next;
    next.session =
        std::make_unique<SceneSession>(scene, options_.light, std::string(), OthersValues::left,
                                       options_.keep_coefficients, quiet_);
    next.direct = make_direct(*next.session, quiet_);
    next.groups = find_groups(*next.session);
    return next;
}

void RenderBackend::take_over(ChangedScene& next, LiveFrames* frames) {
    const Tracer& tracer = next.session->tracer();
    if (frames != nullptr)
        frames->change(next.direct ? *next.direct : tracer, next.direct ? &tracer : nullptr,
                       next.groups, warnings_);
    contexts_ = WorkerContexts(tracer, warnings_, executor_->concurrency());
    contexts_.sum_by(next.groups);
    std::swap(direct_, next.direct);
    std::swap(session_, next.session);
}

FrameOptions RenderBackend::frame_options(int width, int height) const {
    FrameOptions options;
    options.width = width;
    options.height = height;
    options.pixels = options_.pixels;
    options.seed = options_.light.seed;
    options.use_distances = options_.use_distances;
    if (options_.steered || options_.light_groups) options.pixels.spacing = 1;
    return options;
}

RenderProgress RenderBackend::progress() const {
    const std::lock_guard lock(mutex_);
    return progress_;
}

ProgressListener RenderBackend::listener() {
    const auto tell = [this](const RenderProgress& progress) {
        {
            const std::lock_guard lock(mutex_);
            progress_ = progress;
        }
        if (options_.progress) options_.progress(progress);
    };
    return {tell, options_.progress_interval};
}

CachePrepass RenderBackend::prepass() const {
    if (!session_->freezable) return CachePrepass::none;
    if (options_.deterministic) return CachePrepass::deterministic;
    return options_.cache_prepass ? CachePrepass::quick : CachePrepass::none;
}

std::optional<Frame> RenderBackend::draw_until_good(const PictureRequest& request, DrawPass draw) {
    const FrameOptions& options = request.options;
    AdaptivePicture picture(options.width, options.height, options.pixels.samples, options.seed,
                            options_.goal);
    WorkPhase all;
    all.pixels = static_cast<double>(options.area().pixels());
    ProgressReporter reporter(listener(), {all});
    const std::uint64_t before = statistics_.rays.total();
    const Stopwatch watch;
    RayCounters rays;
    AmbientCounters ambient;
    bool first = true;
    while (const std::optional<SamplePass> pass = picture.next(watch.seconds())) {
        const std::optional<Frame> frame =
            draw({request, *pass, std::exchange(first, false)}, [&](const FrameProgress& made) {
                reporter.update(0, {picture.done(watch.seconds()), rays.total() + made.rays,
                                    ambient.computed + made.ambient_values});
            });
        if (!frame) {
            reporter.finish(false, statistics_.rays.total() - before);
            return std::nullopt;
        }
        rays += frame->rays;
        ambient += frame->ambient;
        picture.add(*pass, *frame);
        reporter.set_error(picture.error());
    }
    if (!picture.reached() && !(options_.goal.seconds > 0))
        warnings_.warn("--error: not reached with " + std::to_string(picture.samples().most) +
                       " rays in a pixel");
    statistics_.sampling = RunStatistics::Sampling{picture.error().value_or(0), picture.samples()};
    Frame made = picture.finish();
    if (has_negative_weights(options.pixels.filter)) cut_off_at_zero(made);
    made.rays = rays;
    made.ambient = ambient;
    reporter.finish(true, statistics_.rays.total() - before);
    return made;
}

std::optional<Frame> RenderBackend::draw_frame(const PictureRequest& request, int workers) {
    const FrameOptions& options = request.options;
    const bool anew = width_ != options.width || height_ != options.height;
    if (anew) frames().begin(options.width, options.height, false, frames_done_);
    width_ = options.width;
    height_ = options.height;
    if (!walk_reporter_) {
        WorkPhase all;
        all.pixels = static_cast<double>(options.whole().pixels() *
                                         std::max(options_.frames, std::size_t{1}));
        all.workers = workers;
        walk_reporter_.emplace(listener(), std::vector{all});
    }
    WalkFrame drawn;
    if (prepare(request, anew))
        drawn = frames().draw(request.camera.view(), options_.reuse->budget, options_.reuse->refine,
                              stop());
    const Frame& frame = drawn.frame;
    statistics_.rays += frame.rays;
    statistics_.ambient += frame.ambient;
    if (frame.complete) {
        statistics_.walk.add(std::move(drawn.report));
        ++frames_done_;
        if (options_.frames > 0)
            walk_reporter_->update(
                0, {static_cast<double>(frames_done_) / static_cast<double>(options_.frames),
                    statistics_.rays.total(), statistics_.ambient.computed});
    }
    // Where it is not known how many frames there will be, each is reported by itself.
    if (!frame.complete || options_.frames == 0 || frames_done_ == options_.frames) {
        walk_reporter_->finish(frame.complete, statistics_.rays.total());
        walk_reporter_.reset();
    }
    if (!frame.complete) return std::nullopt;
    return std::move(drawn.frame);
}

RayListOptions RenderBackend::ray_options() const {
    RayListOptions list = options_.rays;
    list.seed = options_.light.seed;
    return list;
}

RayDemand RenderBackend::demand_of_threads(bool begun) const {
    constexpr std::size_t kRaysAList = 16384;  // that are worth the while of many threads
    // A ray that is watched may be told at length: one at a time.
    const std::size_t rays = options_.observer != nullptr ? 1 : kRaysAList;
    return {begun ? std::size_t{0} : std::size_t{1}, rays, begun};
}

std::string RenderBackend::answer_rays(const RayTask& list, int worker) {
    std::string all;
    trace_rays(session_->tracer(), contexts_[worker], list.rays, list.first, ray_options(),
               [&](std::size_t i, const Ray& ray, const Hit& first) {
                   record(worker, list.rays[i], ray, first, all);
               });
    return all;
}

void RenderBackend::record(int worker, const RayQuery& query, const Ray& ray, const Hit& first,
                           std::string& bytes) const {
    if (tallies_.empty())
        options_.record(query, ray, first, bytes);
    else
        tallies_[static_cast<std::size_t>(worker)]->take(bytes);
}

RunStatistics RenderBackend::statistics() const {
    RunStatistics statistics = statistics_;
    statistics.threads = executor_->concurrency();
    statistics.add_session(*session_);
    return statistics;
}

void append_ray_answer(const Ray& ray, const Hit& first, std::string& bytes) {
    const double numbers[kAnswerNumbers] = {
        static_cast<double>(ray.value.r), static_cast<double>(ray.value.g),
        static_cast<double>(ray.value.b), first.exists() ? first.t : kHuge};
    bytes.append(reinterpret_cast<const char*>(numbers), sizeof numbers);
}

std::vector<RayResult> RayBytes::answers() const {
    if (bytes.size() % kAnswerBytes != 0) throw InputError("these bytes are no answers to rays");
    std::vector<RayResult> answers(bytes.size() / kAnswerBytes);
    for (std::size_t i = 0; i < answers.size(); ++i) {
        double numbers[kAnswerNumbers];
        std::memcpy(numbers, bytes.data() + i * kAnswerBytes, sizeof numbers);
        answers[i] = {{static_cast<float>(numbers[0]), static_cast<float>(numbers[1]),
                       static_cast<float>(numbers[2])},
                      numbers[3]};
    }
    return answers;
}

}  // namespace lightwalk
