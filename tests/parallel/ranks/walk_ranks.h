#pragma once
// Walks through a room, drawn by one process and by ranks that are threads, over a wire that delays
// and reorders.
#include <doctest/doctest.h>

#include <cmath>
#include <deque>
#include <exception>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "core/light/find_light_groups.h"
#include "parallel/ranks/assembly.h"
#include "parallel/ranks/rank_frame_exchange.h"
#include "parallel/walk/cloud_frames.h"
#include "parallel/walk/frame_lead.h"
#include "parallel/walk/scene_caster.h"
#include "tests/parallel/ranks/memory_ranks.h"
#include "tests/test_scene.h"

namespace lightwalk::test::rank_walks {

inline const std::string kRoom = R"(
void plastic grey 0 0 5 .5 .5 .5 0 0
void plastic tiles 0 0 5 .4 .4 .5 .06 0
void plastic satin 0 0 5 .3 .5 .3 .04 .1
void mirror silver 0 0 3 .9 .9 .9
void glass pane 0 0 3 .9 .9 .9
void light lamp 0 0 3 40 40 40
grey polygon back 0 0 12  -4 6 0  4 6 0  4 6 3  -4 6 3
grey polygon left 0 0 12  -4 -6 0  -4 6 0  -4 6 3  -4 -6 3
tiles polygon floor 0 0 12  -4 -6 0  4 -6 0  4 6 0  -4 6 0
silver polygon mirror 0 0 12  -2 5.99 .5  1 5.99 .5  1 5.99 2.5  -2 5.99 2.5
pane polygon window 0 0 12  1.5 3 0  3.5 3 0  3.5 3 2.5  1.5 3 2.5
satin sphere ball 0 0 4 -1.5 2 .7 .7
lamp polygon panel 0 0 12  -1 -1 2.99  -1 1 2.99  1 1 2.99  1 -1 2.99
)";

inline constexpr int kWidth = 61, kHeight = 47;

struct Step {
    View view;
    int width = kWidth, height = kHeight;  ///< of its frame
    LightMixture mixture = {};             ///< of a lit room's light groups
};

inline FrameOptions frame_options(const Step& step) {
    FrameOptions options;
    options.width = step.width;
    options.height = step.height;
    options.pixels.spacing = 1;
    return options;
}

/// Forward, aside and round about: points cross all borders.
inline std::vector<Step> walk(int frames) {
    std::vector<Step> steps(static_cast<std::size_t>(frames));
    for (int i = 0; i < frames; ++i) {
        View& view = steps[static_cast<std::size_t>(i)].view;
        view.position = {0.04 * i, -4 + 0.05 * i, 1.5};
        view.direction = {std::sin(0.03 * i), std::cos(0.03 * i), -0.05 + 0.01 * i};
        view.horizontal = 60;
        view.vertical = 46.8;
    }
    return steps;
}

/// Packets arrive late, and in another order, but for those of one sender. With odd seeds every
/// rank has a machine of its own.
class DelayingCommunicator final : public Communicator {
  public:
    DelayingCommunicator(std::unique_ptr<Communicator> wire, std::uint64_t seed)
        : wire_(std::move(wire)), one_machine_(seed % 2 == 0), random_(seed) {}
    [[nodiscard]] int rank() const override { return wire_->rank(); }
    [[nodiscard]] int size() const override { return wire_->size(); }
    [[nodiscard]] std::string host() const override { return wire_->host(); }
    [[nodiscard]] bool on_one_machine() const override { return one_machine_; }
    [[nodiscard]] int first_on_machine() const override { return one_machine_ ? 0 : rank(); }
    void send(int to, std::string bytes) override { wire_->send(to, std::move(bytes)); }
    [[nodiscard]] std::optional<Packet> receive() override {
        while (std::optional<Packet> packet = wire_->receive())
            held_[packet->from].push_back(std::move(*packet));
        std::erase_if(held_, [](const auto& entry) { return entry.second.empty(); });
        if (held_.empty() || random_() % 3 == 0) return std::nullopt;
        auto sender = held_.begin();
        std::advance(sender, static_cast<std::ptrdiff_t>(random_() % held_.size()));
        Packet packet = std::move(sender->second.front());
        sender->second.pop_front();
        return packet;
    }
    void wait(std::chrono::microseconds) override { wire_->wait(std::chrono::microseconds{50}); }
    void wake() override { wire_->wake(); }
    [[nodiscard]] std::string broadcast(std::string bytes, FunctionRef<void()> meanwhile) override {
        return wire_->broadcast(std::move(bytes), meanwhile);
    }
    void flush() override { wire_->flush(); }
    [[noreturn]] void abort(int status) override {
        wire_->abort(status);
        std::terminate();
    }

