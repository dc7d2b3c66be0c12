// What tracing each part of a picture costs: the input of scaling_model.
//   cost_map OPTIONS OF lightwalk render > map.json
// One thread traces the picture cell by cell, three times, and the shortest processor time of each
// cell counts: what else the machine does hardly disturbs it. With ambient values a prepass and
// the picture are traced once with an empty cache, which tells what making values takes, and again
// with the full one.
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>
#include <thread>

#include "apps/render_command.h"
#include "apps/session/scene_session.h"
#include "apps/warnings.h"
#include "core/error.h"
#include "io/files/file_source.h"
#include "parallel/block_renderer.h"
#include "parallel/cache_prepass.h"
#include "parallel/ranks/piece_codec.h"

namespace {

using namespace lightwalk;
using Json = nlohmann::ordered_json;

constexpr int kPasses = 3;
constexpr int kMostCrowded = 4;  ///< threads side by side whose influence on each other is measured
constexpr int kSide = 64;        ///< of the blocks whose time is compared with that of their cells

double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Seconds of each block, in their order.
std::vector<double> time_blocks(const BlockRenderer& renderer, const std::vector<Block>& blocks,
                                int worker) {
    std::vector<double> seconds;
    BlockPixels pixels;
    double before = processor_seconds();
    for (const Block& block : blocks) {
        (void)renderer.render(block, worker, pixels);
        const double after = processor_seconds();
        seconds.push_back(after - before);
        before = after;
    }
    return seconds;
}

double sum(const std::vector<double>& list) {
    double total = 0;
    for (const double one : list) total += one;
    return total;
}

std::shared_ptr<const CompiledScene> compiled_scene(CommonOptions& options, WarningSink& warnings) {
    resolve_scene_files(options, "", *real_files());
    auto scene = std::make_shared<CompiledScene>(options.request.source, warnings);
    scene->compile();
    return scene;
}

class Measurement {
  public:
    explicit Measurement(RenderCommand command)
        : command_(std::move(command)),
          warnings_("cost_map"),
          session_(compiled_scene(command_.common, warnings_), light().light, light().ambient_file,
                   OthersValues::taken, false, warnings_) {}

    Json run() {
        const Camera camera(command_.view);
        const PictureSize size =
            fit_picture(command_.x, command_.y, camera.aspect(), command_.pixel_aspect);
        FrameOptions options;
        options.width = size.width;
        options.height = size.height;
        options.pixels = renderer_options().pixels;
        options.seed = light().light.seed;
        const int threads = renderer_options().threads;
        WorkerContexts contexts(session_.tracer(), warnings_, threads);
        const double before = processor_seconds();
        const BlockRenderer renderer(session_.tracer(), camera, options, contexts, stop_);
        (void)contexts[0];
        const double setup = processor_seconds() - before;
        std::optional<BlockRenderer> coarse;
        if (session_.ambient && renderer_options().cache_prepass)
            coarse.emplace(session_.tracer(), camera, quick_prepass(options), contexts, stop_);
        // What comes first fills the cache.
        const Json fills_prepass = coarse ? fill(*coarse, 8) : Json();
        const Json fills_picture = session_.ambient ? fill(renderer, cell_of(renderer)) : Json();
        Json json{{"setup_seconds", setup}};
        const double block_seconds = measure_block(renderer, json);
        json["picture"] = measure(renderer, cell_of(renderer), fills_picture, block_seconds);
        if (coarse) json["overture"] = measure(*coarse, 8, fills_prepass, block_seconds);
        measure_pieces(renderer, json);
        json["crowding"] = measure_crowding(renderer, threads);
        return json;
    }

  private:
    [[nodiscard]] const RenderSettings& light() const { return command_.common.settings; }
    [[nodiscard]] const RendererOptions& renderer_options() const {
        return command_.common.request.options;
    }

    static int cell_of(const BlockRenderer& renderer) {
        return (7 + renderer.alignment()) / renderer.alignment() * renderer.alignment();
    }

    /// Seconds and new values of each cell while the cache fills.
    Json fill(const BlockRenderer& renderer, int cell) {
        std::vector<double> seconds;
        std::vector<std::size_t> values;
        for (const Block& block : squares(renderer.options().area(), cell)) {
            const std::size_t before = session_.ambient->size();
            seconds.push_back(time_blocks(renderer, {block}, 0).front());
            values.push_back(session_.ambient->size() - before);
        }
        return {{"seconds", seconds}, {"values", values}};
    }

