#include "apps/walk/walk_glare.h"

#include <algorithm>

#include "core/glare/glare.h"
#include "core/glare/outline.h"
#include "core/math/corrected_sum.h"
#include "core/trace/light_sampler.h"
#include "parallel/walk/live_frames.h"
#include "parallel/walk/scene_caster.h"

namespace lightwalk {
namespace {

// Of the picture: a pixel is less than half of the sun, which would else be hit or missed by
// chance.
constexpr int kFieldSide = 800;
constexpr std::uint32_t kOfGlare = 5;  // random numbers, apart from those of other questions
constexpr double kToldEach = 0.1;      // of the work

/// All that lies before the eye.
View field_of(const View& view) {
    View field;
    field.type = 'a';
    field.position = view.position;
    field.direction = view.direction;
    field.up = view.up;
    field.horizontal = field.vertical = 180;
    return field;
}

FrameOptions picture_options() {
    FrameOptions options;
    options.width = options.height = kFieldSide;
    options.pixels.spacing = 1;
    return options;
}

}  // namespace

void WalkGlare::ask(ClientId client, const GlareRequest& request, const View& view) {
    asked_.push_back({client, request.id});
    if (picture_ && view_ == view) return;
    view_ = view;
    begin();
}

void WalkGlare::begin() {
    told_ = 0;
    picture_.emplace(kFieldSide, kFieldSide, 1);
    constexpr std::size_t kPixels = std::size_t{kFieldSide} * kFieldSide;
    const LightGroups* groups = contexts_.light_groups();
    picture_->begin(std::vector<Rgb>(kPixels), std::vector<float>(kPixels),
                    std::vector<Rgb>(groups != nullptr ? kPixels * groups->size() : 0));
}

void WalkGlare::change(const Tracer& tracer, WarningSink& warnings,
                       const std::shared_ptr<const LightGroups>& groups) {
    tracer_ = &tracer;
    contexts_ = WorkerContexts(tracer, warnings, executor_.concurrency());
    groups_ = groups;
    contexts_.sum_by(groups);
    picture_.reset();
    if (is_asked()) begin();
}

void WalkGlare::mix(const LightMixture& mixture) {
    mixture_ = mixture;
    if (picture_) picture_->mix(mixture);
}

void WalkGlare::forget(ClientInbox& client_inbox) {
    for (const Asked& asked : asked_)
        client_inbox.tell(asked.client, walk_text(RefusedReply{"the view has moved", asked.id}));
    asked_.clear();
    picture_.reset();
}

void WalkGlare::step(double budget, const StopFlag& stop, ClientInbox& client_inbox) {
    const Camera field(field_of(view_));
    const auto trace = [&](const ProgressiveWork& work) {
        return trace_pixels(*tracer_, contexts_, field, picture_options(), work, budget, executor_,
                            stop, mixture_);
    };
    if (picture_->step(trace)) {
        if (picture_->share() < told_ + kToldEach) return;
        told_ = picture_->share();
        GlareReply reply;
        reply.done = std::min(told_, 1 - kToldEach / 2);  // 1 comes with the answer
        tell(reply, client_inbox);
        return;
    }
    tell(evaluate(), client_inbox);
    asked_.clear();
}

void WalkGlare::tell(GlareReply reply, ClientInbox& client_inbox) const {
    for (const Asked& asked : asked_) {
        reply.id = asked.id;
        client_inbox.tell(asked.client, walk_text(reply));
    }
}

/// The picture's pixels, weighted by what they are to the probability, in place of the probability
/// itself: it is as good as straight over what they are off by.
MeanInterval WalkGlare::probability(std::span<const Rgb> radiance, double dgp) const {
    const std::vector<GlareShare> shares =
        glare_shares({kFieldSide, kFieldSide, radiance}, field_of(view_));
    std::vector<KnownTerm> terms;
    terms.reserve(shares.size());
    double sum = 0;
    for (const GlareShare& share : shares) {
        terms.push_back({share.slope, share.luminance});
        sum += share.slope * share.luminance;
    }
    LightSampler sampler(*tracer_, warnings_, groups_);
    sampler.mix(mixture_);
    const Camera field(field_of(view_));
    const PixelRays rays = rays_of_sample(field, picture_options(), 0);
    std::uint32_t count = 0;
    // Where the picture has looked: what a pixel shows besides is not what chance has made of it.
    const auto sample = [&](std::size_t term) {
        const PixelPlace& pixel = shares[term].place;
        const std::optional<Camera::ViewRay> ray = rays(pixel.x, pixel.y).ray;
        return ray ? sampler.shown(sampler.radiance(ray->origin, ray->direction, ray->limit,
                                                    sampler.random(kOfGlare, count++)))
                   : shares[term].luminance;
    };
    MeanInterval interval = corrected_sum(terms, sampler.random(kOfGlare, ~0u), sample);
    interval.mean = std::clamp(dgp + (interval.mean - sum), 0.0, 1.0);
    return interval;
}

GlareReply WalkGlare::evaluate() const {
    const std::vector<Rgb> radiance =
        turned_rows(std::span<const Rgb>(picture_->picture()), kFieldSide);
    const GlareReport report = analyse_glare({kFieldSide, kFieldSide, radiance}, field_of(view_));
    const Camera camera(view_);
    GlareReply reply;
    reply.done = 1;
    reply.dgp = probability(radiance, report.dgp);
    for (const GlareSource& source : report.sources) {
        GlareOutline outline;
        outline.luminance = source.luminance;
        outline.solid_angle = source.solid_angle;
        outline.position_index = source.position_index;
        for (const OutlinePoint& point : project_outline(source.outline, camera))
            outline.outline.emplace_back(point.h, point.v);
        reply.sources.push_back(std::move(outline));
    }
    return reply;
}

}  // namespace lightwalk
