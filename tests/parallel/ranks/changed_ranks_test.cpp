// A walk's scene that changes under the frames that ranks draw.
#include <doctest/doctest.h>

#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/parallel/ranks/walk_ranks.h"

using namespace lightwalk;
using namespace lightwalk::test;
using namespace lightwalk::test::rank_walks;

namespace {

/// A walk through one room that becomes another one of the same surfaces before a frame.
struct Change {
    Room &before, &after;
    const ShownMaterials* outdated = nullptr;  ///< null: all points
    std::size_t at = 3;
};

struct ChangedWalk {
    std::vector<Drawn> frames;
    std::size_t points = 0, kept = 0;   ///< of those that the change found
    std::vector<std::string> problems;  ///< of one that could not be
};

ChangedWalk draw_changed_alone(const Change& change, const std::vector<Step>& steps,
                               const CloudOptions& options) {
    const auto executor = make_executor(ExecutorKind::serial, 1);
    ChangedWalk walk;
    std::optional<CloudFrames> frames(std::in_place, kWidth, kHeight, options);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        Room& room = i < change.at ? change.before : change.after;
        if (i == change.at && change.outdated != nullptr) {
            walk.points = frames->points().size();
            (void)frames->drop(*change.outdated);
            walk.kept = frames->points().size();
        } else if (i == change.at) {
            frames.emplace(kWidth, kHeight, options);
        }
        const auto contexts = room.contexts(1);
        const auto rays = rays_of(room, steps[i], *contexts);
        walk.frames.push_back(to_drawn(frames->draw(rays->camera(), *rays, *executor, room.stop)));
    }
    return walk;
}

/// On rank 0: all ranks prepare a change, and take it where each can.
void change_together(RankLink& link, ChangeOrder order, ChangedWalk& walk) {
    const StopFlag never;
    order.number = link.new_number();
    link.start({order});
    std::vector<PreparedChange> said;
    while (said.size() < link.topology().workers.size())
        for (const ProgramNews& news : link.take_news(true, never))
            if (const auto* notice = std::get_if<RankNotice>(&news))
                said.push_back(std::get<PreparedChange>(notice->notice.notice));
    order.step = ChangeOrder::Step::take;
    for (const PreparedChange& one : said) {
        CHECK(one.number == order.number);
        walk.points += one.points;
        walk.kept += one.kept_points;
        if (one.problem.empty()) continue;
        walk.problems.push_back(one.problem);
        order.step = ChangeOrder::Step::drop;
    }
    link.start({order});
}

void lead_changed(RankLink& link, const Change& change, const std::vector<Step>& steps,
                  const CloudOptions& options, ChangedWalk& walk) {
    const auto executor = make_executor(ExecutorKind::serial, 1);
    std::optional<FrameLead> lead(std::in_place, kWidth, kHeight, options, 0);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        ChangeOrder order;
        if (i + 1 == change.at) {
            order.payload = "one that cannot be";
            change_together(link, order, walk);
        }
        if (i == change.at) {
            order.payload = "another";
            if (change.outdated != nullptr) {
                order.shown = change.outdated->flags();
                lead->abandon();
            } else {
                lead.emplace(kWidth, kHeight, options, 0);
            }
            change_together(link, order, walk);
        }
        AssembledFrame drawn = finished_frame(link, lead->order(steps[i].view, std::to_string(i)));
        lead->complete(drawn.frame, drawn.refined, *executor, drawn.refined_groups);
        walk.frames.push_back(to_drawn(drawn.frame));
    }
}

ChangedWalk draw_changed_together(const Change& change, const std::vector<Step>& steps,
                                  const CloudOptions& options, const Company& company,
                                  std::uint64_t seed) {
    RankSettings settings;
    settings.slots = company.threads;
    settings.projectors = company.projectors;
    ChangedWalk walk;
    const int last = company.ranks - 1;
    const auto draw = [&](RankLink& link) {
        const auto of_before = change.before.contexts(company.threads);
        const auto of_after = change.after.contexts(company.threads);
        bool prepared = false, taken = false;
        WalkScene scene;
        scene.make_rays = [&](const FrameOrder& order) {
            return rays_of(taken ? change.after : change.before,
                           steps.at(static_cast<std::size_t>(std::stoi(order.payload))),
                           taken ? *of_after : *of_before);
        };
        scene.prepare = [&](const std::string& payload) {
            if (payload == "one that cannot be" && link.rank() == last)
                throw InputError("no such paint here");
            prepared = true;
        };
        scene.take = [&](FrameNumber) {
            taken = prepared;
            return std::size_t{0};
        };
        scene.drop = [&] { prepared = false; };
        std::thread program;
        if (link.leads()) {
            program = std::thread([&] {
                lead_changed(link, change, steps, options, walk);
                link.dismiss();
            });
        }
        const auto executor = make_executor(ExecutorKind::threads, company.threads);
        if (link.traces())
            draw_frames(link, options, scene, *executor, change.before.stop);
        else
            link.inbox().wait_for_end(change.before.stop);
        if (program.joinable()) program.join();
        link.end_work();
    };
    CHECK(all_well(run_ranks(make_topology(company.variant, company.ranks, false, 1), settings,
                             draw, delaying_wires(company, seed))));
    return walk;
}

}  // namespace

TEST_CASE("a walk by ranks whose scene changes is that of one process, whatever is outdated") {
    std::string painted = kRoom;
    painted.replace(painted.find(".3 .5 .3 .04 .1"), 3, ".9 ");
    REQUIRE(painted != kRoom);
    Room before, after("", painted);
    const Scene& scene = before.scene.scene;
    std::vector<bool> satin(scene.modifier_count());
    for (std::size_t i = 0; i < satin.size(); ++i)
        satin[i] = scene.modifier(ModifierId{static_cast<std::int32_t>(i)}).name == "satin";
    const ShownMaterials ball(scene, satin);
    const std::vector<Step> steps = walk(6);
    CloudOptions options;
    options.limit = 9;  // there is room for all points
    for (const ShownMaterials* outdated : {static_cast<const ShownMaterials*>(nullptr), &ball}) {
        const Change change{before, after, outdated};
        const ChangedWalk alone = draw_changed_alone(change, steps, options);
        CHECK_FALSE(alone.frames[3].values == draw_alone(before, steps, options)[3].values);
        const CloudReport& report = alone.frames[3].report;
        if (outdated == nullptr)
            CHECK(report.reused == 0);
        else
            CHECK(report.reused > report.pixels / 2);
        std::uint64_t seed = 20;
        for (const Company& company : {Company{Variant::hybrid, 3, 2}, Company{Variant::ranks, 5},
                                       Company{Variant::hybrid, 4, 1, 2}}) {
            CAPTURE(company.ranks);
            const ChangedWalk together =
                draw_changed_together(change, steps, options, company, ++seed);
            CHECK(together.problems == std::vector<std::string>{"no such paint here"});
            check_same(alone.frames, together.frames);
            CHECK(together.points == alone.points);
            CHECK(together.kept == alone.kept);
        }
    }
}
