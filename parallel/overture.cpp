#include "parallel/overture.h"

#include <algorithm>
#include <vector>

namespace lightwalk {
namespace {

/// Every how many pixels, in either direction, one is traced: picture by picture.
std::vector<int> steps_of(Overture overture) {
    switch (overture) {
        case Overture::none:
            break;
        case Overture::quick:
            return {kQuickStep};
        case Overture::deterministic:
            return {16, 8, 4, 2};
    }
    return {};
}

/// `window` of a picture in pixels of one whose step is `step`: all that it touches.
PixelRectangle coarser(const PixelRectangle& window, int step) {
    return {window.x0 / step, window.y0 / step, (window.x1 + step - 1) / step,
            (window.y1 + step - 1) / step};
}

FrameOptions coarse_options(const FrameOptions& options, Overture overture, int step) {
    FrameOptions coarse = options;
    coarse.step = step;
    coarse.pixels.spacing = 1;
    coarse.pixels.samples = 1;
    coarse.previous = nullptr;
    coarse.hits = false;
    coarse.window.reset();
    if (options.window && overture != Overture::deterministic)
        coarse.window = coarser(*options.window, step);
    return coarse;
}

}  // namespace

FrameOptions quick_overture(const FrameOptions& options, int step) {
    return coarse_options(options, Overture::quick, step);
}

std::size_t overture_pixels(const FrameOptions& options, Overture overture) {
    std::size_t pixels = 0;
    for (const int step : steps_of(overture))
        pixels += coarse_options(options, overture, step).area().pixels();
    return pixels;
}

OvertureResult fill_ambient_cache(const Tracer& tracer, const Camera& camera,
                                  const FrameOptions& options, Overture overture,
                                  FreezableCache& cache, Executor& executor,
                                  WorkerContexts& contexts, const StopFlag& stop,
                                  TakeProgress progress) {
    const std::unique_ptr<Executor> one = make_executor(ExecutorKind::serial, 1);
    Executor& workers = overture == Overture::deterministic ? *one : executor;
    const auto all_pixels = static_cast<double>(overture_pixels(options, overture));
    double pixels_before = 0;
    OvertureResult result;
    cache.freeze(false);
    for (const int step : steps_of(overture)) {
        const FrameOptions coarse = coarse_options(options, overture, step);
        const auto pixels = static_cast<double>(coarse.area().pixels());
        const auto tell = [&](const FrameProgress& now) {
            progress({std::min(1.0, (pixels_before + now.done * pixels) / all_pixels),
                      result.rays.total() + now.rays,
                      result.ambient.computed + now.ambient_values});
        };
        const Frame frame = render_frame(tracer, camera, coarse, workers, contexts, stop, tell);
        result.rays += frame.rays;
        result.ambient += frame.ambient;
        if (!frame.complete) return result;
        pixels_before += pixels;
    }
    cache.freeze(overture == Overture::deterministic);
    result.complete = true;
    return result;
}

}  // namespace lightwalk
