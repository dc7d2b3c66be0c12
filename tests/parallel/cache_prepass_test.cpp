#include "parallel/cache_prepass.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "parallel/concurrent_cache.h"
#include "tests/one_thread.h"
#include "tests/parallel/ambient_values.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

/// A scene with a cache of its own, the prepass played and a picture made after it.
struct Played {
    explicit Played(CachePrepass prepass, int workers = 1, const FrameOptions& frame = small(),
                    int bounces = 1, const std::string& more = "")
        : scene(kAmbientRoom + more, ambient_options(bounces, 0.5, 8)),
          shared(ambient_limits(scene.scene.cube().origin, scene.scene.cube().size, 0.5, 8)),
          cache(shared),
          executor(make_executor(ExecutorKind::threads, workers)),
          contexts(scene.tracer, scene.warnings, workers),
          options(frame) {
        scene.tracer.use_ambient_cache(&cache);
        result = play(prepass, [](const FrameProgress&) {});
    }

    static FrameOptions small() {
        FrameOptions options;
        options.width = 66;
        options.height = 50;
        options.pixels.spacing = 1;  // every pixel, however refinement chooses
        return options;
    }
    CachePrepassResult play(CachePrepass prepass, TakeProgress progress) {
        return fill_ambient_cache(scene.tracer, eye, options, prepass, cache, *executor, contexts,
                                  stop, progress);
    }
    Frame picture() {
        return render_frame(scene.tracer, eye, options, *executor, contexts, stop,
                            [](const FrameProgress&) {});
    }

    TestScene scene;
    ConcurrentCache shared;
    PublishedCache cache;
    std::unique_ptr<Executor> executor;
    WorkerContexts contexts;
    FrameOptions options;
    Camera eye = ambient_eye();
    StopFlag stop;
    CachePrepassResult result;
};

bool same_pixel_bytes(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Rgb)) == 0;
}

}  // namespace

TEST_CASE("the prepass computes most of the values that the picture needs, and leaves them") {
    FrameOptions large = Played::small();
    large.width = 198;
    large.height = 150;
    Played none(CachePrepass::none, 1, large);
    CHECK(none.result.complete);
    CHECK(none.result.rays.total() == 0);
    CHECK(none.shared.size() == 0);
    const std::uint64_t alone = none.picture().ambient.computed;
    Played quick(CachePrepass::quick, 1, large);
    CHECK(quick.result.complete);
    CHECK(quick.result.rays.primary == 33 * 25);  // one pixel of 6 x 6
    CHECK(quick.result.ambient.computed > 0);
    CHECK(quick.shared.size() == quick.result.ambient.computed);
    const std::uint64_t after = quick.picture().ambient.computed;
    CHECK(after < alone / 2);
    CHECK(quick.shared.size() == quick.result.ambient.computed + after);
}

TEST_CASE("after a deterministic prepass the cache is closed and pictures are the same bytes") {
    for (const int bounces : {1, 2, 3}) {
        CAPTURE(bounces);
        Played expected(CachePrepass::deterministic, 1, Played::small(), bounces);
        const std::size_t values = expected.shared.size();
        CHECK(values > 0);
        const Frame picture = expected.picture();
        CHECK(expected.shared.size() == values);
        CHECK(expected.picture().radiance == picture.radiance);
        for (const int workers : {2, 7}) {
            CAPTURE(workers);
            Played other(CachePrepass::deterministic, workers, Played::small(), bounces);
            CHECK(other.shared.size() == values);
            CHECK(other.result.rays.total() == expected.result.rays.total());
            CHECK(same_pixel_bytes(other.picture().radiance, picture.radiance));
        }
    }
}

TEST_CASE("a deterministic prepass leaves nothing for the picture to compute") {
    FrameOptions sampled = Played::small();
    sampled.pixels.samples = 3;
    for (const FrameOptions& options : {Played::small(), sampled}) {
        for (const int bounces : {1, 2}) {
            Played played(CachePrepass::deterministic, 2, options, bounces);
            CHECK(played.result.ambient.computed > 0);
            CHECK(played.picture().ambient.computed == 0);
        }
    }
}

