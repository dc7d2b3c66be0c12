#include "apps/walk/walk_screen.h"

#include <doctest/doctest.h>

#include <chrono>
#include <vector>

#include "tests/apps/walk/recorded_clients.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

constexpr ClientId kDriving{1}, kWatching{2};
constexpr int kScreenWidth = 400, kScreenHeight = 200;  // six pieces

LivePicture picture_of(float value) {
    LivePicture picture;
    picture.width = kScreenWidth;
    picture.height = kScreenHeight;
    picture.radiance.assign(std::size_t{kScreenWidth} * kScreenHeight, Rgb::grey(value));
    return picture;
}

/// A screen at a clock of its own, with colours that do not adapt.
struct Screen {
    Screen() {
        inbox.attach(clients);
        fixed.settings.automatic = false;
        join(kDriving);
    }
    void join(ClientId client) {
        InboxContents news;
        news.joined = {client};
        screen.update_clients(news);
    }
    void leave(ClientId client) {
        InboxContents news;
        news.left = {client};
        screen.update_clients(news);
    }
    void show(const LivePicture& picture, std::uint32_t id, bool at_rest = true) {
        screen.show(picture, fixed, {id, {0, 0, 1}, at_rest, false}, now);
    }
    void send() { screen.send(inbox, now); }
    void ack(ClientId client) {
        now += std::chrono::milliseconds(10);
        const WalkAck all[] = {{client, frame_number(*clients.frames[client].back()), now}};
        screen.acked(all);
    }
    const std::string& last(ClientId client) { return *clients.frames[client].back(); }

    std::unique_ptr<Executor> executor = make_executor(ExecutorKind::serial, 1);
    WalkScreen screen{*executor};
    RecordedClients clients;
    ClientInbox inbox{WelcomeReply{}};
    DisplayRequest fixed;
    WalkScreen::Time now{std::chrono::seconds(100)};
};

}  // namespace

TEST_CASE("walk screen: the first frame has all pieces, and what is the same is not sent again") {
    Screen all;
    all.send();
    CHECK(all.clients.frames_of(kDriving) == 0);  // there is no picture yet
    all.show(picture_of(0.5f), 1);
    all.send();
    REQUIRE(all.clients.frames_of(kDriving) == 1);
    CHECK(frame_pieces(all.last(kDriving)) == 6);
    CHECK(frame_flags(all.last(kDriving)) == 3);  // whole, at rest
    all.ack(kDriving);
    all.show(picture_of(0.5f), 1);
    all.send();
    CHECK(all.clients.frames_of(kDriving) == 1);
}

TEST_CASE("walk screen: only pieces that have changed are sent, a new view also without any") {
    Screen all;
    LivePicture picture = picture_of(0.5f);
    all.show(picture, 1);
    all.send();
    all.ack(kDriving);
    picture.radiance[0] = Rgb::grey(0.1f);
    picture.radiance.back() = Rgb::grey(0.1f);
    all.show(picture, 1);
    all.send();
    REQUIRE(all.clients.frames_of(kDriving) == 2);
    CHECK(frame_pieces(all.last(kDriving)) == 2);
    CHECK(frame_flags(all.last(kDriving)) == 2);
    all.ack(kDriving);
    all.show(picture, 2);
    all.send();
    REQUIRE(all.clients.frames_of(kDriving) == 3);
    CHECK(frame_pieces(all.last(kDriving)) == 0);
    CHECK(number_at<std::uint32_t>(all.last(kDriving), 8) == 2);
}

TEST_CASE("walk screen: clients that lack the same share a frame, newcomers get all of it") {
    Screen all;
    all.join(kWatching);
    all.show(picture_of(0.5f), 1);
    all.send();
    REQUIRE(all.clients.frames_of(kWatching) == 1);
    CHECK(all.clients.frames[kDriving][0] == all.clients.frames[kWatching][0]);
    all.leave(kWatching);
    all.join(kWatching);
    all.send();
    CHECK(all.clients.frames_of(kDriving) == 1);
    REQUIRE(all.clients.frames_of(kWatching) == 2);
    CHECK(frame_pieces(all.last(kWatching)) == 6);
}

