#include "parallel/ranks/cloud_lead.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "core/error.h"
#include "parallel/ranks/piece_codec.h"

using namespace lightwalk;

namespace {

constexpr int kSide = 8;

/// A frame in two parts, one beside the other.
FinishedFrame frame_of(WalkFrameId number) {
    FinishedFrame frame{number, {}};
    for (const int x : {0, kSide / 2}) {
        CloudPart part;
        part.frame = number;
        part.area = {x, 0, x + kSide / 2, kSide};
        std::vector<PixelValue> values(part.area.pixels());
        for (PixelValue& value : values) value = {{static_cast<float>(x), 0, 0}, 1};
        part.pixels = encode_piece(part.area, values);
        part.report.pixels = values.size();
        part.report.reused = static_cast<std::size_t>(10 + x);
        part.report.check_seconds = x;
        part.report.audit_errors = {static_cast<float>(x)};
        part.ages[0] = 100;
        part.ages[3] = 50;
        frame.parts.push_back(std::move(part));
    }
    return frame;
}

}  // namespace

TEST_CASE("a walk's lead: parts in any order are the frame, and the report of all of it") {
    CloudOptions options;
    options.limit = 4;  // 256 points
    CloudLead lead(kSide, kSide, options, 5);
    CloudOrder order = lead.order({}, nullptr, "first");
    CHECK(order.rules.frame == 5);
    CHECK(order.rules.empty);
    FinishedFrame finished = frame_of(5);
    std::reverse(finished.parts.begin(), finished.parts.end());
    const CloudFrame frame = lead.take(finished);
    CHECK(frame.radiance[kSide / 2 - 1].r == 0);
    CHECK(frame.radiance[kSide / 2].r == kSide / 2);
    CHECK(frame.report.pixels == std::size_t{kSide} * kSide);
    CHECK(frame.report.reused == 20 + kSide / 2);
    CHECK(frame.report.check_seconds == kSide / 2);
    CHECK(frame.report.audit_errors == std::vector<float>{0, kSide / 2});
    CHECK(frame.report.points == 256);
    order = lead.order({}, nullptr, "second");
    CHECK(order.rules.frame == 6);
    CHECK(!order.rules.empty);
    CHECK(order.rules.room.age == 3);  // 200 of age 0, and 44 of the 100 others must go
    CHECK(order.rules.room.share > 0);
}

TEST_CASE("a walk's lead: parts that do not make the frame are refused") {
    const auto refused = [](FinishedFrame finished) {
        CloudLead lead(kSide, kSide, {}, 0);
        (void)lead.order({}, nullptr, "");
        CHECK_THROWS_AS((void)lead.take(finished), InputError);
    };
    refused(frame_of(1));
    FinishedFrame bad = frame_of(0);
    bad.parts.pop_back();
    refused(bad);
    bad = frame_of(0);
    bad.parts[1].area.x1 += 1;
    refused(bad);
    bad = frame_of(0);
    bad.parts[1].pixels.resize(3);
    refused(bad);
}

TEST_CASE("a walk's lead: pixels that there was no time for are filled from around") {
    CloudLead lead(kSide, kSide, {}, 0);
    (void)lead.order({}, nullptr, "");
    FinishedFrame finished = frame_of(0);
    CloudPart& part = finished.parts[1];
    std::vector<PixelValue> values(part.area.pixels(), {{7, 7, 7}, 1});
    values[9] = {{0, 0, 0}, -1};
    part.pixels = encode_piece(part.area, values);
    part.report.filled = 1;
    const CloudFrame frame = lead.take(finished);
    const std::size_t at = 2 * kSide + kSide / 2 + 1;  // the tenth of four a row
    CHECK(frame.radiance[at].g > 3);
    CHECK(frame.distance[at] == 0);
}

TEST_CASE(
    "a walk's lead: a frame whose view turns out to rest is refined once its origins are known") {
    CloudOptions options;
    options.refine = 1;
    CloudLead lead(kSide, kSide, options, 0);
    const View view;
    (void)lead.order(view, nullptr, "");
    (void)lead.take(frame_of(0));
    CHECK(lead.progressive() == nullptr);
    const CloudOrder ask = lead.ask_origins("");
    CHECK(ask.rests);
    CHECK(ask.rest_follows);
    CHECK(ask.refined.empty());
    FinishedFrame told = frame_of(1);
    for (CloudPart& part : told.parts)
        part.origins.assign(part.area.pixels(), {PixelOrigin::Kind::filled, 0, 0});
    SUBCASE("it is") {
        lead.take_origins(told);
        REQUIRE(lead.progressive() != nullptr);
        CHECK(lead.progressive()->open_pixels() == std::size_t{kSide} * kSide);
        const CloudOrder order = lead.order(view, nullptr, "");
        CHECK(order.rests);
        CHECK(order.leaves);
        CHECK(order.refined.size() == std::size_t{kSide} * kSide);
    }
    SUBCASE("origins of fewer pixels are refused") {
        told.parts[1].origins.pop_back();
        CHECK_THROWS_AS(lead.take_origins(told), InputError);
    }
}

TEST_CASE("a walk's lead: pixels that are traced beside the frames come in the order of the work") {
    CloudLead lead(kSide, kSide, {}, 0);
    const ProgressiveWork work{3, {{kSide - 1, 0}, {0, 0}, {kSide - 2, 1}}};
    const CloudOrder order = lead.trace(work, "light");
    CHECK(order.sample == 3);
    CHECK_FALSE(order.leaves);
    CHECK(order.payload == "light");
    FinishedFrame finished = frame_of(0);
    finished.parts[0].refined = {{{1, 1, 1}, 5}};
    finished.parts[1].refined = {{{2, 2, 2}, 6}, {{}, -1}};
    SUBCASE("they do") {
        const std::vector<PixelValue> values = lead.take_traced(finished);
        REQUIRE(values.size() == 3);
        CHECK(values[0].radiance.r == 2);
        CHECK(values[1].radiance.r == 1);
        CHECK(values[2].distance < 0);
        CHECK(lead.next() == 1);
    }
    SUBCASE("fewer are refused") {
        finished.parts[1].refined.pop_back();
        CHECK_THROWS_AS((void)lead.take_traced(finished), InputError);
    }
}
