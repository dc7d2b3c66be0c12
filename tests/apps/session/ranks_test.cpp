// Renderers on ranks that are threads of this process.
#include "apps/session/lightwalk/ranks.h"

#include <doctest/doctest.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "apps/session/render_backend.h"
#include "io/files/file_source.h"
#include "parallel/walk/live_frames.h"
#include "parallel/walk/live_walk.h"
#include "tests/apps/session/room.h"
#include "tests/temporary_folder.h"

using namespace lightwalk;
using lightwalk::test::kLampRoom;
using lightwalk::test::task_at;
using lightwalk::test::TemporaryFolder;

namespace {

struct Company {
    int ranks = 3, threads = 1;
    RankOptions options;
};

/// How a run ended.
struct Ended {
    std::vector<std::string> problems;  ///< by rank: what Ranks::run() threw
    std::string failure;                ///< what was told of a rank that could not go on
};

/// Runs `body(ranks, options)` on each of several ranks.
Ended on_ranks(const Company& company, const RendererOptions& work,
               const std::function<void(Ranks&, const RendererOptions&)>& body) {
    auto wires = make_memory_communicators(company.ranks);
    Ended ended;
    ended.problems.resize(wires.size());
    std::mutex mutex;  // guards it
    std::vector<std::thread> threads;
    for (std::size_t rank = 0; rank < wires.size(); ++rank) {
        threads.emplace_back([&, rank] {
            std::string problem;
            try {
                RendererOptions own = work;
                own.threads = company.threads;
                own.executor = ExecutorKind::threads;
                RankOptions options = company.options;
                options.failed = [&](const std::string& message) {
                    const std::lock_guard lock(mutex);
                    ended.failure = message;
                };
                Ranks ranks(*wires[rank], options, own);
                ranks.run([&] { body(ranks, own); });
            } catch (const Aborted&) {
                problem = "aborted";
            } catch (const InputError& error) {
                problem = std::string("error: ") + error.what();
            }
            const std::lock_guard lock(mutex);
            ended.problems[rank] = problem;
        });
    }
    for (std::thread& thread : threads) thread.join();
    return ended;
}

bool all_well(const Ended& ended) {
    return ended.failure.empty() &&
           ended.problems == std::vector<std::string>(ended.problems.size());
}

SceneSource room(const TemporaryFolder& folder) {
    SceneSource source;
    source.files = {folder.write("room.rad", kLampRoom)};
    source.threads = 1;
    return source;
}

RendererOptions plain_light() {
    RendererOptions options;
    options.threads = 2;
    options.light.ambient_value = {.1f, .1f, .1f};
    return options;
}

using Pictures = std::vector<std::vector<Rgb>>;

/// Two at once, as far as the renderer goes ahead.
Pictures pictures_of(Renderer& renderer, const std::vector<double>& places) {
    Pictures pictures;
    std::vector<Ticket<RenderedPicture>> tickets;
    for (const double x : places) tickets.push_back(renderer.start(task_at(x)));
    for (const auto& ticket : tickets) {
        const auto picture = renderer.finish(ticket);
        REQUIRE(picture);
        pictures.push_back(picture->radiance);
    }
    return pictures;
}

std::vector<Company> companies() {
    std::vector<Company> all(4);
    all[0].options.variant = Variant::ranks;
    all[1].ranks = 5;
    all[1].options.variant = Variant::ranks;
    all[1].options.scene_from = SceneFrom::rank0;
    all[2].ranks = 1;
    all[2].threads = 2;
    all[3].ranks = 2;
    all[3].threads = 2;
    all[3].options.scene_from = SceneFrom::each;
    return all;
}

}  // namespace

TEST_CASE("ranks: a renderer makes the pictures of one process, one after the other") {
    const TemporaryFolder folder;
    const SceneSource source = room(folder);
    Renderer alone(LoadedScene(source), plain_light());
    const std::vector<double> places{0, .5, 1};
    const Pictures expected = pictures_of(alone, places);
    for (const Company& company : companies()) {
        CAPTURE(company.ranks);
        Pictures together;
        std::uint64_t rays = 0;
        std::size_t reports = 0;
        std::string timeline;
        Company watched = company;
        watched.options.keep_spans = true;
        CHECK(all_well(
            on_ranks(watched, plain_light(), [&](Ranks& ranks, const RendererOptions& options) {
                Renderer renderer = ranks.open({source, options, {}, {}, {}});
                renderer.run([&] { together = pictures_of(renderer, places); });
                if (!ranks.leads()) return;
                const RunStatistics statistics = renderer.backend().statistics();
                rays = statistics.rays.primary;
                reports = statistics.reports.size();
                timeline = timeline_json(statistics.reports);
                CHECK(statistics_json(statistics).find("per_rank") != std::string::npos);
            })));
        CHECK(together == expected);
        CHECK(rays >= alone.backend().statistics().rays.primary);
        CHECK(reports == static_cast<std::size_t>(company.ranks));
        CHECK(timeline.find("\"trace\"") != std::string::npos);
    }
}