    /// What a block takes beside its cells.
    double measure_block(const BlockRenderer& renderer, Json& json) const {
        const PixelRectangle area = renderer.options().area();
        const std::vector<Block> cells = squares(area, cell_of(renderer));
        const std::vector<Block> blocks = squares(area, kSide);
        double small = 1e300, large = 1e300;
        for (int pass = 0; pass < kPasses; ++pass) {
            small = std::min(small, sum(time_blocks(renderer, cells, 0)));
            large = std::min(large, sum(time_blocks(renderer, blocks, 0)));
        }
        const double more = static_cast<double>(cells.size() - blocks.size());
        json["block_seconds"] = more > 0 ? std::max(0.0, small - large) / more : 0;
        return json["block_seconds"];
    }

    static Json measure(const BlockRenderer& renderer, int cell, const Json& fills,
                        double block_seconds) {
        const PixelRectangle area = renderer.options().area();
        const std::vector<Block> cells = squares(area, cell);
        std::vector<double> least = time_blocks(renderer, cells, 0);
        for (int pass = 1; pass < kPasses; ++pass) {
            const std::vector<double> seconds = time_blocks(renderer, cells, 0);
            for (std::size_t i = 0; i < cells.size(); ++i)
                least[i] = std::min(least[i], seconds[i]);
        }
        Json json{{"width", area.x1}, {"height", area.y1}, {"cell", cell}};
        if (!fills.is_null()) {
            std::vector<double> making(cells.size());
            for (std::size_t i = 0; i < cells.size(); ++i) {
                const bool any = fills["values"][i].get<int>() > 0;
                making[i] = any ? std::max(0.0, fills["seconds"][i].get<double>() - least[i]) : 0;
            }
            json["values"] = fills["values"];
            json["making"] = making;
        }
        for (double& seconds : least) seconds = std::max(0.0, seconds - block_seconds);
        json["seconds"] = least;
        return json;
    }

    void measure_pieces(const BlockRenderer& renderer, Json& json) const {
        const PixelRectangle area = renderer.options().area();
        BlockPixels pixels;
        (void)renderer.render(area, 0, pixels);
        const auto count = static_cast<double>(area.pixels());
        double before = processor_seconds();
        const std::string packed = encode_piece(area, pixels.values);
        json["encode_seconds"] = (processor_seconds() - before) / count;
        before = processor_seconds();
        (void)decode_piece(area, packed);
        json["decode_seconds"] = (processor_seconds() - before) / count;
        json["packed_bytes"] = static_cast<double>(packed.size()) / count;
    }

    /// Time by number of threads that trace at once, each the whole picture; one alone = 1.
    static std::vector<double> measure_crowding(const BlockRenderer& renderer, int threads) {
        const std::vector<Block> blocks = squares(renderer.options().area(), kSide);
        std::vector<double> times;
        for (int count = 1; count <= std::min(threads, kMostCrowded); ++count) {
            std::vector<double> least(static_cast<std::size_t>(count), 1e300);
            for (int pass = 0; pass < kPasses; ++pass) {
                std::vector<std::thread> running;
                for (int i = 0; i < count; ++i) {
                    running.emplace_back([&, i] {
                        double& one = least[static_cast<std::size_t>(i)];
                        one = std::min(one, sum(time_blocks(renderer, blocks, i)));
                    });
                }
                for (std::thread& thread : running) thread.join();
            }
            times.push_back(sum(least) / count);
        }
        for (std::size_t i = times.size(); i-- > 0;) times[i] = std::max(1.0, times[i] / times[0]);
        return times;
    }

    RenderCommand command_;
    StderrWarnings warnings_;
    SceneSession session_;
    StopFlag stop_;
};

}  // namespace

int main(int count, char** words) {
    try {
        RenderCommand command("render");
        read_command_line(OptionWords({words + 1, words + count}),
                          option_table(command, real_files()), command.common);
        Measurement measurement(std::move(command));
        std::printf("%s\n", measurement.run().dump().c_str());
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "cost_map: %s\n", error.what());
        return 1;
    }
}
