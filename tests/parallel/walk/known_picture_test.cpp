#include "parallel/walk/known_picture.h"

#include <doctest/doctest.h>

#include <vector>

#include "core/error.h"
#include "parallel/walk/frame_lead.h"
#include "parallel/walk/frame_loop.h"
#include "tests/one_thread.h"
#include "tests/parallel/walk/cloud_room.h"

using namespace lightwalk;
using lightwalk::test::one_thread;
using namespace lightwalk::test::cloud_room;

TEST_CASE(
    "cloud: what another process has left of a picture is reused as if it had been drawn here" *
    one_thread) {
    Room room;
    const auto executor = make_executor(ExecutorKind::serial, 1);
    WorkerContexts contexts(room.scene.tracer, room.scene.warnings, 1);
    const auto draw = [&](FrameLoop& loop, const FrameOrder& order, const View& view) {
        SceneCaster caster(room.scene.tracer, room.visibility, Camera(view), frame_options(),
                           contexts, room.stop);
        NoFrameExchange alone;
        REQUIRE(loop.draw(order, caster.camera(), caster, alone, *executor, room.stop));
        return loop.drawn(order).frame();
    };
    const View before = view_at(0, 0, 0), after = view_at(0.05, 0, 0.02);
    std::vector<PixelValue> known;
    for (const TracedPixel& pixel : room.truth(before))
        known.push_back({pixel.radiance, pixel.distance});
    FrameLead lead(kWidth, kHeight, {}, 0);
    FrameLoop loop({});
    const std::size_t left = draw(loop, lead.recall_order(known, {}), before).report.points;
    const std::size_t pixels = known.size();
    CHECK(left > pixels / 3);  // none of the mirror and the polished floor
    CHECK(left < pixels);
    lead.recalled(true);
    const CloudFrame frame = draw(loop, lead.order(after, {}), after);
    CHECK(frame.report.reused > left * 8 / 10);
    FrameLoop usual({});  // in one process
    FrameLead usual_lead(kWidth, kHeight, {}, 0);
    CloudFrame drawn = draw(usual, usual_lead.order(before, {}), before);
    usual_lead.complete(drawn, {}, *executor);
    drawn = draw(usual, usual_lead.order(after, {}), after);
    const std::vector<TracedPixel> truth = room.truth(after);
    CHECK(off_by_a_tenth(frame.radiance, truth) <=
          off_by_a_tenth(drawn.radiance, truth) + pixels / 200);

    for (PixelValue& value : known) value.distance *= 1.1f;  // of surfaces that are not there
    FrameLoop other({});
    CHECK(draw(other, lead.recall_order(known, {}), before).report.points == 0);
    for (PixelValue& value : known) value.distance = 0;
    CHECK(draw(other, lead.recall_order(known, {}), before).report.points == 0);
    known.pop_back();
    CHECK_THROWS_AS(draw(other, lead.recall_order(known, {}), before), InputError);
}
