#include "parallel/walk/frame_lead.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "core/error.h"
#include "parallel/ranks/assembly.h"
#include "parallel/ranks/piece_codec.h"

using namespace lightwalk;

namespace {

constexpr int kSide = 8;
constexpr std::size_t kMostPoints = 256;

/// A frame in two parts, one beside the other.
FinishedFrame frame_of(FrameNumber number) {
    FinishedFrame frame{number, {}};
    for (const int x : {0, kSide / 2}) {
        FramePart part;
        part.frame = number;
        part.area = {x, 0, x + kSide / 2, kSide};
        std::vector<PixelValue> values(part.area.pixels());
        for (PixelValue& value : values) value = {{static_cast<float>(x), 0, 0}, 1};
        part.report.pixels = values.size();
        if (x > 0)
            part.pixels = encode_piece(part.area, values);
        else
            part.pixels = std::move(values);
        part.report.reused = static_cast<std::size_t>(10 + x);
        part.report.check_seconds = x;
        part.report.audit_errors = {static_cast<float>(x)};
        part.report.points = 150;
        frame.parts.push_back(std::move(part));
    }
    return frame;
}

/// The order that a lead gives, with a number.
FrameOrder numbered(FrameOrder order, FrameNumber number) {
    order.number = number;
    return order;
}

struct Lead {
    explicit Lead(const CloudOptions& options = {}, std::uint64_t first = 0)
        : lead(kSide, kSide, options, first) {}
    FrameLead lead;
    std::unique_ptr<Executor> executor = make_executor(ExecutorKind::serial, 1);

    CloudFrame complete(const FrameOrder& order, const FinishedFrame& finished) {
        AssembledFrame whole = assemble_frame(order, finished);
        lead.complete(whole.frame, whole.refined, *executor);
        return whole.frame;
    }
};

}  // namespace

TEST_CASE("a walk's lead: small frames leave room for the points of large ones") {
    FrameLead lead(kSide, kSide, {}, 0);
    lead.resize(kSide / 2, kSide / 2);
    FrameOrder order = lead.order(View{}, {});
    CHECK(order.width == kSide / 2);
    CHECK(order.most_points == kMostPoints);
    lead.resize(2 * kSide, 2 * kSide);
    order = lead.order(View{}, {});
    CHECK(order.most_points == 4 * kMostPoints);
}

TEST_CASE("a walk's lead: parts in any order are the frame, and the report of all of it") {
    Lead walk({}, 5);
    FrameOrder order = numbered(walk.lead.order({}, "first"), 17);
    CHECK(order.rules.frame == 5);
    CHECK(order.rules.empty);
    FinishedFrame finished = frame_of(17);
    std::reverse(finished.parts.begin(), finished.parts.end());
    const CloudFrame frame = walk.complete(order, finished);
    CHECK(frame.complete);
    CHECK(frame.radiance[kSide / 2 - 1].r == 0);
    CHECK(frame.radiance[kSide / 2].r == kSide / 2);
    CHECK(frame.report.pixels == std::size_t{kSide} * kSide);
    CHECK(frame.report.reused == 20 + kSide / 2);
    CHECK(frame.report.check_seconds == kSide / 2);
    CHECK(frame.report.audit_errors == std::vector<float>{0, kSide / 2});
    CHECK(frame.report.points == kMostPoints);  // there is room for no more
    order = walk.lead.order({}, "second");
    CHECK(order.rules.frame == 6);
    CHECK(!order.rules.empty);
}

TEST_CASE("a walk's lead: parts that do not make the frame are refused") {
    Lead walk;
    const FrameOrder order = numbered(walk.lead.order({}, ""), 0);
    const auto refused = [&](const FinishedFrame& finished) {
        CHECK_THROWS_AS((void)assemble_frame(order, finished), InputError);
    };
    refused(frame_of(1));
    FinishedFrame bad = frame_of(0);
    bad.parts.pop_back();
    refused(bad);
    bad = frame_of(0);
    bad.parts[1].area.x1 += 1;
    refused(bad);
    bad = frame_of(0);
    std::get<std::string>(bad.parts[1].pixels).resize(3);
    refused(bad);
    bad = frame_of(0);
    bad.parts[1].pixels = std::vector<PixelValue>(3);
    refused(bad);
    bad = frame_of(0);
    bad.parts[1].unknown = {kSide * kSide / 2};
    refused(bad);
}

