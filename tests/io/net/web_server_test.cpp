#include "io/net/web_server.h"

#include <doctest/doctest.h>

#include <array>
#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "tests/io/net/running_server.h"
#include "tests/io/net/web_client.h"

using namespace lightwalk;
using namespace lightwalk::test;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

TEST_CASE("web server: assets are served with their types and no one else's scripts") {
    RunningServer server;
    const WebResponse page = web_request(server.port(), "/");
    CHECK(page.status == 200);
    CHECK(page.body == "<!doctype html><title>walk</title>");
    CHECK(page.headers.at("Content-Type") == "text/html; charset=utf-8");
    CHECK(page.headers.at("X-Content-Type-Options") == "nosniff");
    const std::string policy = page.headers.at("Content-Security-Policy");
    CHECK(policy.find("default-src 'none'; script-src 'self';") == 0);
    CHECK(policy.find("unsafe") == std::string::npos);
    const WebResponse script = web_request(server.port(), "/page/walk.js?v=2");
    CHECK(script.body == "export const walk = 1;");
    CHECK(script.headers.at("Content-Type") == "text/javascript; charset=utf-8");
}

TEST_CASE("web server: an asset that the browser has is not sent again") {
    RunningServer server;
    const std::string etag = web_request(server.port(), "/").headers.at("ETag");
    const WebResponse again = web_request(server.port(), "/", {{"If-None-Match", etag}});
    CHECK(again.status == 304);
    CHECK(again.body.empty());
    CHECK(web_request(server.port(), "/page/walk.js", {{"If-None-Match", etag}}).status == 200);
}