TEST_CASE("ranks: indirect light that is found in rounds is that of one process") {
    const TemporaryFolder folder;
    const SceneSource source = room(folder);
    RendererOptions options = plain_light();
    options.light.ambient_bounces = 1;
    options.light.ambient_divisions = 32;
    options.light.ambient_super_samples = 0;
    options.deterministic = true;
    Renderer alone(LoadedScene(source), options);
    const Pictures expected = pictures_of(alone, {0, .5});
    for (const Company& company : companies()) {
        CAPTURE(company.ranks);
        Pictures together;
        CHECK(all_well(on_ranks(company, options, [&](Ranks& ranks, const RendererOptions& own) {
            Renderer renderer = ranks.open({source, own, {}, {}, {}});
            renderer.run([&] { together = pictures_of(renderer, {0, .5}); });
        })));
        CHECK(together == expected);
    }
}

TEST_CASE("ranks: rank 0 keeps the values that all have found, and all begin with those it has") {
    const TemporaryFolder folder;
    const SceneSource source = room(folder);
    RendererOptions options = plain_light();
    options.light.ambient_bounces = 1;
    options.light.ambient_divisions = 32;
    options.light.ambient_super_samples = 0;
    options.ambient_file = folder.path("room.amb");
    const auto computed = [&](int number) {
        std::uint64_t sum = 0;
        Company company;
        company.ranks = number;
        CHECK(all_well(on_ranks(company, options, [&](Ranks& ranks, const RendererOptions& own) {
            Renderer renderer = ranks.open({source, own, {}, {}, {}});
            renderer.run([&] { (void)pictures_of(renderer, {0}); });
            if (ranks.leads()) sum = renderer.backend().statistics().ambient.computed;
        })));
        return sum;
    };
    const std::uint64_t first = computed(3);
    CHECK(first > 0);
    CHECK(computed(4) < first / 2);
    CHECK(computed(1) < first / 2);
}

TEST_CASE("ranks: scenes follow each other, and one that cannot be read ends nothing") {
    const TemporaryFolder folder;
    const SceneSource good = room(folder);
    SceneSource bad = good;
    bad.files = {
        folder.write("bad.rad", "void plastic grey 0 0 3 .5 .5 .5\ngrey sphere a 0 0 4 0 0 0 1\n")};
    RendererOptions walk = plain_light();
    walk.reuse = default_reuse();
    walk.light.ambient_bounces = 1;
    for (const bool steered : {false, true}) {
        CAPTURE(steered);
        walk.steered = steered;
        for (const Company& company : companies()) {
            CAPTURE(company.ranks);
            std::atomic<int> drawn{0}, refused{0};
            std::string text;
            const auto enter = [&](Ranks& ranks, const RendererOptions& options) {
                for (const SceneSource& source : {good, bad, good}) {
                    CHECK(ranks.tell(ranks.leads() ? "load" : "") == "load");
                    try {
                        Renderer renderer = ranks.open({source, options, {}, {}, {}});
                        renderer.run([&] {
                            renderer.backend().frames().begin(40, 30, false);
                            for (int i = 0; i < 3; ++i) {
                                const StopFlag never;
                                const WalkFrame frame = renderer.backend().frames().draw(
                                    task_at(.1 * i).view, 0, .1, never);
                                drawn += frame.frame.complete ? 1 : 0;
                            }
                        });
                    } catch (const InputError& error) {
                        ++refused;
                        if (ranks.leads()) text = error.what();
                    }
                }
            };
            CHECK(all_well(on_ranks(company, walk, enter)));
            CHECK(drawn == 6);
            CHECK(refused == company.ranks);
            CHECK(text.find("bad.rad:1") != std::string::npos);
            CHECK(text.find("bad.rad:1") == text.rfind("bad.rad:1"));
        }
    }
}