TEST_CASE(
    "walk screen: a client that does not answer gets no more than two frames, then the newest") {
    Screen all;
    for (int i = 1; i <= 5; ++i) {
        all.now += std::chrono::seconds(1);
        all.show(picture_of(0.1f * static_cast<float>(i)), static_cast<std::uint32_t>(i), false);
        all.send();
    }
    CHECK(all.clients.frames_of(kDriving) <= 2);
    const std::size_t before = all.clients.frames_of(kDriving);
    all.ack(kDriving);
    all.send();
    REQUIRE(all.clients.frames_of(kDriving) == before + 1);
    CHECK(number_at<std::uint32_t>(all.last(kDriving), 8) == 5);
}

TEST_CASE("walk screen: moving frames have no more pixels than the slowest link carries in time") {
    Screen all;
    CHECK(all.screen.most_moving_pixels() > 1e9);  // nothing is known
    all.show(picture_of(0.5f), 1);
    all.send();
    const double bytes = static_cast<double>(all.last(kDriving).size());
    all.ack(kDriving);  // 10 ms later
    CHECK(all.screen.most_moving_pixels() == doctest::Approx(100 * bytes * 0.2 / 0.45));
    all.join(kWatching);
    all.send();
    all.now += std::chrono::seconds(1);
    all.ack(kWatching);
    CHECK(all.screen.most_moving_pixels() < bytes);
}

TEST_CASE("walk screen: a picture of another size is sent whole") {
    Screen all;
    all.show(picture_of(0.5f), 1);
    all.send();
    all.ack(kDriving);
    LivePicture small;
    small.width = 10;
    small.height = 8;
    small.radiance.assign(80, Rgb::grey(0.5f));
    all.show(small, 1);
    all.send();
    REQUIRE(all.clients.frames_of(kDriving) == 2);
    CHECK(frame_pieces(all.last(kDriving)) == 1);
    CHECK(number_at<std::uint16_t>(all.last(kDriving), 12) == 10);
}

TEST_CASE(
    "walk screen: depth goes to who wants it, with each new distance, and others get the bytes of "
    "before") {
    Screen all;
    InboxContents news;
    news.joined = {kWatching};
    news.want_depth = {kWatching};
    all.screen.update_clients(news);
    LivePicture picture = picture_of(0.5f);
    picture.distance.assign(picture.radiance.size(), 2);
    const auto show = [&](std::uint32_t id, const View& view) {
        all.screen.measure_depth(picture, view, 1.6);
        all.show(picture, id);
        all.send();
        all.ack(kDriving);
        all.ack(kWatching);
    };
    show(1, View{});
    CHECK(frame_pieces(all.last(kDriving)) == 6);
    CHECK(frame_pieces(all.last(kWatching)) == 7);
    CHECK(frame_flags(all.last(kWatching)) == 3);  // whole
    show(2, View{});
    CHECK(frame_pieces(all.last(kWatching)) == 0);
    picture.distance[7] = 3;
    show(3, View{});
    CHECK(frame_pieces(all.last(kDriving)) == 0);
    REQUIRE(frame_pieces(all.last(kWatching)) == 1);
    CHECK(all.last(kWatching).substr(48, 9) == std::string("\0\0\0\0\x90\1\xc8\0\3", 9));
    CHECK(frame_flags(all.last(kWatching)) == 2);
    View around;
    around.type = 'a';
    show(4, around);  // of no use to a page: the piece is empty
    REQUIRE(frame_pieces(all.last(kWatching)) == 1);
    CHECK(all.last(kWatching).size() == 48 + 16);
}

TEST_CASE("walk screen: who comes later gets no depth of an earlier picture") {
    Screen all;
    const auto join_with_depth = [&] {
        InboxContents news;
        news.joined = news.want_depth = {kWatching};
        all.screen.update_clients(news);
    };
    LivePicture picture = picture_of(0.5f);
    picture.distance.assign(picture.radiance.size(), 2);
    const auto show = [&] {
        all.screen.measure_depth(picture, View{}, 1.6);
        all.show(picture, 1);
        all.send();
    };
    join_with_depth();
    show();
    CHECK(all.screen.all_want_depth() == false);
    REQUIRE(all.clients.frames_of(kWatching) == 1);
    all.leave(kWatching);
    picture.width /= 2;
    picture.radiance.resize(picture.radiance.size() / 2);
    picture.distance.resize(picture.radiance.size());
    show();
    join_with_depth();
    all.send();  // before the next picture
    REQUIRE(all.clients.frames_of(kWatching) == 2);
    const std::string& frame = all.last(kWatching);
    const std::string depth = frame.substr(frame.size() - 16);
    CHECK(number_at<std::uint16_t>(depth, 4) == kScreenWidth / 2);
    CHECK(depth[8] == 3);                             // what it is: depth
    CHECK(number_at<std::uint32_t>(depth, 12) == 0);  // bytes
}