TEST_CASE("web server: what is not there, not GET or not HTTP is refused") {
    RunningServer server;
    CHECK(web_request(server.port(), "/page/other.js").status == 404);
    CHECK(web_request(server.port(), "/page/../../etc/passwd").status == 404);
    CHECK(web_request(server.port(), "/page").status == 404);
    const WebResponse post = web_request(server.port(), "/", {}, "DELETE");
    CHECK(post.status == 405);
    CHECK(post.headers.at("Allow") == "GET");
    CHECK(web_request(server.port(), "/", {}, "POST", "name=value").status == 413);
    CHECK(web_request(server.port(), "/", {{"X-Long", std::string(20'000, 'x')}}).status == 431);
    CHECK(web_request(server.port(), "/walk").status == 426);
    BareSocket socket(server.port());
    CHECK(socket.send("how do you do\r\n\r\n"));
    CHECK(socket.receive(milliseconds(5000)).find("HTTP/1.1 400") == 0);
}

TEST_CASE("web server: requests over one connection are answered one after the other") {
    RunningServer server;
    BareSocket socket(server.port());
    const std::string get = "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n";
    CHECK(
        socket.send(get + get + "GET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"));
    const std::string received = socket.receive(milliseconds(10'000));
    CHECK(socket.closed());
    std::size_t answers = 0;
    for (std::size_t at = received.find("200 OK"); at != std::string::npos;
         at = received.find("200 OK", at + 1)) {
        ++answers;
    }
    CHECK(answers == 3);
}

TEST_CASE("web server: a token is demanded for the page, the walk and pictures, not for assets") {
    RunningServer server({}, "0123456789abcdef");
    CHECK(server->url() ==
          "http://127.0.0.1:" + std::to_string(server.port()) + "/?token=0123456789abcdef");
    for (const std::string path : {"/", "/save/now"}) {
        CAPTURE(path);
        CHECK(web_request(server.port(), path + "?token=0123456789abcdef").status == 200);
        CHECK(web_request(server.port(), path).status == 403);
        CHECK(web_request(server.port(), path + "?token=0123456789abcdee").status == 403);
    }
    CHECK(web_request(server.port(), "/page/walk.js").status == 200);
    CHECK(WebClient(server.port(), {}, "/walk?token=0123456789abcdef").status() == 101);
    CHECK(WebClient(server.port()).status() == 403);
    CHECK(WebClient(server.port(), {}, "/walk?token=").status() == 403);
}

TEST_CASE("web server: pages of other hosts get no WebSocket, nor does a name made to point here") {
    RunningServer server;
    const std::string own = "127.0.0.1:" + std::to_string(server.port());
    CHECK(WebClient(server.port()).status() == 101);
    CHECK(WebClient(server.port(), {{"Origin", "http://" + own}}).status() == 101);
    CHECK(WebClient(server.port(), {{"Origin", "http://evil.example"}}).status() == 403);
    CHECK(WebClient(server.port(), {{"Origin", "http://127.0.0.1:1"}}).status() == 403);
    CHECK(WebClient(server.port(), {{"Origin", "null"}}).status() == 403);
    const WebHeaders rebound{{"Host", "evil.example"}, {"Origin", "http://evil.example"}};
    CHECK(WebClient(server.port(), rebound).status() == 421);
    CHECK(web_request(server.port(), "/", {{"Host", "evil.example"}}).status == 421);
    CHECK(web_request(server.port(), "/save/now", {{"Sec-Fetch-Site", "cross-site"}}).status ==
          403);
}

TEST_CASE("web server: messages go both ways, text and binary, small and large") {
    RunningServer server;
    WebClient client(server.port());
    REQUIRE(client.status() == 101);
    for (const std::string& text :
         {std::string("hello"), std::string(), std::string(60'000, 'x')}) {
        REQUIRE(client.send(text));
        CHECK(client.receive() == "echo " + text);
        CHECK_FALSE(client.binary());
    }
    REQUIRE(server.handler.wait(1, 0));
    std::string bytes(3'000'000, '\0');
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * i / 7);
    server->send_binary(*server.handler.open().begin(), std::make_shared<const std::string>(bytes));
    CHECK(client.receive() == bytes);
    CHECK(client.binary());
}

TEST_CASE("web server: what is sent from many threads arrives whole, each thread's in order") {
    RunningServer server;
    WebClient client(server.port());
    REQUIRE(server.handler.wait(1, 0));
    const ClientId id = *server.handler.open().begin();
    std::vector<std::thread> threads;
    for (int t = 0; t < 3; ++t) {
        threads.emplace_back([&server, id, t] {
            for (int i = 0; i < 100; ++i) {
                server->send_text(id, std::to_string(t) + ' ' + std::to_string(i));
            }
        });
    }
    std::array<int, 3> next{};
    for (int i = 0; i < 300; ++i) {
        const std::string text = client.receive().value_or("9 0");
        const int t = text[0] - '0';
        REQUIRE((t >= 0 && t < 3));
        CHECK(text.substr(2) == std::to_string(next[static_cast<std::size_t>(t)]++));
    }
    for (std::thread& thread : threads) thread.join();
}

TEST_CASE("web server: a client that is closed hears why, and its handler once") {
    RunningServer server;
    WebClient client(server.port());
    REQUIRE(server.handler.wait(1, 0));
    const ClientId id = *server.handler.open().begin();
    server->send_text(id, "last words");
    server->close(id, "enough \xe2\x82\xac");
    server->close(id, "again");
    const std::vector<std::string> messages = client.receive_all();
    REQUIRE(messages.size() == 2);
    CHECK(messages[0] == "last words");
    CHECK(messages[1] == "{\"reason\":\"enough \xe2\x82\xac\",\"type\":\"bye\"}");
    CHECK(client.close_code() == 1000);
    CHECK(client.close_reason() == "enough ???");
    CHECK(server.handler.wait(0, 1));
    server->send_text(id, "to no one");
    CHECK(web_request(server.port(), "/").status == 200);
}

TEST_CASE("web server: a client that leaves is told to the handler, orderly or not") {
    RunningServer server;
    {
        WebClient polite(server.port());
        REQUIRE(server.handler.wait(1, 0));
        polite.close();
        CHECK(server.handler.wait(0, 1));
        WebClient sudden(server.port());
        REQUIRE(server.handler.wait(1, 1));
    }
    CHECK(server.handler.wait(0, 2));
}

TEST_CASE("web server: pictures to save come at once, later, or not at all") {
    WebLimits limits;
    limits.saves = 2;
    RunningServer server(limits);
    for (const char* path : {"/save/now", "/save/later"}) {
        CAPTURE(path);
        const WebResponse saved = web_request(server.port(), path);
        CHECK(saved.status == 200);
        CHECK(saved.body == "#?RADIANCE");
        CHECK(saved.headers.at("Content-Type") == "image/vnd.radiance");
        CHECK(saved.headers.at("Content-Disposition") == "attachment; filename=\"picture.hdr\"");
        CHECK(saved.headers.at("Cache-Control") == "no-store");
    }
    CHECK(web_request(server.port(), "/save/never").status == 503);
    const WebResponse wrong = web_request(server.port(), "/save/wrong");
    CHECK(wrong.status == 503);
    CHECK(wrong.body == "there is no scene yet\n");
}

TEST_CASE(
    "web server: so many pictures wait at once, an answer counts once, none is owed at the end") {
    WebLimits limits;
    limits.saves = 2;
    RunningServer server(limits);
    const std::string get = "GET /save/kept HTTP/1.1\r\nHost: localhost\r\n\r\n";
    BareSocket first(server.port()), second(server.port());
    CHECK(first.send(get));
    CHECK(server.handler.wait_for_kept(1));
    CHECK(second.send(get));
    CHECK(server.handler.wait_for_kept(2));
    CHECK(web_request(server.port(), "/save/kept").status == 503);
    const std::vector<WebReply> kept = server.handler.take_kept();
    REQUIRE(kept.size() == 2);
    kept[0]({200, "text/plain", "one", ""});
    kept[0]({200, "text/plain", "two", ""});
    const std::string answer = first.receive(milliseconds(500));
    CHECK(answer.find("\r\n\r\none") != std::string::npos);
    CHECK(answer.find("two") == std::string::npos);
    server.stop();
    CHECK(second.receive(milliseconds(5000)).empty());
    CHECK(second.closed());
    kept[1]({200, "text/plain", "late", ""});
}

TEST_CASE("web server: stop ends it though clients are there, and tells them") {
    WebLimits limits;
    limits.close_timeout = milliseconds(300);
    RunningServer server(limits);
    WebClient client(server.port());
    BareSocket deaf(server.port()), silent(server.port());
    REQUIRE(deaf.send(upgrade_text(server.port())));
    REQUIRE(server.handler.wait(2, 0));
    const auto begin = steady_clock::now();
    std::thread stopper([&] { server.stop("rank 1 was lost"); });
    const std::vector<std::string> messages = client.receive_all();
    stopper.join();
    CHECK(steady_clock::now() - begin < milliseconds(30000));
    REQUIRE(messages.size() == 1);
    CHECK(messages[0] == R"({"reason":"rank 1 was lost","type":"bye"})");
    CHECK(client.close_code() == 1001);
    CHECK(server.handler.wait(0, 2));
    CHECK(web_request(server.port(), "/").status == 0);
}

TEST_CASE("web server: an address that cannot be had is told with its port") {
    RunningServer server;
    EchoHandler handler;
    const std::string port = std::to_string(server.port());
    CHECK_THROWS_WITH_AS(WebServer({"127.0.0.1", server.port(), "", {}}, {}, handler),
                         ("127.0.0.1:" + port + ": Address already in use").c_str(), InputError);
    CHECK_THROWS_WITH_AS(WebServer({"everywhere", 80, "", {}}, {}, handler),
                         "everywhere:80: expected an address in numbers, as 127.0.0.1", InputError);
    const WebServer other({"localhost", 0, "", {}}, {}, handler);  // never runs
    CHECK(other.url() == "http://127.0.0.1:" + std::to_string(other.port()) + "/");
}
