#include "parallel/walk/live_walk.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace lightwalk {
namespace {

// Of the pixels, to be chosen for the first step at rest; twice as many for each next one, as far
// as there is time to trace them.
constexpr double kFirstShare = 0.02, kLeastShare = 0.001;

/// Light is nowhere less than none.
void add_all(std::span<const Rgb> more, std::vector<Rgb>& pixels) {
    std::ranges::transform(pixels, more, pixels.begin(), [](const Rgb& a, const Rgb& b) {
        return Rgb{std::max(a.r + b.r, 0.0f), std::max(a.g + b.g, 0.0f), std::max(a.b + b.b, 0.0f)};
    });
}

}  // namespace

void LiveWalk::begin(int width, int height, WalkAmbient use) {
    width_ = width;
    height_ = height;
    use_ = use;
    around_ = {};
    frames_.begin(width, height, use == WalkAmbient::always && frames_.has_indirect());
    view_.reset();
}

void LiveWalk::resize(int width, int height) {
    width_ = width;
    height_ = height;
    frames_.resize(width, height);
    view_.reset();
}

void LiveWalk::look_anew() {
    if (view_) frames_.forget_view();
    view_.reset();
    draft_ = nullptr;
}

bool LiveWalk::next(const View& view, int width, int height, WalkAmbient use, double budget,
                    const StopFlag& stop) {
    if (width_ == 0 || use_ != use)
        begin(width, height, use);
    else if (width_ != width || height_ != height)
        resize(width, height);
    picture_.is_new = true;
    if (view_ != view) {
        progressive_.reset();
        draft_ = nullptr;
        drafting_ = use == WalkAmbient::rest && frames_.has_indirect();
        refine_ = kFirstShare;
        view_ = view;
        if (draw(view, false, budget, stop)) return true;
        view_.reset();
        return false;
    }
    if (picture_.phase == WalkPhase::done && looks_around_)
        if (const std::optional<ViewAside> aside = around_.next(1, true))
            return look_aside(*aside, budget, stop);
    if (progressive_) return add_light(budget, stop);
    const ProgressivePicture* picture = frames_.progressive(stop);
    if (stop.requested()) return false;
    const bool adds_light = use_ == WalkAmbient::rest && frames_.has_indirect();
    if (drafting_) return draft_light(budget, stop);
    if (picture != nullptr && looks_around_)
        if (const std::optional<ViewAside> aside = next_aside(*picture, adds_light))
            return look_aside(*aside, budget, stop);
    if (adds_light && picture != nullptr && picture->open_pixels() == 0) {
        begin_light(*picture);
        return add_light(budget, stop);
    }
    if (picture != nullptr && !picture->finished()) return draw(view, true, budget, stop);
    picture_.phase = WalkPhase::done;
    picture_.share = 1;
    picture_.rays = 0;
    return true;
}

bool LiveWalk::draw(const View& view, bool rests, double budget, const StopFlag& stop) {
    const auto begin = std::chrono::steady_clock::now();
    WalkFrame drawn = frames_.draw(view, budget, refine_, stop);
    if (!drawn.frame.complete) return false;
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    picture_.width = width_;
    picture_.height = height_;
    picture_.radiance = std::move(drawn.frame.radiance);
    picture_.distance = std::move(drawn.frame.distance);
    picture_.rays = frames_.rays();
    picture_.report = std::move(drawn.report);
    picture_.phase = WalkPhase::moving;
    picture_.share = picture_.inferred = 0;
    undrafted_ = picture_.radiance;
    if (!rests) return true;
    const auto pixels = static_cast<double>(picture_.radiance.size());
    const auto traced = static_cast<double>(
        picture_.report.uncached[static_cast<std::size_t>(TraceCause::refined)]);
    // Few may have been traced only because no more were to be, as edges at the end.
    const double share = took.count() < budget ? 2 * refine_ : 2 * traced / pixels;
    refine_ = std::clamp(share, kLeastShare, 1.0);
    const ProgressivePicture* progressive = frames_.progressive(stop);
    const std::size_t open = progressive != nullptr ? progressive->open_pixels() : 0;
    picture_.share = 1 - static_cast<double>(open) / pixels;
    const bool light_follows = use_ == WalkAmbient::rest && frames_.has_indirect();
    picture_.phase = open > 0 || light_follows ? WalkPhase::filling : WalkPhase::refining;
    add_draft();
    return true;
}

