#include "apps/walk/client_inbox.h"

#include <doctest/doctest.h>

#include <chrono>
#include <string>
#include <thread>

#include "core/error.h"
#include "tests/apps/walk/recorded_clients.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

constexpr ClientId kFirst{1}, kSecond{2}, kThird{3};
constexpr std::chrono::milliseconds kNow{0};

struct Inbox {
    Inbox() { inbox.attach(clients); }
    void join(ClientId client) {
        inbox.opened(client);
        inbox.message(client, hello("0123456789abcde" + std::to_string(static_cast<int>(client))));
    }
    RecordedClients clients;
    ClientInbox inbox{WelcomeReply{}};
};

}  // namespace

TEST_CASE("inbox: who says hello is welcomed, and the first one drives") {
    Inbox all;
    CHECK_THROWS_AS(all.inbox.message(kFirst, view_message(1, 0)), InputError);
    all.join(kFirst);
    all.join(kSecond);
    CHECK(all.clients.got(kFirst, "welcome", "\"driver\":true"));
    CHECK(all.clients.got(kSecond, "welcome", "\"driver\":false"));
    CHECK_THROWS_AS(all.inbox.message(kFirst, hello()), InputError);
    const InboxContents contents = all.inbox.pop(kNow);
    CHECK(contents.joined == std::vector<ClientId>{kFirst, kSecond});
    CHECK_FALSE(contents.wish.view);
}

TEST_CASE("inbox: of the driver's views the newest counts and stays, those of watchers do not") {
    Inbox all;
    all.join(kFirst);
    all.join(kSecond);
    all.inbox.message(kFirst, view_message(1, 0.5));
    all.inbox.message(kFirst, view_message(2, 0.75));
    all.inbox.message(kSecond, view_message(9, 3));
    for (int i = 0; i < 2; ++i) {  // also when nothing is new
        const InboxContents contents = all.inbox.pop(kNow);
        REQUIRE(contents.wish.view);
        CHECK(contents.wish.view->id == 2);
        CHECK(contents.wish.view->view.position.x == 0.75);
    }
}

TEST_CASE("inbox: a view that cannot be drawn is refused, and the walk stays where it is") {
    Inbox all;
    const auto changed = [](const std::string& from, const std::string& to) {
        std::string text = view_message(7, 3);
        REQUIRE(text.find(from) != std::string::npos);
        return text.replace(text.find(from), from.size(), to);
    };
    const std::string down = changed("[0,1,-0.05]", "[0,0,-1]"),
                      far = changed("[3.000000,", "[3e9,"),
                      nowhere = changed("[3.000000,", "[null,");
    CHECK_THROWS_AS(all.inbox.message(kFirst, down), InputError);  // before hello
    all.join(kFirst);
    all.join(kSecond);
    all.inbox.message(kFirst, view_message(1, 0.5));
    for (const std::string& text : {down, far, nowhere}) {
        all.clients.texts.clear();
        all.inbox.message(kFirst, text);
        CHECK(all.clients.got(kFirst, "refused", "The view cannot be drawn: "));
        CHECK(all.clients.got(kFirst, "refused", "\"view\":7"));
        CHECK(all.inbox.pop(kNow).wish.view->id == 1);
    }
    CHECK_THROWS_AS(all.inbox.message(kFirst, changed("[3.000000,", "[\"a\",")), InputError);
}

TEST_CASE("inbox: questions come to whoever draws once, and beyond 64 they are refused") {
    Inbox all;
    all.join(kFirst);
    all.join(kSecond);
    const std::string pick = R"({"type":"pick","id":7,"x":0.5,"y":0.5})";
    for (int i = 0; i < 65; ++i) all.inbox.message(kSecond, pick);
    CHECK(all.inbox.pop(kNow).questions.size() == 64);
    CHECK(all.inbox.pop(kNow).questions.empty());
    CHECK(all.clients.got(kSecond, "refused", "too many requests"));
}

TEST_CASE("inbox: the wheel is handed over, and free when the driver leaves") {
    Inbox all;
    for (const ClientId client : {kFirst, kSecond, kThird}) all.join(client);
    all.inbox.message(kSecond, R"({"type":"take"})");
    CHECK(all.clients.got(kSecond, "refused", "somebody else drives"));
    all.inbox.message(kFirst, R"({"type":"hand","to":2})");
    all.inbox.message(kSecond, view_message(4, 1));
    CHECK(all.inbox.pop(kNow).wish.view->id == 4);
    all.inbox.closed(kSecond);
    CHECK(all.inbox.pop(kNow).left == std::vector<ClientId>{kSecond});
    all.inbox.message(kThird, R"({"type":"take"})");
    all.inbox.message(kThird, view_message(5, 1));
    CHECK(all.inbox.pop(kNow).wish.view->id == 5);
}

TEST_CASE("inbox: what becomes of the scene is told to all who are there, and to those who come") {
    Inbox all;
    all.join(kFirst);
    all.inbox.announce(walk_text(LoadingReply{"reading a.rad", 0.1}));
    all.inbox.announce(walk_text(FailedReply{{"a.rad:3: wrong"}}));
    CHECK(all.clients.got(kFirst, "loading", "reading a.rad"));
    CHECK(all.clients.got(kFirst, "failed", "a.rad:3: wrong"));
    all.join(kSecond);
    CHECK(all.clients.got(kSecond, "failed", "a.rad:3: wrong"));
    CHECK_FALSE(all.clients.got(kSecond, "loading"));
    all.inbox.tell_watchers("watch");
    CHECK(all.clients.texts[kSecond].back() == "watch");
    CHECK(all.clients.texts[kFirst].back() != "watch");
}

TEST_CASE("inbox: a picture is saved by whoever draws, other files are not there") {
    Inbox all;
    unsigned status = 0;
    const auto keep = [&](const WebAnswer& answer) { status = answer.status; };
    all.inbox.save("/save/else.hdr", WebReply(keep));
    CHECK(status == 404);
    all.inbox.save("/save/picture.hdr", WebReply(keep));
    const InboxContents contents = all.inbox.pop(kNow);
    REQUIRE(contents.saves.size() == 1);
    contents.saves[0]({200, "", "", ""});
    CHECK(status == 200);
}

TEST_CASE("inbox: who waits wakes up when something comes, and at the latest when told") {
    Inbox all;
    all.join(kFirst);
    (void)all.inbox.pop(kNow);
    CHECK(all.inbox.pop(std::chrono::milliseconds(1)).acks.empty());
    std::thread page([&] { all.inbox.message(kFirst, R"({"type":"ack","frame":12})"); });
    std::vector<WalkAck> acks = all.inbox.pop(std::chrono::seconds(60)).acks;
    page.join();
    REQUIRE(acks.size() == 1);
    CHECK(acks[0].frame == 12);
    all.inbox.message(kFirst, R"({"type":"ack","frame":13})");
    CHECK(all.inbox.pop_acks().size() == 1);
    CHECK(all.inbox.pop_acks().empty());
}
