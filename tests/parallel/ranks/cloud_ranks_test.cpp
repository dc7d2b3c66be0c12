// Frames of a walk drawn by ranks that are threads, over a wire that delays and reorders.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/parallel/ranks/walk_ranks.h"

using namespace lightwalk;
using namespace lightwalk::test;
using namespace lightwalk::test::rank_walks;

namespace {

/// The program of rank 0.
std::vector<Drawn> lead(RankLink& link, const std::vector<Step>& steps, const CloudOptions& options,
                        bool apart) {
    const auto executor = make_executor(ExecutorKind::serial, 1);
    const auto finished = [&](FrameOrder order) {
        order.apart = apart;
        return finished_frame(link, std::move(order));
    };
    std::vector<Drawn> result;
    FrameLead walk(kWidth, kHeight, options, 0);
    CloudFrame last;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const std::string payload = std::to_string(i);
        walk.resize(steps[i].width, steps[i].height);
        if (i > 0 && steps[i].mixture != steps[i - 1].mixture && !walk.mix(steps[i].mixture))
            walk.abandon();
        if (walk.rests(steps[i].view) && walk.wants_origins())
            walk.begin_progressive(last, finished(walk.origins_order(payload)).frame.origins);
        AssembledFrame drawn = finished(walk.order(steps[i].view, payload));
        walk.complete(drawn.frame, drawn.refined, *executor, drawn.refined_groups);
        last = std::move(drawn.frame);
        result.push_back(to_drawn(last));
    }
    return result;
}

std::vector<Drawn> draw_together(Room& room, const std::vector<Step>& steps,
                                 const CloudOptions& options, const Company& company,
                                 std::uint64_t seed) {
    RankSettings settings;
    settings.slots = company.threads;
    settings.projectors = company.projectors;
    std::vector<Drawn> result;
    const auto draw = [&](RankLink& link) {
        const auto contexts = room.contexts(company.threads);
        const auto make = [&](const FrameOrder& order) {
            return rays_of(room, steps.at(static_cast<std::size_t>(std::stoi(order.payload))),
                           *contexts);
        };
        std::thread program;
        if (link.leads()) {
            program = std::thread([&] {
                result = lead(link, steps, options, company.apart);
                link.dismiss();
            });
        }
        const auto executor = make_executor(ExecutorKind::threads, company.threads);
        if (link.traces())
            draw_frames(link, options, {make}, *executor, room.stop);
        else
            link.inbox().wait_for_end(room.stop);
        if (program.joinable()) program.join();
        link.end_work();
    };
    CHECK(all_well(run_ranks(make_topology(company.variant, company.ranks, false, 1), settings,
                             draw, delaying_wires(company, seed))));
    return result;
}

}  // namespace

TEST_CASE("ranks draw the frames of a walk that one process does, whatever the wire does") {
    Room room;
    const std::vector<Step> steps = walk(5);
    CloudOptions options;
    options.audit = 0.2;
    options.audit_limit = 0.001;
    const std::vector<Drawn> alone = draw_alone(room, steps, options);
    CHECK(alone.back().report.reused > alone.back().report.pixels / 2);
    std::uint64_t seed = 1;
    for (const Company& company :
         {Company{Variant::hybrid, 1, 2}, Company{Variant::hybrid, 2, 1},
          Company{Variant::ranks, 3}, Company{Variant::ranks, 7}, Company{Variant::hybrid, 3, 2}}) {
        CAPTURE(company.ranks);
        check_same(alone, draw_together(room, steps, options, company, ++seed));
    }
}

TEST_CASE(
    "ranks draw frames of another size from the points of those before, as one process does") {
    Room room;
    std::vector<Step> steps = walk(5);
    for (const std::size_t small : {2, 3}) {
        steps[small].width = kWidth / 2;
        steps[small].height = kHeight / 2;
    }
    const CloudOptions options;
    const std::vector<Drawn> alone = draw_alone(room, steps, options);
    CHECK(alone[2].report.reused > alone[2].report.pixels / 2);
    CHECK(alone[4].report.reused > alone[4].report.pixels / 4);
    check_same(alone, draw_together(room, steps, options, {Variant::hybrid, 3}, 8));
    check_same(alone, draw_together(room, steps, options, {Variant::ranks, 4}, 9));
}

TEST_CASE("a walk is the same where only some ranks keep points, and where most own nothing") {
    Room room;
    const std::vector<Step> steps = walk(4);
    const CloudOptions options;
    const std::vector<Drawn> alone = draw_alone(room, steps, options);
    check_same(alone,
               draw_together(room, steps, options, {Variant::hybrid, 5, 1, /*projectors=*/2}, 3));
    check_same(alone, draw_together(room, steps, options, {Variant::ranks, 4, 1, 1}, 4));
}

TEST_CASE("a walk is the same where each owner traces its own uncached pixels") {
    Room room;
    std::vector<Step> steps = walk(5);
    steps.insert(steps.end(), 4, steps.back());  // at rest
    CloudOptions options;
    options.audit = 0.2;
    options.audit_limit = 0.001;
    const std::vector<Drawn> alone = draw_alone(room, steps, options);
    check_same(alone, draw_together(room, steps, options, {Variant::hybrid, 3, 2, 32, true}, 3));
    check_same(alone, draw_together(room, steps, options, {Variant::ranks, 4, 1, 32, true}, 4));
    check_same(alone, draw_together(room, steps, options, {Variant::hybrid, 5, 1, 2, true}, 5));
}