  private:
    std::unique_ptr<Communicator> wire_;
    bool one_machine_;
    std::mt19937_64 random_;
    std::map<int, std::deque<Packet>> held_;  ///< by sender
};

struct Room {
    /// @param more  lights; then their groups are kept, too
    /// @param room  of the same surfaces
    explicit Room(const std::string& more = "", const std::string& room = kRoom)
        : scene(room + more) {
        if (!more.empty())
            groups = std::make_shared<const LightGroups>(
                find_light_groups(scene.scene, scene.tracer.options(), {}));
    }
    [[nodiscard]] std::unique_ptr<WorkerContexts> contexts(int workers) {
        auto made = std::make_unique<WorkerContexts>(scene.tracer, scene.warnings, workers);
        if (groups) made->sum_by(groups);
        return made;
    }
    TestScene scene;
    std::shared_ptr<const LightGroups> groups;
    VisibilityProbe visibility{scene.tracer};
    StopFlag stop;
};

inline const std::string kSky = "void glow sky 0 0 4 5 6 8 0\nsky source up 0 0 4 0 0 1 360\n";

inline std::unique_ptr<SceneCaster> rays_of(Room& room, const Step& step,
                                            WorkerContexts& contexts) {
    return std::make_unique<SceneCaster>(room.scene.tracer, room.visibility, Camera(step.view),
                                         frame_options(step), contexts, room.stop,
                                         FrameUse::picture, &step.mixture);
}

/// What a frame of a walk shows, and what it took.
struct Drawn {
    std::vector<PixelValue> values;  ///< row by row from the bottom
    CloudReport report;
};

inline Drawn to_drawn(const CloudFrame& frame) {
    Drawn drawn;
    drawn.report = frame.report;
    for (std::size_t i = 0; i < frame.radiance.size(); ++i)
        drawn.values.push_back({frame.radiance[i], frame.distance[i]});
    return drawn;
}

inline std::vector<Drawn> draw_alone(Room& room, const std::vector<Step>& steps,
                                     const CloudOptions& options) {
    const auto executor = make_executor(ExecutorKind::serial, 1);
    const auto contexts = room.contexts(1);
    CloudFrames frames(kWidth, kHeight, options);
    std::vector<Drawn> result;
    LightMixture mixture;
    for (const Step& step : steps) {
        frames.resize(step.width, step.height);
        if (step.mixture != mixture) (void)frames.mix(mixture = step.mixture);
        const auto rays = rays_of(room, step, *contexts);
        result.push_back(to_drawn(frames.draw(rays->camera(), *rays, *executor, room.stop)));
    }
    return result;
}

struct Company {
    Variant variant = Variant::hybrid;
    int ranks = 3, threads = 1, projectors = 32;
    bool apart = false;  ///< see FrameOrder
};

inline Wires delaying_wires(const Company& company, std::uint64_t seed) {
    Wires wires = make_memory_communicators(company.ranks);
    for (std::size_t rank = 0; rank < wires.size(); ++rank)
        wires[rank] = std::make_unique<DelayingCommunicator>(std::move(wires[rank]),
                                                             2 * (seed * 1000 + rank) + seed % 2);
    return wires;
}

inline AssembledFrame finished_frame(RankLink& link, FrameOrder order) {
    const StopFlag never;
    order.number = link.new_number();
    link.start({order});
    for (;;)
        for (const ProgramNews& news : link.take_news(true, never))
            if (const auto* frame = std::get_if<FinishedFrame>(&news))
                return assemble_frame(order, *frame);
}

inline void check_same(const std::vector<Drawn>& alone, const std::vector<Drawn>& together) {
    REQUIRE(alone.size() == together.size());
    for (std::size_t i = 0; i < alone.size(); ++i) {
        CAPTURE(i);
        CHECK(together[i].values == alone[i].values);
        const CloudReport &a = alone[i].report, &b = together[i].report;
        CHECK(b.reused == a.reused);
        CHECK(b.uncached == a.uncached);
        CHECK(b.points == a.points);
        CHECK(b.tightness == a.tightness);
        CHECK(quantile(b.audit_errors, 0.5) == quantile(a.audit_errors, 0.5));
        CHECK(quantile(b.audit_floors, 0.9) == quantile(a.audit_floors, 0.9));
    }
}

}  // namespace lightwalk::test::rank_walks
