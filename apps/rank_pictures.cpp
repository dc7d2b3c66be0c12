#include "apps/rank_pictures.h"

#include <algorithm>

#include "parallel/comm/core_fields.h"
#include "parallel/ranks/piece_codec.h"

namespace lightwalk {
namespace {

/// A renderer and what it refers to.
struct OrderedPicture {
    OrderedPicture(const PictureOrder& order, const FrameOptions& wanted, const Tracer& tracer,
                   WorkerContexts& contexts, const StopFlag& stop)
        : request(order.view, order.previous ? &*order.previous : nullptr, wanted),
          renderer(tracer, request.camera, request.options, contexts, stop) {}
    PictureRequest request;
    BlockRenderer renderer;
};

}  // namespace

template <class Wire>
void visit_fields(Wire& wire, PictureOrder& order) {
    wire(order.view, order.previous, order.width, order.height, order.step, order.deterministic,
         order.indirect);
}

std::string encode_order(const PictureOrder& order) {
    return wire::encode(order);
}

PictureOrder decode_order(const std::string& bytes) {
    return wire::decode<PictureOrder>(bytes);
}

void LeadPictures::order(std::shared_ptr<const PictureRequest> request) {
    const FrameOptions& options = request->options;
    PictureOrder order;
    order.view = request->camera.view();
    if (request->previous) order.previous = request->previous->view();
    order.width = options.width;
    order.height = options.height;
    if (prepass_ == CachePrepass::quick) {
        PictureOrder coarse = order;
        coarse.step = kQuickStep;
        link_.submit(
            {next_++, quick_prepass(options).whole(), 1, false, encode_order(coarse), {}, false});
    }
    order.deterministic = prepass_ == CachePrepass::deterministic;
    const BlockRenderer renderer(tracer_, request->camera, options, contexts_, stop_);
    const JobId job = next_++;
    link_.submit({job, options.area(), renderer.alignment(), true, encode_order(order), {}, false},
                 request->checkpoint);
    ordered_.push_back({job, std::move(request)});
}

std::optional<Frame> LeadPictures::take() {
    const Ordered ordered = std::move(ordered_.front());
    ordered_.pop_front();
    const FrameOptions& options = ordered.request->options;
    WorkPhase phase;
    phase.pixels = static_cast<double>(options.area().pixels());
    ProgressReporter reporter(listener_, {phase});
    const std::optional<FinishedPicture> picture =
        link_.wait_for(ordered.job, stop_, [&](double share) {
            reporter.update(0, {share, 0, 0});
        });
    reporter.finish(picture.has_value(), 0);
    if (!picture) return std::nullopt;
    return assemble(*picture, options.width, options.height);
}

void RankPictures::trace(Executor& executor) {
    link_.trace(
        executor, [&](const PictureJob& job) { return make(job); }, stop_);
}

std::shared_ptr<const BlockRenderer> RankPictures::make(const PictureJob& job) {
    const PictureOrder order = decode_order(job.payload);
    FrameOptions options = options_;
    options.width = order.width;
    options.height = order.height;
    if (order.step > 1) options = quick_prepass(options, order.step);
    const auto picture =
        std::make_shared<OrderedPicture>(order, options, tracer_, contexts_, stop_);
    if (order.deterministic && cache_ != nullptr)
        fill(picture->request.camera, picture->request.options);
    return {picture, &picture->renderer};
}

/// Rank 0 orders no other picture meanwhile, so that no rays of another one are under way.
void RankPictures::fill(const Camera& camera, const FrameOptions& options) {
    // The tracing threads wait meanwhile, and theirs is not to be called from one of its own tasks.
    WorkerContexts contexts(tracer_, warnings_, contexts_.size());
    const auto executor = make_executor(ExecutorKind::threads, contexts.size());
    const CachePrepassResult played = fill_ambient_cache(
        tracer_, camera, options, CachePrepass::deterministic, *cache_, *executor, contexts, stop_,
        [](const FrameProgress&) {}, &link_.workers());
    prepass_rays_ += played.rays;
    prepass_ambient_ += played.ambient;
}

RayCounters RankPictures::rays() const {
    RayCounters sum = prepass_rays_;
    sum += contexts_.rays();
    return sum;
}

AmbientCounters RankPictures::ambient() const {
    AmbientCounters sum = prepass_ambient_;
    sum += contexts_.ambient();
    return sum;
}

Frame assemble(const FinishedPicture& picture, int width, int height) {
    Frame frame;
    frame.width = width;
    frame.height = height;
    const PixelRectangle whole{0, 0, width, height};
    frame.radiance.resize(whole.pixels());
    frame.distance.resize(whole.pixels());
    std::size_t pixels = 0;
    for (const PicturePart& part : picture.parts) {
        const PixelRectangle& block = part.work.block;
        if (block.x0 < 0 || block.y0 < 0 || block.x1 > width || block.y1 > height)
            throw InputError("a part of a picture lies outside it");
        const std::vector<PixelValue> values = decode_piece(block, part.bytes);
        std::size_t from = 0;
        for (int y = block.y0; y < block.y1; ++y) {
            std::size_t to =
                static_cast<std::size_t>(height - 1 - y) * static_cast<std::size_t>(width) +
                static_cast<std::size_t>(block.x0);
            for (int x = block.x0; x < block.x1; ++x, ++from, ++to) {
                frame.radiance[to] = values[from].radiance;
                frame.distance[to] = values[from].distance;
            }
        }
        pixels += values.size();
    }
    if (pixels != whole.pixels()) throw InputError("parts of a picture are missing");
    frame.complete = true;
    return frame;
}

}  // namespace lightwalk