TEST_CASE(
    "walk screen: luminance goes to who wants it, with or without depth, and each frame tells "
    "which colours it has") {
    Screen all;
    InboxContents news;
    news.joined = news.want_luminance = {kWatching};
    all.screen.update_clients(news);
    LivePicture picture = picture_of(0.5f);
    picture.distance.assign(picture.radiance.size(), 2);
    bool here = true;
    const auto show = [&](std::uint32_t id, std::uint8_t display) {
        all.fixed.number = display;
        all.screen.measure_depth(picture, View{}, 1.6);
        all.show(picture, id);
        all.send();
        all.ack(kDriving);
        if (here) all.ack(kWatching);
    };
    show(1, 7);
    CHECK(frame_pieces(all.last(kDriving)) == 6);
    CHECK(frame_pieces(all.last(kWatching)) == 7);
    CHECK(frame_flags(all.last(kWatching)) == 3);  // whole
    CHECK(number_at<std::uint8_t>(all.last(kWatching), 17) == 7);
    show(2, 8);
    CHECK(frame_pieces(all.last(kWatching)) == 0);
    CHECK(number_at<std::uint8_t>(all.last(kWatching), 17) == 8);
    picture.radiance[7] = Rgb::grey(1000);  // far above what is white
    show(3, 8);
    REQUIRE(frame_pieces(all.last(kWatching)) == 2);  // of the picture one, and all luminance
    all.leave(kWatching);
    here = false;
    show(4, 8);
    news.want_depth = {kWatching};
    all.screen.update_clients(news);
    here = true;
    show(5, 8);
    CHECK(frame_pieces(all.last(kWatching)) == 8);
}

TEST_CASE("walk screen: one that follows another has its exposure, whatever its own picture is") {
    Screen lead, all;
    lead.fixed.settings.automatic = all.fixed.settings.automatic = true;
    CHECK_FALSE(all.screen.is_outdated());
    lead.show(picture_of(0.5f), 1);
    lead.send();
    all.screen.follow(&lead.screen, nullptr);
    CHECK(all.screen.is_outdated());
    all.show(picture_of(0.01f), 1);
    all.send();
    CHECK_FALSE(all.screen.is_outdated());
    const auto exposure = [](Screen& of) { return number_at<float>(of.last(kDriving), 20); };
    CHECK(exposure(all) == exposure(lead));
    lead.show(picture_of(0.25f), 1);
    CHECK(all.screen.is_outdated());
    all.screen.follow(nullptr, nullptr);
    CHECK_FALSE(all.screen.is_outdated());
}

TEST_CASE("walk screen: a difference is that of luminances, at the same place of the picture") {
    // Whatever a picture shows, its difference from itself is the same.
    const auto bytes_of = [](const LivePicture& before, const LivePicture& now) {
        Screen lead, all;
        lead.show(before, 1);
        all.screen.follow(&lead.screen, &before);
        all.show(now, 1);
        all.send();
        return all.last(kDriving).substr(48);  // without the header, which has the exposure
    };
    const LivePicture grey = picture_of(0.5f), dark = picture_of(0.03f);
    CHECK(bytes_of(grey, grey) == bytes_of(dark, dark));
    CHECK(bytes_of(grey, dark) != bytes_of(grey, grey));
    CHECK(bytes_of(dark, picture_of(0.06f)) == bytes_of(grey, picture_of(1)));
    // Also from a smaller picture, as moving views have.
    LivePicture halves = grey, small = grey;
    small.width = 40;
    small.height = 20;
    small.radiance.resize(800);
    for (int y = 0; y < kScreenHeight; ++y)
        for (int x = 0; x < kScreenWidth / 2; ++x)
            halves.radiance[static_cast<std::size_t>(y) * kScreenWidth +
                            static_cast<std::size_t>(x)] = Rgb::grey(0.1f);
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 20; ++x)
            small.radiance[static_cast<std::size_t>(y * 40 + x)] = Rgb::grey(0.1f);
    CHECK(bytes_of(small, halves) == bytes_of(grey, grey));
}
