#include "parallel/walk/draft_light.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/ambient/ambient_point.h"
#include "core/cloud/gaps.h"
#include "core/math/distance.h"
#include "parallel/executor_task_runner.h"
#include "parallel/walk/live_frames.h"
#include "parallel/walk/scene_caster.h"
#include "parallel/walk/uncached_pixel_tracer.h"

namespace lightwalk {
namespace {

constexpr int kFillSpacing = 8, kMendSpacing = 4;  // of the pixels whose values are computed
constexpr int kCoarse = 2;                         // of those that are looked at first
constexpr std::size_t kPixelsADraftTask = 64;

bool is_coarse(const PixelPlace& place) {
    return place.x % kCoarse == 0 && place.y % kCoarse == 0;
}

/// @param added     to a pixel's light, in place of the constant's
/// @param constant  what this adds to the light that is there
float with_light(float light, float added, float constant) {
    const float sum = light + added;
    return added < 0 && constant > 0 ? std::max(sum, light * (1 + added / constant)) : sum;
}

/// For its lifetime rays use ambient values that are known, and note where one is missing.
class OnlyKnownValues {
  public:
    explicit OnlyKnownValues(TraceContext& context) : context_(context) {
        context.ambient.missing = &missing_;
    }
    ~OnlyKnownValues() { context_.ambient.missing = nullptr; }
    OnlyKnownValues(const OnlyKnownValues&) = delete;
    OnlyKnownValues& operator=(const OnlyKnownValues&) = delete;
    void begin_ray() {
        missing_.points.clear();
        missing_.left_out = false;
    }
    [[nodiscard]] bool lacked_some() const { return !missing_.points.empty() || missing_.left_out; }

  private:
    TraceContext& context_;
    MissingAmbient missing_;
};

}  // namespace

DraftLight::DraftLight(const Tracer& indirect, const Tracer& direct,
                       const std::shared_ptr<const LightGroups>& groups, int workers)
    : indirect_(indirect),
      direct_(direct),
      contexts_(indirect_, silence_, workers),
      direct_contexts_(direct_, silence_, workers),
      group_count_(groups ? groups->size() : 0) {
    if (!groups) return;
    contexts_.sum_by(groups);
    direct_contexts_.sum_by(groups);
}

bool DraftLight::aim(const View& view, const FrameOptions& options) {
    if (view_ == view && options_.width == options.width && options_.height == options.height)
        return false;
    view_ = view;
    options_ = options;
    const std::size_t pixels = options_.whole().pixels();
    known_.assign(pixels, 0);
    added_.assign(pixels, {});
    constant_.assign(group_count_ == 0 ? pixels : 0, {});
    groups_.assign(pixels * group_count_, {});
    stage_ = Stage::filling;
    to_fill_.places.clear();
    for (int y = 0; y < options_.height; y += kFillSpacing)
        for (int x = 0; x < options_.width; x += kFillSpacing) to_fill_.places.push_back({x, y});
    std::stable_sort(
        to_fill_.places.begin(), to_fill_.places.end(),
        [](const PixelPlace& a, const PixelPlace& b) { return grid_level(a) < grid_level(b); });
    to_look_.clear();
    for (std::size_t i = 0; i < pixels; ++i)
        if (is_coarse(place_of(i))) to_look_.push_back(static_cast<std::uint32_t>(i));
    return true;
}

void DraftLight::step(double seconds, Executor& executor, const StopFlag& stop) {
    const Clock::time_point deadline = FrameClock().in(seconds);
    contexts_.reset_counters();
    direct_contexts_.reset_counters();
    while (stage_ != Stage::whole && !stop.requested()) {
        const double left = std::chrono::duration<double>(deadline - Clock::now()).count();
        if (!fill(left, executor, stop) || !look(deadline, executor, stop)) break;
        next_stage(executor);
        if (stage_ == Stage::sharpening) break;
    }
    rays_ = contexts_.rays().total() + direct_contexts_.rays().total();
}

/// What was to be done is done.
void DraftLight::next_stage(Executor& executor) {
    switch (stage_) {
        case Stage::filling:
            stage_ = Stage::sharpening;
            guess_rest(executor);
            return choose_unknown(false);
        case Stage::sharpening:
            stage_ = Stage::mending;
            return choose_unknown(true);
        default:
            stage_ = Stage::whole;
            guess_rest(executor);
    }
}

/// Look at the pixels that are not known.
/// @param fill  after some of them have got the values that they lack
void DraftLight::choose_unknown(bool fill) {
    for (std::size_t i = 0; i < known_.size(); ++i) {
        if (known_[i] != 0) continue;
        to_look_.push_back(static_cast<std::uint32_t>(i));
        const PixelPlace place = place_of(i);
        if (fill && place.x % kMendSpacing == 0 && place.y % kMendSpacing == 0)
            to_fill_.places.push_back(place);
    }
}

/// Compute the values that the chosen pixels lack. False: there was no time for all.
bool DraftLight::fill(double seconds, Executor& executor, const StopFlag& stop) {
    if (to_fill_.places.empty()) return true;
    const TracedValues traced = trace_pixels(indirect_, contexts_, Camera(*view_), options_,
                                             to_fill_, seconds, executor, stop);
    std::vector<PixelPlace> left;
    for (std::size_t i = 0; i < traced.values.size(); ++i)
        if (!traced.values[i]) left.push_back(to_fill_.places[i]);
    to_fill_.places = std::move(left);
    return to_fill_.places.empty();
}

/// What the light with the draft's values is more than that without, along some rays.
class DraftLight::Difference {
  public:
    Difference(DraftLight& draft, int worker)
        : draft_(draft),
          camera_(*draft.view_),
          rays_(rays_of_sample(camera_, draft.options_, 0)),
          with_(draft.contexts_[worker]),
          without_(draft.direct_contexts_[worker]) {}

