#include "parallel/walk/live_walk.h"

#include <algorithm>
#include <utility>

#include "parallel/walk/walk_frame.h"

namespace lightwalk {
namespace {

// Of the pixels, to be chosen for the first step at rest; twice what was traced for each next one.
constexpr double kFirstShare = 0.02, kLeastShare = 0.001;

/// Rows the other way round.
template <class Value>
std::vector<Value> turned(std::span<const Value> rows, int width) {
    std::vector<Value> result;
    result.reserve(rows.size());
    const auto row = static_cast<std::size_t>(width);
    for (std::size_t end = rows.size(); end >= row && row > 0; end -= row) {
        const std::span<const Value> line = rows.subspan(end - row, row);
        result.insert(result.end(), line.begin(), line.end());
    }
    return result;
}

}  // namespace

LiveWalk::LiveWalk(const Tracer& direct, const Tracer* ambient, const CloudOptions& cloud,
                   const FrameOptions& options, Executor& executor, WarningSink& warnings)
    : cloud_(cloud),
      options_(options),
      executor_(executor),
      direct_(std::make_unique<Light>(direct, warnings, executor.concurrency())) {
    if (ambient != nullptr)
        full_ = std::make_unique<Light>(*ambient, warnings, executor.concurrency());
}

/// Points of another light are of no use, nor are those of a picture of another size: what answers
/// a pixel depends on its size.
void LiveWalk::begin(int width, int height, AmbientUse use) {
    options_.width = width;
    options_.height = height;
    use_ = use;
    walking_ = use == AmbientUse::always && full_ ? full_.get() : direct_.get();
    frames_ = std::make_unique<CloudFrames>(width, height, cloud_);
    view_.reset();
}

LivePicture LiveWalk::next(const View& view, int width, int height, AmbientUse use, double budget,
                           const StopFlag& stop) {
    if (!frames_ || options_.width != width || options_.height != height || use_ != use)
        begin(width, height, use);
    frames_->set_budget(budget);
    const bool rests = view_ == view;
    if (!rests) {
        resting_.reset();
        frames_->set_refine(kFirstShare);
        view_ = view;
        LivePicture drawn = draw(view, false, stop);
        if (drawn.radiance.empty()) view_.reset();
        return drawn;
    }
    if (resting_) return add_light(budget, stop);
    const RestingPicture* picture = frames_->resting();
    if (adds_light() && picture != nullptr && picture->open_pixels() == 0) {
        resting_ = std::make_unique<RestingLight>(full_->tracer, view, options_, full_->contexts,
                                                  cloud_.samples);
        resting_->begin(turned(std::span<const Rgb>(last_.radiance), width),
                        turned(std::span<const float>(last_.distance), width));
        return add_light(budget, stop);
    }
    if (picture == nullptr || picture->next(1).places.empty()) return unchanged();
    return draw(view, true, stop);
}

LivePicture LiveWalk::draw(const View& view, bool rests, const StopFlag& stop) {
    const Camera camera(view);
    WalkFrame drawn = draw_walk_frame(*frames_, walking_->tracer, walking_->sights, camera,
                                      options_, executor_, walking_->contexts, stop);
    LivePicture picture;
    if (!drawn.frame.complete) return picture;
    picture.width = options_.width;
    picture.height = options_.height;
    picture.radiance = std::move(drawn.frame.radiance);
    picture.distance = std::move(drawn.frame.distance);
    picture.rays = drawn.frame.rays;
    picture.report = std::move(drawn.report);
    if (rests) {
        const auto traced =
            static_cast<double>(picture.report.holes[static_cast<std::size_t>(HoleCause::refined)]);
        frames_->set_refine(std::clamp(2 * traced / static_cast<double>(picture.radiance.size()),
                                       kLeastShare, 1.0));
    }
    const RestingPicture* resting = frames_->resting();
    const std::size_t open = resting != nullptr ? resting->open_pixels() : 0;
    picture.share = 1 - static_cast<double>(open) / static_cast<double>(picture.radiance.size());
    picture.phase = !rests     ? LivePhase::moving
                    : open > 0 ? LivePhase::filling
                               : LivePhase::refining;
    last_ = picture;
    return picture;
}

LivePicture LiveWalk::add_light(double budget, const StopFlag& stop) {
    full_->contexts.reset_counters();
    const bool worked = resting_->step(deadline_of(budget), executor_, stop);
    LivePicture picture;
    picture.width = options_.width;
    picture.height = options_.height;
    picture.share = resting_->share();
    picture.phase = !worked             ? LivePhase::done
                    : picture.share < 1 ? LivePhase::ambient
                                        : LivePhase::refining;
    Frame frame;
    frame.width = picture.width;
    frame.height = picture.height;
    frame.radiance = turned(std::span<const Rgb>(resting_->picture()), picture.width);
    frame.distance = turned(resting_->distance(), picture.width);
    draw_small_sources(full_->tracer, Camera(*view_), options_, executor_, full_->contexts, frame);
    picture.radiance = std::move(frame.radiance);
    picture.distance = std::move(frame.distance);
    picture.rays = full_->contexts.rays();
    picture.report = last_.report;
    return picture;
}

LivePicture LiveWalk::unchanged() const {
    LivePicture picture = last_;
    picture.phase = LivePhase::done;
    picture.share = 1;
    picture.rays = {};
    return picture;
}

}  // namespace lightwalk
