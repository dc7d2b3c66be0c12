#include "parallel/block_renderer.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "parallel/frame.h"
#include "tests/parallel/room_view.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using lightwalk::test::room_view;
using lightwalk::test::Silence;
using lightwalk::test::TestScene;

namespace {

/// Rough and mirror-like surfaces, a lamp, a lamp smaller than a pixel, and a sky.
const std::string kBlockRoom = R"(
void plastic floor 0 0 5 .5 .4 .3 0 0
void metal ball 0 0 5 .9 .8 .7 .8 .1
void mirror silver 0 0 3 .9 .9 .9
void light lamp 0 0 3 20 20 20
void light speck 0 0 3 9000 9000 9000
void glow sky 0 0 4 1 1 2 0
sky source dome 0 0 4 0 0 1 180
floor polygon ground 0 0 12  -9 -9 0  9 -9 0  9 9 0  -9 9 0
ball sphere shiny 0 0 4 0 0 1 1
silver polygon glass 0 0 12  2 2 0  4 2 0  4 2 2  2 2 2
lamp polygon panel 0 0 12  -1 -1 5  -1 1 5  1 1 5  1 -1 5
speck sphere spark 0 0 4 -2 0 1.5 .004
)";

RenderOptions noisy() {
    RenderOptions options;
    options.source_jitter = 0.9;
    return options;
}

FrameOptions options_of(int spacing, bool use_distances) {
    FrameOptions options;
    options.width = 97;
    options.height = 73;
    options.pixels.spacing = spacing;
    options.use_distances = use_distances;
    options.hits = true;
    return options;
}

struct Room {
    explicit Room(RenderOptions options = noisy()) : scene(kBlockRoom, options) {}

    Frame frame(const FrameOptions& options, int workers = 1) {
        WorkerContexts contexts(scene.tracer, scene.warnings, workers);
        return render_frame(scene.tracer, camera, options,
                            *make_executor(ExecutorKind::threads, workers), contexts, stop,
                            [](const FrameProgress&) {});
    }

    TestScene scene;
    Camera camera{room_view()};
    StopFlag stop;
};

std::size_t at(const Frame& frame, int x, int y) {
    return static_cast<std::size_t>(frame.height - 1 - y) * static_cast<std::size_t>(frame.width) +
           static_cast<std::size_t>(x);
}

/// Whether the pixels of `part`, whose lower left one is (x0, y0) of `whole`, are the same there.
bool is_part(const Frame& part, const Frame& whole, int x0, int y0) {
    for (int y = 0; y < part.height; ++y) {
        for (int x = 0; x < part.width; ++x) {
            const std::size_t i = at(part, x, y), j = at(whole, x0 + x, y0 + y);
            if (part.radiance[i] != whole.radiance[j] || part.distance[i] != whole.distance[j] ||
                part.hits[i] != whole.hits[j])
                return false;
        }
    }
    return true;
}

}  // namespace

TEST_CASE("windows put together are the whole picture, wherever it is cut") {
    Room room;
    for (const int spacing : {1, 4, 7}) {
        CAPTURE(spacing);
        FrameOptions options = options_of(spacing, spacing == 7);
        const Frame whole = room.frame(options, 2);
        for (const auto& [cut_x, cut_y] :
             {std::pair{32, 32}, std::pair{41, 29}, std::pair{1, 72}}) {
            CAPTURE(cut_x);
            for (const PixelRectangle& window :
                 {PixelRectangle{0, 0, cut_x, cut_y}, PixelRectangle{cut_x, 0, 97, cut_y},
                  PixelRectangle{0, cut_y, cut_x, 73}, PixelRectangle{cut_x, cut_y, 97, 73}}) {
                options.window = window;
                const Frame part = room.frame(options, 2);
                REQUIRE(part.width == window.width());
                REQUIRE(part.height == window.height());
                CHECK(is_part(part, whole, window.x0, window.y0));
            }
        }
    }
}

TEST_CASE("blocks of any size and order make the same picture, each handed on once") {
    Room room;
    for (const int spacing : {1, 4}) {
        const FrameOptions options = options_of(spacing, false);
        const Frame whole = room.frame(options);
        WorkerContexts contexts(room.scene.tracer, room.scene.warnings, 3);
        const BlockRenderer renderer(room.scene.tracer, room.camera, options, contexts, room.stop);
        const std::vector<Block> blocks{
            {0, 21, 97, 73}, {0, 20, 97, 21}, {50, 0, 97, 20}, {0, 0, 50, 20}};
        std::mutex mutex;
        std::vector<int> times(97 * 73);
        render_blocks(renderer, blocks, *make_executor(kDefaultExecutor, 3), room.stop,
                      [&](const BlockPixels& pixels, int) {
                          const std::lock_guard lock(mutex);
                          const Block& block = pixels.block;
                          for (int y = block.y0; y < block.y1; ++y) {
                              for (int x = block.x0; x < block.x1; ++x) {
                                  ++times[static_cast<std::size_t>(y * 97 + x)];
                                  const std::size_t i = pixels.index({x, y});
                                  const std::size_t j = at(whole, x, y);
                                  REQUIRE(pixels.values[i].radiance == whole.radiance[j]);
                                  REQUIRE(pixels.values[i].distance == whole.distance[j]);
                                  REQUIRE(pixels.hits[i] == whole.hits[j]);
                              }
                          }
                      });
        CHECK(std::all_of(times.begin(), times.end(), [](int n) { return n == 1; }));
    }
}