    void look_at(std::span<const std::uint32_t> pixels) {
        const Geometry& geometry = draft_.indirect_.scene().geometry();
        segments_.clear();
        numbers_.clear();
        pixels_.clear();
        for (const std::uint32_t number : pixels) {
            const PixelPlace place = draft_.place_of(number);
            const PixelRay pixel = rays_(place.x, place.y);
            draft_.known_[number] = 1;
            if (!pixel.ray) continue;
            segments_.push_back(
                {pixel.ray->origin, pixel.ray->direction, farthest_hit(pixel.ray->limit)});
            pixels_.push_back(pixel);
            numbers_.push_back(number);
        }
        hits_.resize(segments_.size());
        geometry.intersect(segments_, hits_);
        OnlyKnownValues known(with_), none(without_);
        for (std::size_t i = 0; i < numbers_.size(); ++i) {
            known.begin_ray();
            none.begin_ray();
            const std::size_t at = numbers_[i], groups = draft_.group_count_;
            parts_.assign(groups, {});
            const Rgb all = shade(draft_.indirect_, i, with_, parts_, 1);
            const Rgb constant = shade(draft_.direct_, i, without_, parts_, -1);
            draft_.known_[at] = known.lacked_some() ? 0 : 1;
            if (known.lacked_some()) continue;  // what is guessed is nearer
            draft_.added_[at] = groups > 0 ? draft_.mixture_.sum(parts_) : all - constant;
            if (groups == 0) draft_.constant_[at] = constant;
            std::ranges::copy(parts_,
                              draft_.groups_.begin() + static_cast<std::ptrdiff_t>(at * groups));
        }
    }

  private:
    /// @param sign  of what is added to `parts`
    Rgb shade(const Tracer& tracer, std::size_t i, TraceContext& context, std::span<Rgb> parts,
              float sign) {
        const Camera::ViewRay& view_ray = *pixels_[i].ray;
        Ray ray;
        tracer.start_primary(ray, view_ray.origin, view_ray.direction, view_ray.limit,
                             pixels_[i].random);
        if (!context.groups) {
            tracer.shade_hits({&ray, 1}, {&hits_[i], 1}, context);
            return ray.value;
        }
        tracer.shade_hits({&ray, 1}, {&hits_[i], 1}, context, [&](std::size_t) {
            const std::span<const Rgb> sums = context.groups->sums();
            for (std::size_t g = 0; g < parts.size(); ++g) parts[g] += sign * sums[g];
        });
        return ray.value;
    }