namespace {

/// A view at rest. @param drafted  counts if a draft of indirect light was shown before
std::vector<Rgb> picture_at_rest(LiveWalk& walk, int& drafted) {
    const StopFlag never;
    bool draft = false;
    for (int i = 0; i < 1000; ++i) {
        REQUIRE(walk.next(task_at(.2).view, 40, 30, WalkAmbient::rest, .05, never));
        if (!draft && walk.picture().inferred == 1) {
            draft = true;
            ++drafted;
        }
        if (walk.picture().phase == WalkPhase::done) return walk.picture().radiance;
    }
    FAIL("the view does not come to rest");
    return {};
}

RendererOptions steered_light() {
    RendererOptions options = plain_light();
    options.steered = true;
    CloudOptions cloud = *default_reuse();
    cloud.samples = 1;
    options.reuse = std::make_shared<const CloudOptions>(cloud);
    return options;
}

/// Other numbers for a modifier of a scene.
ModelChange edited(const Model& model, const std::string& name, std::vector<double> reals) {
    ModelChange change = unchanged(model);
    for (Primitive& modifier : change.modifiers)
        if (modifier.name == name) modifier.reals = reals;
    return change;
}

const std::vector<double> kGreen{.1, .7, .3, .02, .1}, kOff{0, 0, 0};

/// The pictures at rest of a scene as it was read, and with other materials, one after the other.
Pictures changed_pictures(Renderer& renderer, int& drafted) {
    RenderBackend& backend = renderer.backend();
    const Model& model = backend.session().compiled().model();
    LiveWalk walk(backend.frames(), 1);
    Pictures pictures{picture_at_rest(walk, drafted)};
    for (const ModelChange& change :
         {edited(model, "grey", kGreen), edited(model, "lamp", kOff), unchanged(model)}) {
        backend.change_model(change);
        walk.look_anew();
        pictures.push_back(picture_at_rest(walk, drafted));
    }
    return pictures;
}

}  // namespace

TEST_CASE("ranks: the scene of a walk changes on all of them, and back") {
    const TemporaryFolder folder;
    const SceneSource source = room(folder);
    RendererOptions options = steered_light();
    bool cached = false;
    SUBCASE("by direct light") {}
    SUBCASE("with indirect light") {
        options.light.ambient_bounces = 1;
        options.light.ambient_divisions = 32;
        options.light.ambient_super_samples = 0;
        SUBCASE("of each pixel") {
            options.light.ambient_accuracy = 0;
        }
        SUBCASE("that ranks tell each other") {
            cached = true;
            options.light.ambient_value = {};
        }
    }
    SUBCASE("in light groups") {
        options.light_groups.emplace();
    }
    Renderer alone(LoadedScene(source), options);
    int drafted = 0;
    const Pictures expected = changed_pictures(alone, drafted);
    CHECK(drafted == (options.light.ambient_bounces > 0 ? 4 : 0));
    CHECK_FALSE(expected[0] == expected[1]);
    for (const Company& company : companies()) {
        CAPTURE(company.ranks);
        Pictures together;
        int drafts = 0;
        CHECK(all_well(on_ranks(company, options, [&](Ranks& ranks, const RendererOptions& own) {
            Renderer renderer = ranks.open({source, own, {}, {}, {}});
            renderer.run([&] { together = changed_pictures(renderer, drafts); });
            if (ranks.leads()) CHECK(renderer.backend().statistics().rays.primary > 4 * 40 * 30);
        })));
        CHECK(drafts == drafted);
        REQUIRE(together.size() == expected.size());
        // Values that are cached depend on which rank was first; but without lamps only one
        // of a scene before could bring anything.
        const std::size_t exact = cached ? 2 : 0;
        for (std::size_t i = exact; i < (cached ? 3 : expected.size()); ++i) {
            CAPTURE(i);
            CHECK(together[i] == expected[i]);
        }
    }
}

