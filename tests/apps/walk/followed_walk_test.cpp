// A walk whose files are edited: it goes on, and at rest its picture is that of the edited files.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "io/picture/picture.h"
#include "tests/apps/walk/steered_walk.h"
#include "tests/temporary_folder.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

/// A room with a ball, a cup far from it, and what else.
std::string house(const std::string& ball = "-1 2 .7 .7", const std::string& colour = ".5 .5 .5",
                  const std::string& more = {}) {
    return "void plastic grey 0 0 5 .5 .5 .5 0 0\nvoid plastic paint 0 0 5 " + colour +
           " 0 0\nvoid light lamp 0 0 3 40 40 40\n" + more + R"(
grey polygon floor 0 0 12  -4 -6 0  4 -6 0  4 6 0  -4 6 0
grey polygon back 0 0 12  -4 6 0  4 6 0  4 6 3  -4 6 3
paint sphere ball 0 0 4 )" +
           ball + R"(
grey sphere cup 0 0 4 2.5 4 .3 .3
lamp polygon panel 0 0 12  -1 -1 2.99  -1 1 2.99  1 1 2.99  1 -1 2.99
)";
}

LoadedFiles load(const std::string& path) {
    SceneSource source;
    source.files = {path};
    LoadedFiles loaded{source, {}, nullptr, std::make_shared<WatchedFiles>(), {}};
    const auto scene =
        read_compiled_scene(source, {}, std::make_shared<FileRecorder>(loaded.files));
    for (const auto& [name, state] : loaded.files->recorded()) loaded.texts.insert(name);
    scene->compile();
    loaded.scene = scene;
    return loaded;
}

/// What is new within a minute.
SceneNews news_of(SceneFollower& follower) {
    for (int i = 0; i < 6000; ++i) {
        if (std::optional<SceneNews> news = follower.take()) return *std::move(news);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    FAIL("the edited file is not followed");
    return {};
}

/// The scene of a file, and a walk in it.
struct FollowedWalk {
    explicit FollowedWalk(const std::string& text)
        : path(folder.write("room.rad", text)),
          loaded(load(path)),
          walk(loaded.scene, options_of(true)),
          follower(loaded) {
        walk.inbox.message(kDriver, view_message(1, 0.25, 64, 48));
        walk.rest();
    }
    SceneNews edit(const std::string& text) {
        folder.write("new.rad", text);
        std::filesystem::rename(folder.path("new.rad"), path);
        return news_of(follower);
    }
    FollowedReply follow(const SceneNews& news) {
        REQUIRE(news.problems.empty());
        REQUIRE(news.scene);
        const FollowedReply reply = walk.loop->follow(news);
        follower.settle(reply.problems.empty());
        CHECK(reply.problems.empty());
        return reply;
    }
    /// Until there is one more final picture.
    std::vector<Rgb> picture_at_rest() {
        walk.clients.frames[kDriver].clear();
        walk.acked[kDriver] = 0;
        walk.rest();
        return read_hdr(walk.saved(), "saved").pixels;
    }

    TemporaryFolder folder;
    std::string path;
    LoadedFiles loaded;
    Walk walk;
    SceneFollower follower;
};

/// That a walk shows which begins in a scene.
std::vector<Rgb> picture_of(const std::string& text) {
    const LoadedScene scene(room(text));
    Walk walk(scene);
    walk.inbox.message(kDriver, view_message(1, 0.25, 64, 48));
    walk.rest();
    return read_hdr(walk.saved(), "saved").pixels;
}

}  // namespace