TEST_CASE("a walk's lead: pixels that there was no time for are filled from around") {
    Lead walk;
    const FrameOrder order = numbered(walk.lead.order({}, ""), 0);
    FinishedFrame finished = frame_of(0);
    FramePart& part = finished.parts[1];
    std::vector<PixelValue> values(part.area.pixels(), {{7, 7, 7}, 1});
    values[9] = {};
    part.unknown = {9};
    part.pixels = encode_piece(part.area, values);
    part.report.filled = 1;
    const CloudFrame frame = walk.complete(order, finished);
    const std::size_t at = 2 * kSide + kSide / 2 + 1;  // the tenth of four a row
    CHECK(frame.radiance[at].g > 3);
    CHECK(frame.distance[at] == 0);
}

TEST_CASE(
    "a walk's lead: a frame whose view turns out to rest is refined once its origins are known") {
    CloudOptions options;
    options.refine = 1;
    Lead walk(options);
    const View view;
    FrameLead& lead = walk.lead;
    const CloudFrame drawn = walk.complete(numbered(lead.order(view, ""), 0), frame_of(0));
    CHECK(lead.rests(view));
    CHECK(lead.progressive() == nullptr);
    CHECK(lead.wants_origins());
    const FrameOrder ask = numbered(lead.origins_order(""), 1);
    CHECK(ask.rests);
    CHECK(ask.tells_origins);
    CHECK(ask.refined.empty());
    FinishedFrame told = frame_of(1);
    for (FramePart& part : told.parts)
        part.origins.assign(part.area.pixels(), {PixelOrigin::Kind::filled, 0, 0});
    SUBCASE("it is") {
        lead.begin_progressive(drawn, assemble_frame(ask, told).frame.origins);
        REQUIRE(lead.progressive() != nullptr);
        CHECK(lead.progressive()->open_pixels() == std::size_t{kSide} * kSide);
        const FrameOrder order = lead.order(view, "");
        CHECK(order.rests);
        CHECK(order.leaves);
        CHECK(order.refined.size() == std::size_t{kSide} * kSide);
    }
    SUBCASE("origins of fewer pixels are refused") {
        told.parts[1].origins.pop_back();
        CHECK_THROWS_AS((void)assemble_frame(ask, told), InputError);
    }
    SUBCASE("a frame that was stopped does not rest") {
        lead.abandon();
        CHECK_FALSE(lead.rests(view));
        CHECK_FALSE(lead.wants_origins());
    }
}

TEST_CASE("a walk's lead: pixels that are traced beside the frames come in the order of the work") {
    const Lead walk;
    const ProgressiveWork work{3, {{kSide - 1, 0}, {0, 0}, {kSide - 2, 1}}};
    const FrameOrder order = walk.lead.trace_order(work, "light");
    CHECK(order.sample == 3);
    CHECK_FALSE(order.leaves);
    CHECK(order.payload == "light");
    FinishedFrame finished = frame_of(0);
    finished.parts[0].refined = {PixelValue{{1, 1, 1}, 5}};
    finished.parts[1].refined = {PixelValue{{2, 2, 2}, 6}, std::nullopt};
    SUBCASE("they do") {
        const auto values = assemble_frame(order, finished).refined;
        REQUIRE(values.size() == 3);
        CHECK(values[0]->radiance.r == 2);
        CHECK(values[1]->radiance.r == 1);
        CHECK_FALSE(values[2]);
    }
    SUBCASE("fewer are refused") {
        finished.parts[1].refined.pop_back();
        CHECK_THROWS_AS((void)assemble_frame(order, finished), InputError);
    }
}
