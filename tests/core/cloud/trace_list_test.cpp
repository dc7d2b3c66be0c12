#include "core/cloud/trace_list.h"

#include <doctest/doctest.h>

#include <vector>

using namespace lightwalk;

namespace {

/// Blocks whose points have left these pixels.
std::vector<BlockUncachedPixels> blocks_of(const std::vector<std::vector<UncachedPixel>>& left,
                                           bool time_is_short) {
    std::vector<BlockUncachedPixels> blocks;
    for (const std::vector<UncachedPixel>& pixels : left) {
        BlockUncachedPixels& block = blocks.emplace_back();
        block.uncached = pixels;
        for (const UncachedPixel& pixel : pixels) {
            ++block.ranked[trace_rank(pixel, time_is_short)];
            block.unanswered += pixel.cause != TraceCause::audited ? 1 : 0;
        }
    }
    return blocks;
}

}  // namespace

TEST_CASE(
    "trace list: where time is short the worst causes come first, among equals coarse grids") {
    const std::vector<std::vector<UncachedPixel>> left{
        {{{1, 1}, TraceCause::uneven}, {{3, 1}, TraceCause::uncovered}},
        {{{16, 16}, TraceCause::uncovered}, {{17, 1}, TraceCause::hidden}}};
    for (const bool time_is_short : {true, false}) {
        CloudOptions options;
        options.budget = time_is_short ? 1 : 0;
        TraceList list(options);
        list.begin();
        std::vector<BlockUncachedPixels> blocks = blocks_of(left, time_is_short);
        list.gather(blocks, 0, SerialTaskRunner());
        CHECK(list.unanswered() == 4);
        CHECK(list.places() == (time_is_short
                                    ? std::vector<PixelPlace>{{16, 16}, {3, 1}, {17, 1}, {1, 1}}
                                    : std::vector<PixelPlace>{{1, 1}, {3, 1}, {16, 16}, {17, 1}}));
    }
}

TEST_CASE("trace list: what was traced in time is shown and leaves points, the rest is filled") {
    TraceList list({});
    list.begin();
    std::vector<BlockUncachedPixels> blocks = blocks_of({{{{0, 0}, TraceCause::uncovered},
                                                          {{1, 0}, TraceCause::hidden},
                                                          {{2, 0}, TraceCause::audited}}},
                                                        false);
    list.gather(blocks, 0, SerialTaskRunner());
    TracedPixelResult traced;
    traced.value = {Rgb::grey(2), 5};
    traced.points.count = 1;
    list.record(1, std::vector{traced, traced});
    CloudFrame frame;
    frame.area = {0, 0, 3, 1};
    frame.radiance.resize(3);
    frame.distance.resize(3);
    frame.causes.resize(3);
    frame.known = {0, 0, 1};
    frame.origins.resize(3);
    frame.report.pixels = 3;
    CloudFrame passing = frame;
    TraceList(list).show(passing, true);
    CHECK(passing.origins[0].kind == PixelOrigin::Kind::filled);
    CHECK(passing.origins[1].kind == PixelOrigin::Kind::reused);
    list.show(frame, false);
    CHECK(frame.origins[1].kind == PixelOrigin::Kind::traced);
    CHECK(frame.radiance == passing.radiance);
    CHECK(frame.radiance == std::vector<Rgb>{Rgb{}, Rgb::grey(2), Rgb::grey(2)});
    CHECK(frame.distance == std::vector<float>{0, 5, 5});
    CHECK(frame.known == std::vector<std::uint8_t>{0, 1, 1});
    CHECK(frame.report.reused == 1);
    CHECK(frame.report.filled == 1);
    CHECK(frame.report.uncached[static_cast<std::size_t>(TraceCause::hidden)] == 1);
    CHECK(frame.report.audit_errors == std::vector<float>{1});  // black was shown, and is grey
    REQUIRE(list.values().size() == 3);
    CHECK_FALSE(list.values()[0]);
    CHECK(list.values()[1] == traced.value);

    RegionPoints points({0, 0, 3, 1}, 3, 1);
    const Camera camera{View{}};
    points.begin(camera);
    list.leave_points(points);
    CHECK(points.rest()[0] == 2);
}

TEST_CASE("trace list: some audited pixels are traced twice, and tell how much two rays differ") {
    TraceList list({});
    list.begin();
    std::vector<UncachedPixel> audited;
    for (int x = 0; x < 400; ++x) audited.push_back({{x, 0}, TraceCause::audited});
    std::vector<BlockUncachedPixels> blocks = blocks_of({audited}, false);
    list.gather(blocks, 0, SerialTaskRunner());
    CHECK(list.unanswered() == 0);
    CHECK(list.noise_pairs() > 60);  // of 100 expected, by more than four standard deviations
    CHECK(list.noise_pairs() < 140);
    REQUIRE(list.places().size() == 400 + list.noise_pairs());
    TracedPixelResult traced;
    traced.value.radiance = Rgb::grey(2);
    list.record(0, std::vector<TracedPixelResult>(400, traced));
    traced.value.radiance = Rgb::grey(1);
    list.record(400, std::vector<TracedPixelResult>(list.noise_pairs(), traced));
    CloudFrame frame;
    frame.area = {0, 0, 400, 1};
    frame.radiance.resize(400);
    frame.distance.resize(400);
    frame.causes.resize(400);
    frame.known.resize(400);
    list.show(frame, false);
    CHECK(frame.report.audit_floors == std::vector<float>(list.noise_pairs(), 0.5f));
}