    DraftLight& draft_;
    Camera camera_;
    PixelRays rays_;
    TraceContext &with_, &without_;
    std::vector<RaySegment> segments_;
    std::vector<Hit> hits_;
    std::vector<PixelRay> pixels_;
    std::vector<std::size_t> numbers_;
    std::vector<Rgb> parts_;
};

/// Interpolate the light of the pixels that are left. False: there was no time for all.
bool DraftLight::look(Clock::time_point deadline, Executor& executor, const StopFlag& stop) {
    const std::size_t tasks = (to_look_.size() + kPixelsADraftTask - 1) / kPixelsADraftTask;
    std::vector<std::uint8_t> done(tasks);
    executor.for_each(
        tasks,
        [&](std::size_t task, int worker) {
            if (task > 0 && Clock::now() > deadline) return;
            const std::size_t first = task * kPixelsADraftTask;
            const std::size_t count = std::min(kPixelsADraftTask, to_look_.size() - first);
            Difference(*this, worker).look_at(std::span(to_look_).subspan(first, count));
            done[task] = 1;
        },
        stop);
    std::vector<std::uint32_t> left;
    for (std::size_t task = 0; task < tasks; ++task) {
        if (done[task] != 0) continue;
        const auto first = to_look_.begin() + static_cast<std::ptrdiff_t>(task * kPixelsADraftTask);
        const auto size = static_cast<std::ptrdiff_t>(
            std::min(kPixelsADraftTask, to_look_.size() - task * kPixelsADraftTask));
        left.insert(left.end(), first, first + size);
    }
    to_look_ = std::move(left);
    return to_look_.empty();
}

/// The pixels that are not known, from what is around them.
void DraftLight::guess_rest(Executor& executor) {
    if (std::ranges::find(known_, std::uint8_t{0}) == known_.end()) return mix(mixture_);
    const ExecutorTaskRunner task_runner(executor);
    fill_gaps(options_.width, options_.height, added_, known_, task_runner);
    if (group_count_ == 0)
        fill_gaps(options_.width, options_.height, constant_, known_, task_runner);
    std::vector<Rgb> of_group(group_count_ > 0 ? added_.size() : 0);
    for (std::size_t g = 0; g < group_count_; ++g) {
        for (std::size_t i = 0; i < of_group.size(); ++i)
            of_group[i] = groups_[i * group_count_ + g];
        fill_gaps(options_.width, options_.height, of_group, known_, task_runner);
        for (std::size_t i = 0; i < of_group.size(); ++i)
            groups_[i * group_count_ + g] = of_group[i];
    }
    mix(mixture_);
}

void DraftLight::add_to(std::span<Rgb> radiance) const {
    const auto width = static_cast<std::size_t>(options_.width);
    for (std::size_t i = 0; i < added_.size(); ++i) {
        const std::size_t row = added_.size() / width - 1 - i / width;
        Rgb& pixel = radiance[row * width + i % width];
        if (constant_.empty()) {
            pixel += added_[i];
            continue;
        }
        const Rgb &more = added_[i], &constant = constant_[i];
        pixel = {with_light(pixel.r, more.r, constant.r), with_light(pixel.g, more.g, constant.g),
                 with_light(pixel.b, more.b, constant.b)};
    }
}

void DraftLight::mix(const LightMixture& mixture) {
    mixture_ = mixture;
    if (group_count_ == 0 || !usable()) return;
    for (std::size_t i = 0; i < added_.size(); ++i)
        added_[i] = mixture_.sum(std::span(groups_).subspan(i * group_count_, group_count_));
}

}  // namespace lightwalk