TEST_CASE("followed walk: another material, in the same geometry, with most points kept") {
    FollowedWalk walk(house());
    const Geometry* geometry = &walk.walk.renderer.backend().session().scene().geometry();
    const SceneNews news = walk.edit(house("-1 2 .7 .7", ".9 .2 .2"));
    CHECK(news.files == std::vector{walk.path});
    CHECK(news.difference.modifiers.size() == 1);
    const FollowedReply reply = walk.follow(news);
    CHECK(&walk.walk.renderer.backend().session().scene().geometry() == geometry);
    CHECK(reply.materials == 1);
    CHECK(reply.surfaces == 0);
    CHECK(reply.files == std::vector<std::string>{"room.rad"});
    CHECK(reply.kept > 0.8);
    CHECK(reply.kept < 1);
    CHECK(walk.picture_at_rest() == picture_of(house("-1 2 .7 .7", ".9 .2 .2")));
    // Edits of the page go on from what the file has now.
    walk.walk.inbox.message(kDriver, nlohmann::json{{"type", "edits"},
                                                    {"id", 1},
                                                    {"materials",
                                                     {{{"name", "paint"},
                                                       {"definition", 0},
                                                       {"kind", "plastic"},
                                                       {"reals", {.1, .8, .1, 0, 0}}}}}}
                                         .dump());
    CHECK(walk.picture_at_rest() == picture_of(house("-1 2 .7 .7", ".1 .8 .1")));
    // They stay when the file is edited once more.
    (void)walk.follow(walk.edit(house("-1 2 .7 .7", ".3 .3 .3")));
    CHECK(walk.picture_at_rest() == picture_of(house("-1 2 .7 .7", ".1 .8 .1")));
}

TEST_CASE("followed walk: a surface that moves, one that comes and one that goes") {
    FollowedWalk walk(house());
    const std::string moved = house("-1 2.2 .7 .7");
    FollowedReply reply = walk.follow(walk.edit(moved));
    CHECK(reply.surfaces == 1);
    CHECK(reply.materials == 0);
    CHECK(reply.kept > 0.3);
    CHECK(reply.kept < 0.99);
    CHECK(walk.picture_at_rest() == picture_of(moved));
    // In front of others in the list: those that stay are known all the same.
    const std::string more = house("-1 2.2 .7 .7", ".5 .5 .5", "grey sphere dot 0 0 4 2 3 .2 .2\n");
    reply = walk.follow(walk.edit(more));
    CHECK(reply.surfaces == 1);
    CHECK(reply.kept > 0.5);
    CHECK(walk.picture_at_rest() == picture_of(more));
    (void)walk.follow(walk.edit(house()));
    CHECK(walk.picture_at_rest() == picture_of(house()));
}

TEST_CASE("followed walk: points of surfaces behind a new one in the list answer the next frame") {
    FollowedWalk walk(house());
    std::vector<std::string>& texts = walk.walk.clients.texts[kDriver];
    (void)walk.follow(
        walk.edit(house("-1 2 .7 .7", ".5 .5 .5", "grey sphere dot 0 0 4 2 3 .1 .1\n")));
    texts.clear();
    (void)walk.picture_at_rest();
    double reuse = 1;  // of the frames that the points are projected to
    for (const std::string& text : texts) {
        const auto message = nlohmann::json::parse(text);
        if (message["type"] == "state") reuse = std::min(reuse, message["reuse"].get<double>());
    }
    CHECK(reuse > 0.5);
    CHECK(reuse < 1);
}

TEST_CASE("followed walk: lamps and suns change all light") {
    const std::string sky = "void light sun 0 0 3 5 5 5\nsun source day 0 0 4 .3 -.5 1 5\n";
    FollowedWalk walk(house());
    FollowedReply reply = walk.follow(walk.edit(house() + sky));
    CHECK(reply.sources == 1);
    CHECK(reply.kept == 0);
    CHECK(walk.picture_at_rest() == picture_of(house() + sky));
    std::string brighter = house() + sky;
    brighter.replace(brighter.find("40 40 40"), 8, "80 40 40");
    reply = walk.follow(walk.edit(brighter));
    CHECK(reply.materials == 1);
    CHECK(reply.kept == 0);
    CHECK(walk.picture_at_rest() == picture_of(brighter));
    // After a source has come surfaces are known by other places.
    const std::string moved = house("-1 2.5 .7 .7") + sky;
    (void)walk.follow(walk.edit(moved));
    CHECK(walk.picture_at_rest() == picture_of(moved));
}

