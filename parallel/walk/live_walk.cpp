#include "parallel/walk/live_walk.h"

#include <algorithm>
#include <utility>

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

void LiveWalk::begin(int width, int height, AmbientUse use) {
    width_ = width;
    height_ = height;
    use_ = use;
    frames_.begin(width, height, use == AmbientUse::always && frames_.has_indirect());
    view_.reset();
}

LivePicture LiveWalk::next(const View& view, int width, int height, AmbientUse use, double budget,
                           const StopFlag& stop) {
    if (width_ != width || height_ != height || use_ != use) begin(width, height, use);
    const bool rests = view_ == view;
    if (!rests) {
        resting_.reset();
        refine_ = kFirstShare;
        view_ = view;
        LivePicture drawn = draw(view, false, budget, stop);
        if (drawn.radiance.empty()) view_.reset();
        return drawn;
    }
    if (resting_) return add_light(budget, stop);
    const RestingPicture* picture = frames_.resting(stop);
    if (stop.requested()) return {};
    const bool adds_light = use_ == AmbientUse::rest && frames_.has_indirect();
    if (adds_light && picture != nullptr && picture->open_pixels() == 0) {
        resting_ = std::make_unique<RestingLight>(width, height, samples_);
        resting_->begin(turned(std::span<const Rgb>(last_.radiance), width),
                        turned(std::span<const float>(last_.distance), width));
        return add_light(budget, stop);
    }
    if (picture == nullptr || picture->next(1).places.empty()) return unchanged();
    return draw(view, true, budget, stop);
}

LivePicture LiveWalk::draw(const View& view, bool rests, double budget, const StopFlag& stop) {
    WalkFrame drawn = frames_.draw(view, budget, refine_, stop);
    LivePicture picture;
    if (!drawn.frame.complete) return picture;
    picture.width = width_;
    picture.height = height_;
    picture.radiance = std::move(drawn.frame.radiance);
    picture.distance = std::move(drawn.frame.distance);
    picture.rays = frames_.rays();
    picture.report = std::move(drawn.report);
    if (rests) {
        const auto pixels = static_cast<double>(picture.radiance.size());
        const auto traced =
            static_cast<double>(picture.report.holes[static_cast<std::size_t>(HoleCause::refined)]);
        refine_ = std::clamp(2 * traced / pixels, kLeastShare, 1.0);
        const RestingPicture* resting = frames_.resting(stop);
        const std::size_t open = resting != nullptr ? resting->open_pixels() : 0;
        picture.share = 1 - static_cast<double>(open) / pixels;
        picture.phase = open > 0 ? LivePhase::filling : LivePhase::refining;
    }
    last_ = picture;
    return picture;
}

LivePicture LiveWalk::add_light(double budget, const StopFlag& stop) {
    const bool worked = resting_->step(
        [&](const RestingWork& work) { return frames_.trace(*view_, work, budget, stop); });
    LivePicture picture;
    picture.width = width_;
    picture.height = height_;
    picture.share = resting_->share();
    picture.phase = !worked             ? LivePhase::done
                    : picture.share < 1 ? LivePhase::ambient
                                        : LivePhase::refining;
    Frame frame;
    frame.width = picture.width;
    frame.height = picture.height;
    frame.radiance = turned(std::span<const Rgb>(resting_->picture()), picture.width);
    frame.distance = turned(resting_->distance(), picture.width);
    frames_.add_small_sources(*view_, frame);
    picture.radiance = std::move(frame.radiance);
    picture.distance = std::move(frame.distance);
    picture.rays = worked ? frames_.rays() : 0;
    picture.report = last_.report;
    return picture;
}

LivePicture LiveWalk::unchanged() const {
    LivePicture picture = last_;
    picture.phase = LivePhase::done;
    picture.share = 1;
    picture.rays = 0;
    return picture;
}

}  // namespace lightwalk