TEST_CASE("the values of a deterministic prepass are as good, and about as many, as one worker's" *
          about_numbers) {
    // Accurate: so many values that each is of few points.
    FrameOptions large = Played::small();
    large.width = 132;
    large.height = 100;
    for (const int bounces : {1, 2}) {
        CAPTURE(bounces);
        Played rounds(CachePrepass::deterministic, 2, large, bounces),
            quick(CachePrepass::quick, 1, large, bounces),
            none(CachePrepass::none, 1, large, bounces);
        none.scene.tracer.use_ambient_cache(nullptr);
        const Frame exact = none.picture(), serial = quick.picture(), picture = rounds.picture();
        const auto error = [&](const Frame& frame) {
            double sum = 0, all = 0;
            for (std::size_t i = 0; i < exact.radiance.size(); ++i) {
                sum += static_cast<double>(
                    std::abs(brightness(frame.radiance[i]) - brightness(exact.radiance[i])));
                all += static_cast<double>(brightness(exact.radiance[i]));
            }
            return sum / all;
        };
        CHECK(error(serial) > 0);
        CHECK(error(picture) < 1.15 * error(serial));
        const auto most = 1.25 * static_cast<double>(quick.shared.size());
        CHECK(static_cast<double>(rounds.result.ambient.computed) < most);
    }
}

TEST_CASE("a deterministic prepass fills clipped matter, too, with the same bytes") {
    const std::string cut = "void antimatter hole 1 paint 0 0\nhole sphere cut 0 0 4 0 .2 1 .8\n";
    Played expected(CachePrepass::deterministic, 1, Played::small(), 1, cut);
    const std::size_t values = expected.shared.size();
    const Frame picture = expected.picture();
    CHECK(values > Played(CachePrepass::quick, 1, Played::small(), 1, cut).shared.size() / 2);
    CHECK(picture.ambient.computed < values / 2);  // most of the hole is filled
    Played other(CachePrepass::deterministic, 2, Played::small(), 1, cut);
    CHECK(other.shared.size() == values);
    CHECK(same_pixel_bytes(other.picture().radiance, picture.radiance));
}

TEST_CASE("windows of a picture after a deterministic prepass are parts of the whole") {
    const Frame whole = Played(CachePrepass::deterministic, 2).picture();
    FrameOptions part = Played::small();
    part.window = PixelRectangle{13, 5, 40, 31};
    const Frame window = Played(CachePrepass::deterministic, 2, part).picture();
    REQUIRE(window.width == 27);
    for (int y = 5; y < 31; ++y) {
        for (int x = 13; x < 40; ++x) {
            CHECK(window.radiance[static_cast<std::size_t>((30 - y) * 27 + x - 13)] ==
                  whole.radiance[static_cast<std::size_t>((49 - y) * 66 + x)]);
        }
    }
    // The quick one looks at no more than it has to.
    CHECK(prepass_pixels(part, CachePrepass::quick) == 5 * 6);
    CHECK(prepass_pixels(Played::small(), CachePrepass::quick) == 11 * 9);
    CHECK(prepass_pixels(part, CachePrepass::none) == 0);
    CHECK(prepass_pixels(part, CachePrepass::deterministic) ==
          prepass_pixels(Played::small(), CachePrepass::deterministic));
}

TEST_CASE(
    "the prepass tells how far it is: to all of its pixels, rays and values, over all steps") {
    for (const CachePrepass prepass : {CachePrepass::quick, CachePrepass::deterministic}) {
        Played scene(CachePrepass::none);
        FrameProgress last;
        std::size_t told = 0;
        const CachePrepassResult result = scene.play(prepass, [&](const FrameProgress& now) {
            CHECK(now.done > last.done);
            CHECK(now.rays >= last.rays);
            CHECK(now.ambient_values >= last.ambient_values);
            last = now;
            ++told;
        });
        CHECK(told > 1);
        CHECK(last.done == doctest::Approx(1).epsilon(1e-12));  // sums of shares are rounded
        CHECK(last.rays == result.rays.total());
        CHECK(last.ambient_values == result.ambient.computed);
    }
}

TEST_CASE("a requested stop ends the prepass early, and the cache stays open") {
    for (const CachePrepass prepass : {CachePrepass::quick, CachePrepass::deterministic}) {
        Played scene(CachePrepass::none, 2);
        const CachePrepassResult result =
            scene.play(prepass, [&](const FrameProgress&) { scene.stop.request(); });
        CHECK_FALSE(result.complete);
        CHECK(result.rays.primary < prepass_pixels(scene.options, prepass));
        scene.stop.clear();
        const std::size_t before = scene.shared.size();
        CHECK(scene.picture().complete);
        CHECK(scene.shared.size() > before);
    }
}