TEST_CASE("a walk by ranks is the same in every mode") {
    Room room;
    const std::vector<Step> steps = walk(4);
    for (const CloudCheck check : {CloudCheck::rotating, CloudCheck::edges, CloudCheck::none}) {
        CloudOptions options;
        options.check = check;
        options.supersaturated = check == CloudCheck::none;
        options.rules.look_back = check != CloudCheck::none;
        check_same(draw_alone(room, steps, options),
                   draw_together(room, steps, options, {Variant::hybrid, 4}, 5));
    }
}

TEST_CASE("a walk by ranks keeps no more points than one process does for want of room") {
    Room room;
    const std::vector<Step> steps = walk(8);
    CloudOptions options;
    options.limit = 1.4;
    options.audit = 0.5;
    const std::vector<Drawn> alone = draw_alone(room, steps, options);
    const std::vector<Drawn> together =
        draw_together(room, steps, options, {Variant::hybrid, 3}, 6);
    for (std::size_t i = 0; i < alone.size(); ++i) {
        CHECK(together[i].values == alone[i].values);
        CHECK(alone[i].report.points <= options.most_points(kWidth, kHeight));
    }
}

TEST_CASE("a walk by ranks with a budget misses no pixel") {
    Room room;
    const std::vector<Step> steps = walk(3);
    CloudOptions options;
    options.budget = 1e-9;
    for (const Drawn& drawn : draw_together(room, steps, options, {Variant::hybrid, 3, 2}, 7)) {
        const CloudReport& report = drawn.report;
        std::size_t traced = 0;
        for (const std::size_t count : report.uncached) traced += count;
        CHECK(report.pixels == drawn.values.size());
        CHECK(report.reused + report.filled + traced == report.pixels);
        CHECK(traced > 0);
        CHECK(report.filled > 0);
        for (const PixelValue& value : drawn.values) CHECK(value.distance >= 0);
    }
}

TEST_CASE("a walk by ranks is dimmed as one process's is, in motion and at rest") {
    Room room(kSky);
    REQUIRE(room.groups->size() == 2);
    std::vector<Step> steps = walk(5);
    steps.insert(steps.end(), 9, steps.back());  // at rest, until each pixel is traced, and on
    const LightMixture evening{{{1.5F, 1, .4F}, {.1F, .1F, .2F}}}, night{{{.2F, .1F, .1F}, {}}};
    for (const std::size_t i : {2, 3, 4, 5, 6, 7, 8, 9}) steps[i].mixture = evening;
    for (const std::size_t i : {10, 11, 12, 13}) steps[i].mixture = night;
    CloudOptions options;
    options.refine = 0.4;
    options.limit = 9;  // there is room for all points
    SUBCASE("as pictures") {}
    SUBCASE("as what is seen for a moment only, and traced again at rest") {
        options.budget = 1000;
    }
    options.light_groups = room.groups->size();
    const std::vector<Drawn> alone = draw_alone(room, steps, options);
    for (const std::size_t i : {3, 11})  // most is from points, and from pixels at rest
        CHECK(alone[i].report.reused > alone[i].report.pixels / 2);
    const auto blue = [](const Drawn& drawn) {
        double sum = 0;
        for (const PixelValue& value : drawn.values) sum += static_cast<double>(value.radiance.b);
        return sum;
    };
    CHECK(blue(alone[4]) < .5 * blue(draw_alone(room, walk(5), options)[4]));
    CHECK(blue(alone[10]) < .3 * blue(alone[9]));
    const auto refined = static_cast<std::size_t>(TraceCause::refined);
    if (options.budget > 0) CHECK(alone[10].report.uncached[refined] > 0);  // it goes on
    check_same(alone, draw_together(room, steps, options, {Variant::hybrid, 3}, 10));
    check_same(alone, draw_together(room, steps, options, {Variant::ranks, 5}, 11));
    check_same(alone, draw_together(room, steps, options, {Variant::ranks, 4, 1, 1}, 12));
}

TEST_CASE("a walk by ranks whose view stands still becomes ever better, as by one process") {
    Room room;
    std::vector<Step> steps = walk(3);
    steps.insert(steps.end(), 4, steps.back());
    steps.push_back(walk(4).back());
    CloudOptions options;
    options.refine = 0.4;
    options.audit = 0.1;
    const std::vector<Drawn> alone = draw_alone(room, steps, options);
    CHECK(alone[6].report.uncached[static_cast<std::size_t>(TraceCause::refined)] > 0);
    check_same(alone, draw_together(room, steps, options, {Variant::hybrid, 3}, 8));
    check_same(alone, draw_together(room, steps, options, {Variant::ranks, 5}, 9));
}

TEST_CASE("a walk by ranks whose view leaves no points goes on with its pixels where it rests") {
    // Antimatter, in which what is seen depends on all that the ray has passed: nothing is reused.
    Room room("", kRoom + "void antimatter hole 1 grey 0 0\nhole sphere far 0 0 4 0 90 0 1\n");
    std::vector<Step> steps = walk(2);
    steps.insert(steps.end(), 4, steps.back());
    CloudOptions options;
    options.refine = 0.4;
    const std::vector<Drawn> alone = draw_alone(room, steps, options);
    CHECK(alone.back().report.points == 0);
    check_same(alone, draw_together(room, steps, options, {Variant::hybrid, 3}, 13));
}
