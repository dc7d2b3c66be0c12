// What clients do to a web server, and that nobody else notices.
#include <doctest/doctest.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "tests/io/net/running_server.h"
#include "tests/io/net/web_client.h"

using namespace lightwalk;
using namespace lightwalk::test;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

namespace {

/// A client that minds its own business, and must be able to go on doing so.
class Neighbour {
  public:
    explicit Neighbour(RunningServer& server) : client_(server.port()) {
        REQUIRE(client_.status() == 101);
        REQUIRE(server.handler.wait(1, 0));
        id_ = *server.handler.open().begin();
    }
    [[nodiscard]] ClientId id() const { return id_; }
    [[nodiscard]] bool is_well() {
        const std::string text = "still here " + std::to_string(++said_);
        return client_.send(text) && client_.receive() == "echo " + text;
    }

  private:
    WebClient client_;
    ClientId id_{};
    int said_ = 0;
};

/// The client beside the neighbour.
ClientId other_than(const Neighbour& neighbour, const RunningServer& server) {
    for (const ClientId id : server.handler.open()) {
        if (id != neighbour.id()) return id;
    }
    return {};
}

}  // namespace

TEST_CASE("web abuse: a malformed message closes its sender alone, with the reason") {
    RunningServer server;
    Neighbour neighbour(server);
    WebClient client(server.port());
    REQUIRE(client.send("fine"));
    CHECK(client.receive() == "echo fine");
    REQUIRE(client.send("wrong"));
    CHECK(client.receive() == R"({"reason":"malformed: wrong","type":"bye"})");
    CHECK_FALSE(client.receive());
    CHECK(client.close_code() == 1008);
    CHECK(client.close_reason() == "malformed: wrong");
    CHECK(server.handler.wait(1, 1));
    CHECK(neighbour.is_well());
}

TEST_CASE("web abuse: messages that are binary, too large or no UTF-8 close their sender alone") {
    RunningServer server;
    Neighbour neighbour(server);
    WebClient binary(server.port()), large(server.port()), garbled(server.port());
    CHECK(binary.send_binary("bytes"));
    (void)binary.receive_all();
    CHECK(binary.close_code() == 1003);
    CHECK(large.send(std::string(64 * 1024, 'x')));
    CHECK(large.receive()->size() == 64 * 1024 + 5);
    (void)large.send(std::string(64 * 1024 + 1, 'x'));
    (void)large.receive_all();
    CHECK(large.close_code() == 1009);
    (void)garbled.send("\xff\xfe");
    (void)garbled.receive_all();
    CHECK(garbled.close_code() == 1007);
    CHECK(server.handler.wait(1, 3));
    CHECK(neighbour.is_well());
}

TEST_CASE("web abuse: bytes that are no WebSocket frames close their sender alone") {
    RunningServer server;
    Neighbour neighbour(server);
    {
        BareSocket client(server.port());
        REQUIRE(client.send(upgrade_text(server.port())));
        REQUIRE(server.handler.wait(2, 0));
        (void)client.send(std::string(1000, '\xff'));
        (void)client.receive(milliseconds(5000));
        CHECK(client.closed());
    }
    CHECK(server.handler.wait(1, 1));
    CHECK(neighbour.is_well());
}

TEST_CASE("web abuse: more messages or pings than the limit close their sender alone") {
    WebLimits limits;
    limits.messages_per_second = 20;
    limits.messages_at_once = 30;
    RunningServer server(limits);
    Neighbour neighbour(server);
    for (const bool pings : {false, true}) {
        CAPTURE(pings);
        WebClient client(server.port());
        int sent = 0;
        for (; sent < 200; ++sent) {
            if (!(pings ? client.ping() : client.send("again"))) break;
        }
        const std::size_t echoes = client.receive_all().size();
        CHECK(client.close_code() == 1008);
        CHECK(client.close_reason() == "too many messages");
        if (!pings) CHECK((echoes >= 30 && echoes < 100));
        CHECK(neighbour.is_well());
    }
    CHECK(server.handler.wait(1, 2));
}

TEST_CASE("web abuse: so many clients are taken, and when one leaves the next") {
    WebLimits limits;
    limits.clients = 2;
    RunningServer server(limits);
    Neighbour neighbour(server);
    {
        WebClient second(server.port());
        REQUIRE(second.status() == 101);
        CHECK(WebClient(server.port()).status() == 503);
        CHECK(neighbour.is_well());
    }
    REQUIRE(server.handler.wait(1, 1));
    CHECK(WebClient(server.port()).status() == 101);
    CHECK(neighbour.is_well());
}

