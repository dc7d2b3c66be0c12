// What a frame of a walk costs before anything is traced: points projected, and pixels checked by
// rays, in the demo scene's living room. Arguments: width of a 4:3 picture (1920: 16:9), threads.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/cloud/visibility_probe.h"
#include "core/material/modifier_factories.h"
#include "core/view/view_path.h"
#include "io/scene/file_resources.h"
#include "io/scene/scene_reader.h"
#include "parallel/walk/cloud_frames.h"
#include "parallel/walk/scene_caster.h"

namespace lightwalk {
namespace {

class NoWarnings final : public WarningSink {
  public:
    void warn(const std::string&) override {}
};

/// The demo scene, by day.
class LodgeScene {
  public:
    LodgeScene()
        : options_{LibraryPath({kFolder, LIGHTWALK_SOURCE "/io/library"}), false, kFolder},
          resources_(options_.library.relative_to(kFolder), false, warnings_),
          scene_(read_scene(std::vector<std::string>{"lodge.rad", "day.rad"}, options_, warnings_),
                 modifier_factory, resources_, warnings_),
          tracer_(scene_, RenderOptions{}, warnings_),
          probe_(tracer_) {}

    [[nodiscard]] const Tracer& tracer() const { return tracer_; }
    [[nodiscard]] const VisibilityProbe& visibility() const { return probe_; }
    [[nodiscard]] NoWarnings& warnings() { return warnings_; }

  private:
    static constexpr const char* kFolder = LIGHTWALK_SOURCE "/apps/scenes/lodge";
    NoWarnings warnings_;
    SceneReadOptions options_;
    FileResources resources_;
    Scene scene_;
    Tracer tracer_;
    VisibilityProbe probe_;
};

View living_room() {
    View view;
    view.position = {9.2, 6.3, 1.7};
    view.direction = {-0.86, -0.5, -0.06};
    view.horizontal = 62;
    view.vertical = 48;
    return view;
}

FrameOptions picture(int width) {
    FrameOptions options;
    options.width = width;
    options.height = width == 1920 ? 1080 : width * 3 / 4;
    options.pixels.spacing = 1;
    return options;
}

/// Traces nothing: what it looks at is grey.
class UnshadedCaster final : public PixelCaster {
  public:
    explicit UnshadedCaster(SceneCaster& caster) : caster_(caster) {}
    void probe(std::span<const PixelPlace> places, const ProbeOptions& options,
               std::span<PixelVisibility> visibility, int worker) override {
        caster_.probe(places, options, visibility, worker);
    }
    void trace(std::span<const PixelPlace> places, std::span<TracedPixel> pixels, int,
               int worker) override {
        std::vector<PixelVisibility> visibility(places.size());
        caster_.probe(places, {}, visibility, worker);
        for (std::size_t i = 0; i < places.size(); ++i)
            pixels[i] = {visibility[i], Rgb::grey(1), {}, visibility[i].ahead.distance};
    }

  private:
    SceneCaster& caster_;
};

/// A turn there and back. What has to be traced is not shaded: the time is that of the cloud.
void frames_of_a_turn(benchmark::State& state) {
    LodgeScene scene;
    const FrameOptions options = picture(static_cast<int>(state.range(0)));
    const auto executor = make_executor(kDefaultExecutor, static_cast<int>(state.range(1)));
    WorkerContexts contexts(scene.tracer(), scene.warnings(), executor->concurrency());
    const StopFlag stop;
    CloudFrames frames(options.width, options.height, {});
    const auto draw = [&](int step) {
        SceneCaster caster(scene.tracer(), scene.visibility(),
                           Camera(turned_view(living_room(), 0.6 * step)), options, contexts, stop);
        UnshadedCaster unshaded(caster);
        return frames.draw(caster.camera(), unshaded, *executor, stop);
    };
    (void)draw(0);
    double project = 0, check = 0, keep = 0, points = 0, reused = 0;
    int step = 0;
    for ([[maybe_unused]] auto iteration : state) {
        points += static_cast<double>(frames.points().size());
        const CloudReport report = draw(++step % 20 < 10 ? step % 20 : 20 - step % 20).report;
        project += report.project_seconds;
        check += report.check_seconds;
        keep += report.keep_seconds;
        reused += static_cast<double>(report.reused) / static_cast<double>(report.pixels);
        state.SetIterationTime(report.project_seconds + report.check_seconds);
    }
    const auto count = static_cast<double>(state.iterations());
    const double pixels = static_cast<double>(options.whole().pixels());
    state.counters["project_ms"] = 1e3 * project / count;
    state.counters["check_ms"] = 1e3 * check / count;
    state.counters["keep_ms"] = 1e3 * keep / count;
    state.counters["ns_a_point"] = 1e9 * project / points;
    state.counters["ns_a_pixel"] = 1e9 * check / (pixels * count);
    state.counters["points"] = points / count;
    state.counters["reused"] = reused / count;
    // Of projection alone: a point is read, its place written, two grids are cleared and read.
    const double bytes = points * (sizeof(CloudPoint) + sizeof(ImagePlace) + 1 + 16) +
                         count * pixels * 2 * sizeof(std::uint64_t);
    state.counters["project_GB_s"] = 1e-9 * bytes / project;
}

/// What the machine's memory gives: a large array copied.
void memory_copy(benchmark::State& state) {
    std::vector<std::uint64_t> from(std::size_t{1} << 24, 1), to(from.size());
    for ([[maybe_unused]] auto iteration : state) {
        std::copy(from.begin(), from.end(), to.begin());
        benchmark::DoNotOptimize(to.data());
    }
    state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) *
                            static_cast<std::int64_t>(2 * sizeof(from[0]) * from.size()));
}

// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables): how Google Benchmark registers
BENCHMARK(frames_of_a_turn)
    ->Args({640, 1})
    ->Args({640, 2})
    ->Args({1920, 1})
    ->Args({1920, 2})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(memory_copy)->Unit(benchmark::kMillisecond);
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

}  // namespace
}  // namespace lightwalk

BENCHMARK_MAIN();
