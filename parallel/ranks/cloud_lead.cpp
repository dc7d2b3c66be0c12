#include "parallel/ranks/cloud_lead.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/cloud/gaps.h"
#include "core/error.h"
#include "parallel/ranks/piece_codec.h"

namespace lightwalk {
namespace {

[[noreturn]] void refuse_parts() {
    throw InputError("the parts of a frame that ranks have sent do not make one");
}

void add_part(const CloudReport& part, CloudReport& all) {
    all.reused += part.reused;
    all.filled += part.filled;
    all.rays += part.rays;
    for (std::size_t i = 0; i < all.uncached.size(); ++i) all.uncached[i] += part.uncached[i];
    for (double CloudReport::*seconds : {&CloudReport::project_seconds, &CloudReport::check_seconds,
                                         &CloudReport::trace_seconds, &CloudReport::keep_seconds})
        all.*seconds = std::max(all.*seconds, part.*seconds);
    all.audit_errors.insert(all.audit_errors.end(), part.audit_errors.begin(),
                            part.audit_errors.end());
    all.audit_floors.insert(all.audit_floors.end(), part.audit_floors.begin(),
                            part.audit_floors.end());
}

}  // namespace

CloudLead::CloudLead(int width, int height, const CloudOptions& options, WalkFrameId first)
    : width_(width),
      height_(height),
      options_(options),
      error_controller_(options.audit_limit),
      frame_(first),
      progressive_(width, height, options.samples) {}

CloudOrder CloudLead::new_order(std::string payload) const {
    CloudOrder order;
    order.width = width_;
    order.height = height_;
    order.rules = {frame_, empty_, error_controller_.tightness(), room_};
    order.payload = std::move(payload);
    order.budget = options_.budget;
    return order;
}

CloudOrder CloudLead::order(const View& view, const View* next, std::string payload) {
    CloudOrder order = new_order(std::move(payload));
    rests_ = progressive_view_ == view;
    rest_follows_ = !rests_ && options_.refine > 0 && next != nullptr && *next == view;
    view_ = view;
    work_ = {};
    if (rests_) {
        const double pixels = static_cast<double>(width_) * static_cast<double>(height_);
        work_ = progressive_.next(static_cast<std::size_t>(std::ceil(options_.refine * pixels)));
    } else {
        progressive_view_.reset();
    }
    order.rests = rests_;
    order.rest_follows = rest_follows_;
    order.leaves = rests_ && work_.sample == 0;
    order.sample = work_.sample;
    order.refined = work_.places;
    return order;
}

CloudFrame CloudLead::take(const FinishedFrame& finished) {
    const std::vector<const CloudPart*> parts = sorted_parts(finished);
    CloudFrame frame;
    const PixelRectangle whole{0, 0, width_, height_};
    frame.radiance.resize(whole.pixels());
    frame.distance.resize(whole.pixels());
    frame.report.pixels = whole.pixels();
    frame.report.tightness = error_controller_.tightness();
    add_up(parts, frame.report);
    if (rests_)
        refine(parts, frame);
    else
        put_together(parts, frame);
    if (!rests_ && options_.refine > 0) {
        radiance_ = frame.radiance;
        distance_ = frame.distance;
    }
    if (rest_follows_) remember(parts, frame.radiance);
    error_controller_.record(frame.report.audit_errors, frame.report.audit_floors);
    ++frame_;
    frame.complete = true;
    return frame;
}

CloudOrder CloudLead::ask_origins(std::string payload) {
    CloudOrder order = new_order(std::move(payload));
    order.rests = order.rest_follows = true;
    return order;
}

void CloudLead::take_origins(const FinishedFrame& finished) {
    const std::vector<const CloudPart*> parts = sorted_parts(finished);
    CloudReport report;
    add_up(parts, report);
    if (radiance_.empty()) refuse_parts();
    remember(parts, radiance_);
    ++frame_;
}

CloudOrder CloudLead::trace(const ProgressiveWork& work, std::string payload) {
    CloudOrder order = new_order(std::move(payload));
    work_ = work;
    order.rests = true;
    order.sample = work.sample;
    order.refined = work.places;
    return order;
}

std::vector<PixelValue> CloudLead::take_traced(const FinishedFrame& finished) {
    const std::vector<const CloudPart*> parts = sorted_parts(finished);
    CloudReport report;
    add_up(parts, report);
    ++frame_;
    return refined_values(parts);
}

/// In an order that does not depend on which came first.
std::vector<const CloudPart*> CloudLead::sorted_parts(const FinishedFrame& finished) const {
    if (finished.frame != frame_) refuse_parts();
    const PixelRectangle whole{0, 0, width_, height_};
    std::vector<const CloudPart*> parts;
    std::size_t pixels = 0;
    for (const CloudPart& part : finished.parts) {
        if (part.area.empty()) continue;
        const bool inside = part.area.x0 >= 0 && part.area.y0 >= 0 && part.area.x1 <= width_ &&
                            part.area.y1 <= height_;
        if (!inside) refuse_parts();
        pixels += part.area.pixels();
        parts.push_back(&part);
    }
    if (pixels != whole.pixels()) refuse_parts();
    std::sort(parts.begin(), parts.end(), [](const CloudPart* a, const CloudPart* b) {
        return std::tie(a->area.y0, a->area.x0) < std::tie(b->area.y0, b->area.x0);
    });
    return parts;
}

void CloudLead::add_up(std::span<const CloudPart* const> parts, CloudReport& report) {
    AgeCounts ages{};
    for (const CloudPart* part : parts) {
        add_part(part->report, report);
        for (std::size_t i = 0; i < ages.size(); ++i) ages[i] += part->ages[i];
    }
    const std::size_t most = options_.most_points(width_, height_);
    room_ = age_limit(ages, most);
    report.points = std::min(most, std::accumulate(ages.begin(), ages.end(), std::size_t{0}));
    empty_ = report.points == 0;
}

/// Pixels that there was no time for are filled from what lies around them.
void CloudLead::put_together(std::span<const CloudPart* const> parts, CloudFrame& frame) const {
    std::vector<std::uint8_t> known(frame.radiance.size(), 1);
    for (const CloudPart* part : parts) {
        const std::vector<PixelValue> values = decode_piece(part->area, part->pixels);
        for_pixels(part->area, [&](std::size_t at, std::size_t i) {
            frame.radiance[at] = values[i].radiance;
            frame.distance[at] = std::max(values[i].distance, 0.0f);
            known[at] = values[i].distance >= 0 ? 1 : 0;
        });
    }
    if (frame.report.filled > 0) fill_gaps(width_, height_, frame.radiance, known);
}

/// For the next frame, which has the same view.
void CloudLead::remember(std::span<const CloudPart* const> parts, std::span<const Rgb> radiance) {
    std::vector<PixelOrigin> origins(radiance.size());
    for (const CloudPart* part : parts) {
        if (part->origins.size() != part->area.pixels()) refuse_parts();
        for_pixels(part->area,
                   [&](std::size_t at, std::size_t i) { origins[at] = part->origins[i]; });
    }
    progressive_.begin(radiance, origins);
    progressive_view_ = view_;
}

/// What the parts have of the work that was ordered, in its order.
std::vector<PixelValue> CloudLead::refined_values(std::span<const CloudPart* const> parts) const {
    std::vector<PixelValue> values;
    values.reserve(work_.places.size());
    std::vector<std::size_t> next(parts.size());  // of the parts' pixels
    for (const PixelPlace& place : work_.places) {
        const auto part = std::find_if(parts.begin(), parts.end(), [&](const CloudPart* one) {
            return one->area.contains(place);
        });
        if (part == parts.end()) refuse_parts();
        std::size_t& at = next[static_cast<std::size_t>(part - parts.begin())];
        if (at >= (*part)->refined.size()) refuse_parts();
        values.push_back((*part)->refined[at++]);
    }
    return values;
}

/// Put what was traced into the picture of a progressive view.
void CloudLead::refine(std::span<const CloudPart* const> parts, CloudFrame& frame) {
    const std::vector<PixelValue> values = refined_values(parts);
    ProgressiveWork done{work_.sample, {}};
    std::vector<Rgb> radiance;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!(values[i].distance >= 0)) continue;  // there was no time
        const PixelPlace& place = work_.places[i];
        done.places.push_back(place);
        radiance.push_back(values[i].radiance);
        if (work_.sample > 0) continue;
        distance_[static_cast<std::size_t>(place.y) * static_cast<std::size_t>(width_) +
                  static_cast<std::size_t>(place.x)] = values[i].distance;
    }
    progressive_.record(done, radiance);
    frame.radiance = progressive_.picture();
    frame.distance = distance_;
    frame.report.uncached[static_cast<std::size_t>(TraceCause::refined)] = radiance.size();
    frame.report.filled = progressive_.guessed_pixels();
    frame.report.reused = frame.report.pixels - frame.report.filled;
}

}  // namespace lightwalk