TEST_CASE("followed walk: what is wrong is told with file and line, and gone once it is mended") {
    FollowedWalk walk(house());
    const std::vector<Rgb> before = picture_of(house());
    SceneNews news = walk.edit(house() + "nothing sphere wrong 0 0 4 0 0 0 1\n");
    CHECK_FALSE(news.scene);
    REQUIRE_FALSE(news.problems.empty());
    CHECK(news.problems[0].find("room.rad:10") != std::string::npos);
    walk.follower.settle(false);
    CHECK(read_hdr(walk.walk.saved(), "saved").pixels == before);
    std::filesystem::remove(walk.path);
    news = news_of(walk.follower);
    REQUIRE_FALSE(news.problems.empty());
    CHECK(news.problems[0].find("room.rad") != std::string::npos);
    walk.follower.settle(false);
    news = walk.edit(house());
    CHECK(news.problems.empty());
    CHECK_FALSE(news.scene);  // as it is loaded
    walk.follower.settle(false);
    // What can be read but not be compiled is refused, too.
    news = walk.edit(house("-1 2 .7 .7", ".5 .5"));
    CHECK_FALSE(news.problems.empty());
    walk.follower.settle(false);
    news = walk.edit(house("-1 2 .7 .7", ".2 .2 .2"));
    (void)walk.follow(news);
    CHECK(walk.picture_at_rest() == picture_of(house("-1 2 .7 .7", ".2 .2 .2")));
}

TEST_CASE("followed walk: function files, included ones and those of generators are followed") {
    const TemporaryFolder folder;
    folder.write("dots.cal", "dots = if(Px, 1, .5);\n");
    folder.write("part.rad", "spotted sphere part 0 0 4 1 3 .5 .5\n");
    const std::string path = folder.write(
        "room.rad", "void brightfunc dots 2 dots " + folder.path("dots.cal") +
                        " 0 0\ndots plastic spotted 0 0 5 .5 .5 .5 0 0\n"
                        "void light lamp 0 0 3 40 40 40\n"
                        "!genbox spotted box 1 1 1\n!xform -t 0 1 0 " +
                        folder.path("part.rad") + "\nlamp sphere bulb 0 0 4 0 0 4 .2\n");
    LoadedFiles loaded = load(path);
    SceneFollower follower(loaded);
    folder.write("part.rad", "spotted sphere part 0 0 4 1 3 .75 .5\n");
    SceneNews news = news_of(follower);
    CHECK(news.files == std::vector{folder.path("part.rad")});
    CHECK(news.difference.come.size() == 1);
    CHECK(news.difference.modifiers.empty());
    REQUIRE(news.scene);
    follower.settle(true);
    folder.write("dots.cal", "dots = if(Px, 1, .25);\n");
    news = news_of(follower);
    REQUIRE(news.scene);
    CHECK(news.files == std::vector{folder.path("dots.cal")});
    CHECK(news.difference.modifiers == std::vector<std::size_t>{0});
    CHECK_FALSE(news.all_differs);
    CHECK(&news.scene->scene().geometry() != &loaded.scene->scene().geometry());
    follower.settle(true);
}

TEST_CASE("followed walk: an object file is another one, though the scene names it as before") {
    const TemporaryFolder folder;
    const auto roof = [](const std::string& height) {
        return "usemtl grey\nv 0 0 0\nv 4 0 0\nv 0 4 " + height + "\nf 1 2 3\n";
    };
    folder.write("roof.obj", roof("1"));
    const std::string path =
        folder.write("room.rad",
                     "void plastic grey 0 0 5 .5 .5 .5 0 0\nvoid light lamp 0 0 3 9 9 9\n"
                     "!xform " +
                         folder.path("roof.obj") + "\nlamp sphere bulb 0 0 4 0 0 4 .2\n");
    SceneFollower follower(load(path));
    folder.write("roof.obj", roof("7.5"));
    const SceneNews news = news_of(follower);
    CHECK(news.problems.empty());
    CHECK(news.all_differs);
    REQUIRE(news.scene);
    CHECK(news.scene->scene().geometry().bounds().upper.z == doctest::Approx(7.5).epsilon(1e-3));
    follower.settle(true);
}