TEST_CASE("web abuse: a reader who leaves too much waiting is cut off, its neighbour reads on") {
    WebLimits limits;
    limits.silence = milliseconds(60'000);
    RunningServer server(limits);
    Neighbour neighbour(server);
    SUBCASE("texts") {
        const WebClient deaf(server.port(), {}, "/walk", 4096);
        REQUIRE(server.handler.wait(2, 0));
        const ClientId id = other_than(neighbour, server);
        // The kernel takes some megabytes before anything waits.
        for (int i = 0; i < 1000 && server.handler.open().size() == 2; ++i) {
            server->send_text(id, std::string(50'000, 'x'));
            CHECK(neighbour.is_well());
        }
        CHECK(server.handler.wait(1, 1));
    }
    SUBCASE("frames") {
        const WebClient deaf(server.port(), {}, "/walk", 4096);
        REQUIRE(server.handler.wait(2, 0));
        const ClientId id = other_than(neighbour, server);
        const auto frame = std::make_shared<const std::string>(20'000'000, 'x');
        for (int i = 0; i < 4; ++i) server->send_binary(id, frame);
        CHECK(neighbour.is_well());
        CHECK(server.handler.open().size() == 2);
        server->send_binary(id, frame);
        CHECK(server.handler.wait(1, 1));
        for (int i = 0; i < 1000 && frame.use_count() > 1; ++i) {
            std::this_thread::sleep_for(milliseconds(10));
        }
        CHECK(frame.use_count() == 1);  // nothing keeps it any more
    }
    CHECK(neighbour.is_well());
}

TEST_CASE("web abuse: sockets that say nothing, or half a request, are closed in time") {
    WebLimits limits;
    limits.request = milliseconds(300);
    RunningServer server(limits);
    Neighbour neighbour(server);
    const auto begin = steady_clock::now();
    BareSocket silent(server.port()), half(server.port());
    REQUIRE(half.send("GET / HTTP/1.1\r\nHost: loc"));
    CHECK(silent.receive(milliseconds(5000)).empty());
    CHECK(silent.closed());
    CHECK(half.receive(milliseconds(5000)).empty());
    CHECK(half.closed());
    const auto taken = steady_clock::now() - begin;
    CHECK(taken >= milliseconds(250));
    CHECK(taken < milliseconds(30000));
    BareSocket dripping(server.port());  // a byte now and then does not help
    for (int i = 0; i < 100 && !dripping.closed(); ++i) {
        if (!dripping.send("G")) break;
        (void)dripping.receive(milliseconds(50));
    }
    CHECK(dripping.closed());
    CHECK(steady_clock::now() - begin < milliseconds(30000));
    CHECK(neighbour.is_well());
}

TEST_CASE("web abuse: a WebSocket that answers no ping is closed, one that only listens is not") {
    WebLimits limits;
    limits.silence = milliseconds(600);
    RunningServer server(limits);
    WebClient listener(server.port());
    REQUIRE(server.handler.wait(1, 0));
    const ClientId id = *server.handler.open().begin();
    BareSocket dead(server.port()), rude(server.port());
    REQUIRE(dead.send(upgrade_text(server.port())));
    REQUIRE(rude.send(upgrade_text(server.port())));
    REQUIRE(server.handler.wait(3, 0));
    REQUIRE(rude.send(std::string(1000, '\xff')));  // and does not leave
    std::thread later([&] {
        std::this_thread::sleep_for(milliseconds(1500));
        server->send_text(id, "at last");
    });
    CHECK(listener.receive() == "at last");  // answers pings while it waits
    later.join();
    CHECK(server.handler.wait(1, 2));
    (void)dead.receive(milliseconds(5000));
    CHECK(dead.closed());
}

TEST_CASE("web abuse: a client that will not take its farewell is cut off") {
    WebLimits limits;
    limits.close_timeout = milliseconds(300);
    RunningServer server(limits);
    BareSocket client(server.port());
    REQUIRE(client.send(upgrade_text(server.port())));
    REQUIRE(server.handler.wait(1, 0));
    server->close(*server.handler.open().begin(), "enough");
    CHECK(server.handler.wait(0, 1));  // at once for the program
    const std::string received = client.receive(milliseconds(5000));
    CHECK(received.find("enough") != std::string::npos);
    CHECK(client.closed());
}

TEST_CASE("web abuse: two hundred connections at once, and a walk goes on") {
    WebLimits limits;
    limits.connections = 64;
    limits.request = milliseconds(3000);
    RunningServer server(limits);
    Neighbour neighbour(server);
    std::vector<BareSocket> crowd;
    for (int i = 0; i < 200; ++i) {
        crowd.emplace_back(server.port());
        if (i % 20 == 0) CHECK(neighbour.is_well());
    }
    int refused = 0;
    for (std::size_t i = 0; i < 200; ++i) {
        if (i < 63) continue;  // those who got in, beside the neighbour
        (void)crowd[i].receive(milliseconds(5000));
        refused += crowd[i].closed() ? 1 : 0;
    }
    CHECK(refused == 137);
    CHECK(neighbour.is_well());
    // Those who got in say nothing, and are not waited for.
    int cut_off = 0;
    for (std::size_t i = 0; i < 63; ++i) {
        (void)crowd[i].receive(milliseconds(10000));
        cut_off += crowd[i].closed() ? 1 : 0;
    }
    CHECK(cut_off == 63);
    CHECK(web_request(server.port(), "/").status == 200);
    CHECK(neighbour.is_well());
}