TEST_CASE("ranks: a change that one rank cannot make is told, and all go on as they were") {
    /// Files of which one cannot be read.
    class FaultyFiles final : public FileSource {
      public:
        [[nodiscard]] std::optional<std::string> answer(Question question, const std::string& text,
                                                        std::size_t limit) override {
            if (text.ends_with("spots.cal")) throw InputError("the disk of this rank is broken");
            return real_files()->answer(question, text, limit);
        }
    };
    const TemporaryFolder folder;
    SceneSource source = room(folder);
    source.library = {folder.path()};
    source.files.push_back(folder.write("more.rad", R"(
void brightfunc pattern 2 1 . 0 0
pattern plastic spotted 0 0 5 .5 .5 .5 0 0
spotted sphere other 0 0 4 2 2 .7 .7
)"));
    folder.write("spots.cal", "spots = frac(Px);\n");
    const auto spotted = [](const Model& model) {
        ModelChange change = unchanged(model);
        for (Primitive& modifier : change.modifiers)
            if (modifier.name == "pattern") modifier.strings = {"spots", "spots.cal"};
        return change;
    };
    const RendererOptions options = steered_light();
    for (const Company& company : companies()) {
        if (company.ranks == 1 || company.options.scene_from == SceneFrom::rank0) continue;
        for (const bool leader : {false, true}) {
            Company own_files = company;
            own_files.options.scene_from = SceneFrom::each;
            CAPTURE(company.ranks);
            CAPTURE(leader);
            std::string problem;
            Pictures pictures;
            int drafts = 0;
            CHECK(all_well(
                on_ranks(own_files, options, [&](Ranks& ranks, const RendererOptions& own) {
                    RendererRequest request{source, own, {}, {}, {}};
                    const bool faulty = leader ? ranks.leads() : !ranks.leads();
                    if (faulty) request.files = std::make_shared<FaultyFiles>();
                    Renderer renderer = ranks.open(request);
                    renderer.run([&] {
                        RenderBackend& backend = renderer.backend();
                        LiveWalk walk(backend.frames(), 1);
                        pictures.push_back(picture_at_rest(walk, drafts));
                        try {
                            backend.change_model(spotted(backend.session().compiled().model()));
                        } catch (const InputError& error) {
                            problem = error.what();
                        }
                        walk.look_anew();
                        pictures.push_back(picture_at_rest(walk, drafts));
                    });
                })));
            CHECK(problem.find("the disk of this rank is broken") != std::string::npos);
            CHECK((problem.find("rank ") == 0) == !leader);
            REQUIRE(pictures.size() == 2);
            CHECK(pictures[0] == pictures[1]);
        }
    }
}

TEST_CASE("ranks: lists of rays are answered as by one process") {
    const TemporaryFolder folder;
    const SceneSource source = room(folder);
    RendererOptions options = plain_light();
    options.answers_rays = true;
    RayTask list;
    for (int i = 0; i < 300; ++i) list.rays.push_back({{0, -5, 1.5}, {0.004 * i - 0.6, 1, -0.3}});
    Renderer alone(LoadedScene(source), options);
    const auto expected = alone.finish(alone.start(list));
    REQUIRE(expected);
    for (const Company& company : companies()) {
        CAPTURE(company.ranks);
        std::string bytes;
        CHECK(all_well(on_ranks(company, options, [&](Ranks& ranks, const RendererOptions& own) {
            Renderer renderer = ranks.open({source, own, {}, {}, {}});
            renderer.run([&] {
                std::vector<Ticket<RayBytes>> tickets;
                for (std::size_t first = 0; first < list.rays.size();) {
                    const RayDemand demand = renderer.ray_demand(true);
                    if (demand.lists == 0) continue;
                    const std::size_t end = std::min(list.rays.size(), first + 50);
                    const auto at = list.rays.begin();
                    tickets.push_back(
                        renderer.start(RayTask{{at + static_cast<std::ptrdiff_t>(first),
                                                at + static_cast<std::ptrdiff_t>(end)},
                                               first}));
                    first = end;
                }
                for (const auto& ticket : tickets) bytes += renderer.finish(ticket)->bytes;
            });
        })));
        CHECK(bytes == expected->bytes);
    }
}

TEST_CASE("ranks: what goes wrong while a picture is traced is told with its rank, to the caller") {
    const TemporaryFolder folder;
    SceneSource source = room(folder);
    source.files.push_back(folder.write("late.rad", R"(
void brightfunc missing 2 nothing nowhere.cal 0 0
missing plastic lost 0 0 5 .5 .5 .5 0 0
lost sphere near 0 0 4 0 -3 1.5 .5
)"));
    for (const Company& company : companies()) {
        CAPTURE(company.ranks);
        const Ended ended =
            on_ranks(company, plain_light(), [&](Ranks& ranks, const RendererOptions& own) {
                Renderer renderer = ranks.open({source, own, {}, {}, {}});
                renderer.run([&] { (void)renderer.finish(renderer.start(task_at(0))); });
            });
        CHECK(ended.failure.find("lightwalk: rank ") == 0);
        CHECK(ended.failure.find("nowhere.cal") != std::string::npos);
        CHECK(ended.problems ==
              std::vector<std::string>(static_cast<std::size_t>(company.ranks), "aborted"));
    }
}

TEST_CASE("ranks: fewer than the roles need are refused, and so are ranks with other options") {
    Company company;
    company.ranks = 1;
    company.options.variant = Variant::ranks;
    const Ended few = on_ranks(company, plain_light(), [](Ranks&, const RendererOptions&) {});
    CHECK(few.problems[0].find("at least 2 ranks") != std::string::npos);
    const TemporaryFolder folder;
    const SceneSource source = room(folder);
    auto wires = make_memory_communicators(2);
    std::vector<std::string> texts(2);
    std::vector<std::thread> threads;
    for (std::size_t rank = 0; rank < 2; ++rank)
        threads.emplace_back([&, rank] {
            RankOptions options;
            Ranks ranks(*wires[rank], options, plain_light());
            try {
                ranks.run([&] {
                    (void)ranks.open(
                        {source, plain_light(), rank == 0 ? "-ab 1" : "-ab 2", {}, {}});
                });
            } catch (const InputError& error) {
                texts[rank] = error.what();
            }
        });
    for (std::thread& thread : threads) thread.join();
    CHECK(texts[0] ==
          "lightwalk: rank 1 (memory): options: -ab 2, but rank 0 (memory) has options: -ab 1");
    CHECK(texts[1].empty());
}