std::optional<ViewAside> LiveWalk::next_aside(const ProgressivePicture& picture, bool adds_light) {
    if (!around_.hold(*view_)) around_ = ViewsAround(*view_);
    if (!around_.next(1, true)) return std::nullopt;  // before pixels are counted
    const auto pixels = static_cast<double>(picture.radiance().size());
    const std::size_t open = picture.open_pixels();
    return around_.next(1 - static_cast<double>(open) / pixels, open == 0 && !adds_light);
}

/// The picture stays as it is.
bool LiveWalk::look_aside(const ViewAside& aside, double budget, const StopFlag& stop) {
    const auto begin = std::chrono::steady_clock::now();
    const auto of = [&](int side) {
        return std::max(static_cast<int>(std::lround(aside.share * side)), 1);
    };
    const std::optional<double> unknown =
        frames_.look_aside(aside.view, of(width_), of(height_), budget, stop);
    if (!unknown) return false;
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    around_.record(*unknown, took.count());
    picture_.rays = frames_.rays();
    picture_.is_new = false;
    return true;
}

/// Before the pixels are traced: indirect light is most of what is missing.
bool LiveWalk::draft_light(double budget, const StopFlag& stop) {
    const ViewDraft made = frames_.draft(*view_, budget, stop);
    if (stop.requested()) return false;
    draft_ = made.best;
    drafting_ = !made.last;
    picture_.rays = frames_.rays();
    picture_.phase = WalkPhase::filling;
    picture_.share = 0;
    add_draft();
    return true;
}

/// To a picture without indirect light.
void LiveWalk::add_draft() {
    picture_.inferred = draft_ != nullptr ? 1 : 0;
    if (draft_ == nullptr) return;
    picture_.radiance = undrafted_;
    draft_->add_to(picture_.radiance);
}

/// What is traced from here on takes the place of the draft.
void LiveWalk::begin_light(const ProgressivePicture& direct) {
    progressive_ = std::make_unique<ProgressiveLight>(width_, height_, samples_);
    const bool drafted = draft_ != nullptr;
    if (!direct.knows_groups())
        return progressive_->begin(turned_rows(std::span<const Rgb>(picture_.radiance), width_),
                                   turned_rows(std::span<const float>(picture_.distance), width_),
                                   {}, drafted);
    std::vector<Rgb> radiance(direct.radiance().begin(), direct.radiance().end());
    std::vector<Rgb> groups(direct.groups().begin(), direct.groups().end());
    if (drafted) {
        add_all(draft_->added(), radiance);
        add_all(draft_->groups(), groups);
    }
    progressive_->begin(radiance, direct.distance(), groups, drafted);
}

/// Rows from the bottom, without small light sources.
void LiveWalk::take(std::span<const Rgb> radiance, std::span<const float> distance, bool indirect) {
    Frame frame;
    frame.width = width_;
    frame.height = height_;
    frame.radiance = turned_rows(radiance, width_);
    frame.distance = turned_rows(distance, width_);
    frames_.add_small_sources(*view_, frame, indirect);
    picture_.radiance = std::move(frame.radiance);
    picture_.distance = std::move(frame.distance);
}

bool LiveWalk::mix(const LightMixture& mixture) {
    const ProgressivePicture* direct = frames_.mix(mixture);
    if (progressive_ && view_) {
        progressive_->mix(mixture);
        take(progressive_->picture(), progressive_->distance(), true);
        picture_.phase = std::min(picture_.phase, WalkPhase::refining);
        return true;
    }
    if (direct == nullptr || !view_) {
        view_.reset();
        return false;
    }
    take(direct->radiance(), direct->distance(), false);
    undrafted_ = picture_.radiance;
    add_draft();
    picture_.phase = std::min(picture_.phase, WalkPhase::refining);
    return true;
}

bool LiveWalk::add_light(double budget, const StopFlag& stop) {
    const bool worked = progressive_->step(
        [&](const ProgressiveWork& work) { return frames_.trace(*view_, work, budget, stop); });
    take(progressive_->picture(), progressive_->distance(), true);
    picture_.rays = worked ? frames_.rays() : 0;
    picture_.share = progressive_->share();
    picture_.inferred = draft_ != nullptr && worked ? 1 - picture_.share : 0;
    picture_.phase = !worked              ? WalkPhase::done
                     : picture_.share < 1 ? WalkPhase::ambient
                                          : WalkPhase::refining;
    return true;
}

}  // namespace lightwalk