TEST_CASE("an error in one block ends the others' work and is told") {
    Room room;
    WorkerContexts contexts(room.scene.tracer, room.scene.warnings, 3);
    const BlockRenderer renderer(room.scene.tracer, room.camera, options_of(4, false), contexts,
                                 room.stop);
    for (const ExecutorKind kind :
         {ExecutorKind::serial, ExecutorKind::threads, kDefaultExecutor}) {
        const std::vector<Block> blocks(1000, {40, 30, 44, 34});
        std::atomic<int> rendered = 0;
        const auto take = [&](const BlockPixels&, int) {
            ++rendered;
            throw InputError("no");
        };
        CHECK_THROWS_AS(render_blocks(renderer, blocks, *make_executor(kind, 3), room.stop, take),
                        InputError);
        CHECK(rendered <= 3);
    }
}

TEST_CASE("a stopped block is not handed on") {
    Room room;
    WorkerContexts contexts(room.scene.tracer, room.scene.warnings, 1);
    const BlockRenderer renderer(room.scene.tracer, room.camera, options_of(1, false), contexts,
                                 room.stop);
    BlockPixels pixels;
    CHECK(renderer.render({0, 0, 8, 8}, 0, pixels));
    room.stop.request();
    CHECK_FALSE(renderer.render({0, 0, 8, 8}, 0, pixels));
}

TEST_CASE(
    "hits name the nearest surface, its modifier and place, and how far a mirror's image is") {
    Room room(TestScene::exact());
    FrameOptions options = options_of(1, false);
    options.pixels.jitter = 0;
    const Frame frame = room.frame(options);
    const auto name = [&](const PixelHit& hit) {
        return hit.surface == kNoSurface
                   ? std::string()
                   : std::string(room.scene.scene.surface(hit.surface).name());
    };
    std::vector<std::string> seen;
    for (int y = 0; y < 73; ++y) {
        for (int x = 0; x < 97; ++x) {
            const PixelHit& hit = frame.hits[at(frame, x, y)];
            REQUIRE(hit.traced);
            seen.push_back(name(hit));
            if (seen.back() == "dome" || seen.back().empty()) {
                CHECK(hit.position == room_view().position);
                continue;
            }
            CHECK(hit.modifier == room.scene.scene.surface(hit.surface).modifier());
            const Camera::ImagePosition image = room.camera.locate(hit.position);
            CHECK(image.h * 97 == doctest::Approx(x + 0.5).epsilon(1e-9));  // rounding of doubles
            CHECK(image.v * 73 == doctest::Approx(y + 0.5).epsilon(1e-9));
            if (seen.back() == "ground") CHECK(std::abs(hit.position.z) < 1e-9);
            if (seen.back() == "glass")
                CHECK(hit.reflected_path_length > length(hit.position - room_view().position));
            else
                CHECK((seen.back() == "shiny" || hit.reflected_path_length == kHuge));
        }
    }
    for (const std::string wanted : {"ground", "shiny", "glass", "dome"})
        CHECK(std::count(seen.begin(), seen.end(), wanted) > 10);
}

TEST_CASE("nothing is hit where there is nothing, and interpolated pixels hit nothing themselves") {
    Room room;
    const FrameOptions options = options_of(4, false);
    const Frame frame = room.frame(options);
    const auto traced = static_cast<std::size_t>(std::count_if(
        frame.hits.begin(), frame.hits.end(), [](const PixelHit& hit) { return hit.traced; }));
    CHECK(traced > frame.hits.size() / 16);
    CHECK(traced < frame.hits.size());
    for (const PixelHit& hit : frame.hits) CHECK((hit.traced || hit == PixelHit{}));

    const TestScene empty("void plastic p 0 0 5 1 1 1 0 0\np sphere s 0 0 4 0 -50 0 1\n");
    FrameOptions nothing;
    nothing.width = nothing.height = 8;
    nothing.pixels.spacing = 1;
    nothing.hits = true;
    Silence warnings;
    WorkerContexts contexts(empty.tracer, warnings, 1);
    const Frame dark =
        render_frame(empty.tracer, Camera(View{}), nothing, *make_executor(ExecutorKind::serial, 1),
                     contexts, StopFlag(), [](const FrameProgress&) {});
    for (const PixelHit& hit : dark.hits) {
        CHECK(hit.traced);
        CHECK(hit.surface == kNoSurface);
        CHECK(hit.reflected_path_length == kHuge);
    }
}
