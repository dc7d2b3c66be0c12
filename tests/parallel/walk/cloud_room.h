#pragma once
// A room to walk in, and what its frames should be.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "parallel/walk/cloud_frames.h"
#include "parallel/walk/scene_caster.h"
#include "tests/test_scene.h"

namespace lightwalk::test::cloud_room {

/// A room with a mirror on the far wall, a pane that stands free, a polished floor, a rough ball
/// and a box that hides things.
inline const std::string kRoom = R"(
void plastic grey 0 0 5 .5 .5 .5 0 0
void plastic red 0 0 5 .6 .1 .1 0 0
void plastic tiles 0 0 5 .4 .4 .5 .06 0
void plastic satin 0 0 5 .3 .5 .3 .04 .1
void mirror silver 0 0 3 .9 .9 .9
void glass pane 0 0 3 .9 .9 .9
void light lamp 0 0 3 40 40 40
grey polygon back 0 0 12  -4 6 0  4 6 0  4 6 3  -4 6 3
grey polygon left 0 0 12  -4 -6 0  -4 6 0  -4 6 3  -4 -6 3
red polygon right 0 0 12  4 6 0  4 -6 0  4 -6 3  4 6 3
grey polygon near 0 0 12  4 -6 0  -4 -6 0  -4 -6 3  4 -6 3
tiles polygon floor 0 0 12  -4 -6 0  4 -6 0  4 6 0  -4 6 0
grey polygon ceiling 0 0 12  -4 6 3  4 6 3  4 -6 3  -4 -6 3
silver polygon mirror 0 0 12  -2 5.99 .5  1 5.99 .5  1 5.99 2.5  -2 5.99 2.5
pane polygon window 0 0 12  1.5 3 0  3.5 3 0  3.5 3 2.5  1.5 3 2.5
satin sphere ball 0 0 4 -1.5 2 .7 .7
red cylinder post 0 0 7 .8 1 0 .8 1 3 .1
lamp polygon panel 0 0 12  -1 -1 2.99  -1 1 2.99  1 1 2.99  1 -1 2.99
)";

inline constexpr int kWidth = 160, kHeight = 120;

inline View view_at(double forward, double aside, double turned) {
    View view;
    view.position = {aside, -4 + forward, 1.5};
    view.direction = {std::sin(turned), std::cos(turned), -0.05};
    view.horizontal = 60;
    view.vertical = 46.8;
    return view;
}

/// Twelve steps: a turn, forward, backward, sideways.
inline View view_of(const std::string& walk, int step) {
    const double pace = 0.03 * step;
    if (walk == "turn") return view_at(0, 0, 0.0105 * step);
    if (walk == "forward") return view_at(pace, 0, 0);
    if (walk == "backward") return view_at(1 - pace, 0, 0);
    return view_at(0, pace, 0);
}

inline FrameOptions frame_options(int width = kWidth, int height = kHeight) {
    FrameOptions options;
    options.width = width;
    options.height = height;
    options.pixels.spacing = 1;
    return options;
}

inline CloudOptions rotating() {
    CloudOptions options;
    options.check = CloudCheck::rotating;
    return options;
}

/// The rays of a scene, and a list of who has looked where.
class WatchedCaster final : public PixelCaster {
  public:
    WatchedCaster(SceneCaster& caster, int width, std::atomic<std::size_t>& looked,
                  std::vector<std::uint8_t>& seen)
        : caster_(caster), width_(width), looked_(looked), seen_(seen) {}
    void probe(std::span<const PixelPlace> places, const ProbeOptions& options,
               std::span<PixelVisibility> visibility, int worker) override {
        looked_ += places.size();
        for (const PixelPlace& place : places)
            seen_[static_cast<std::size_t>(place.y * width_ + place.x)] = 1;
        caster_.probe(places, options, visibility, worker);
    }
    void trace(std::span<const PixelPlace> places, std::span<TracedPixel> pixels, int sample,
               int worker) override {
        caster_.trace(places, pixels, sample, worker);
    }

  private:
    SceneCaster& caster_;
    int width_;
    std::atomic<std::size_t>& looked_;
    std::vector<std::uint8_t>& seen_;
};

struct Room {
    /// @param w, h  of what draw() draws
    explicit Room(int w = kWidth, int h = kHeight) : width(w), height(h) {}

    int width, height;
    TestScene scene{kRoom};
    VisibilityProbe visibility{scene.tracer};
    StopFlag stop;
    std::atomic<std::size_t> looked = 0;  ///< pixels that draw() has looked at
    std::vector<std::uint8_t> seen =      ///< for each pixel: not 0 if it is one of them
        std::vector<std::uint8_t>(static_cast<std::size_t>(width * height));

    /// Of draw(). Made once, not for each frame: each has coroutines, and ThreadSanitizer gives
    /// back nothing of what it keeps of one.
    std::optional<WorkerContexts> frame_contexts;

    CloudFrame draw(CloudFrames& frames, const View& view, Executor& executor) {
        if (!frame_contexts || frame_contexts->size() != executor.concurrency())
            frame_contexts.emplace(scene.tracer, scene.warnings, executor.concurrency());
        SceneCaster caster(scene.tracer, visibility, Camera(view), frame_options(width, height),
                           *frame_contexts, stop);
        WatchedCaster watched(caster, width, looked, seen);
        return frames.draw(caster.camera(), watched, executor, stop);
    }

    /// All of the frame traced, row by row from the bottom.
    std::vector<TracedPixel> truth(const View& view) {
        WorkerContexts contexts(scene.tracer, scene.warnings, 1);
        const Camera camera(view);
        SceneCaster caster(scene.tracer, visibility, camera, frame_options(), contexts, stop);
        std::vector<PixelPlace> places;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) places.push_back({x, y});
        std::vector<TracedPixel> pixels(places.size());
        caster.trace(places, pixels, 0, 0);
        return pixels;
    }
};

inline std::vector<Rgb> radiance_of(const std::vector<TracedPixel>& pixels) {
    std::vector<Rgb> radiance;
    for (const TracedPixel& pixel : pixels) radiance.push_back(pixel.radiance);
    return radiance;
}

inline std::size_t off_by_a_tenth(const std::vector<Rgb>& radiance,
                                  const std::vector<TracedPixel>& truth,
                                  bool mirrored_only = false) {
    std::size_t off = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        if (mirrored_only && !truth[i].visibility.mirrored.seen) continue;
        const float is = brightness(radiance[i]), should = brightness(truth[i].radiance);
        if (std::abs(is - should) > 0.1f * should) ++off;
    }
    return off;
}

}  // namespace lightwalk::test::cloud_room
