// The head of a walk: pages stay connected while runs come and go, and nothing that they send harms
// it.
#include "apps/head/walk_head.h"

#include <doctest/doctest.h>

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "core/error.h"
#include "io/net/walk_frame.h"
#include "tests/io/net/web_client.h"

namespace lightwalk::test {
namespace {

constexpr const char* kSecret = "0123456789abcdef0123456789abcdef";
constexpr const char* kLoading = R"({"share":0.0,"text":"starting","type":"loading"})";

std::string hello(char digit) {
    return R"({"type":"hello","session":")" + std::string(16, digit) + R"("})";
}

/// A run that draws nothing: who greets it first drives, "wrong" is malformed, "wait" keeps it from
/// all else until go_on(), and everything else is said back.
class FakeRun final : public WebHandler {
  public:
    FakeRun() : server_({"127.0.0.1", 0, kSecret, {}}, {}, *this) {
        thread_ = std::thread([this] { server_.run(); });
    }
    ~FakeRun() override {
        go_on();
        server_.stop("the run ends");
        thread_.join();
    }
    FakeRun(const FakeRun&) = delete;
    FakeRun& operator=(const FakeRun&) = delete;

    [[nodiscard]] std::uint16_t port() const { return server_.port(); }
    void go_on() {
        const std::lock_guard lock(mutex_);
        goes_on_ = true;
        news_.notify_all();
    }

    /// A frame for all that have greeted it.
    void show(const std::string& frame) {
        const std::lock_guard lock(mutex_);
        for (const ClientId client : guests_)
            server_.send_binary(client, std::make_shared<const std::string>(frame));
    }

    void opened(ClientId /*client*/) override {}
    void closed(ClientId /*client*/) override {}
    void message(ClientId client, std::string_view text) override {
        if (text == "wrong") throw InputError("malformed: wrong");
        if (text == "wait") {
            std::unique_lock lock(mutex_);
            news_.wait(lock, [this] { return goes_on_; });
        }
        if (text.find("hello") == std::string_view::npos)
            return server_.send_text(client, "said " + std::string(text));
        const std::lock_guard lock(mutex_);
        server_.send_text(client, std::string(R"({"type":"welcome","driver":)") +
                                      (guests_.empty() ? "true}" : "false}"));
        guests_.push_back(client);
    }
    void save(const std::string& path, WebReply reply) override {
        reply({200, "image/vnd.radiance", "of " + path, "picture.hdr"});
    }

  private:
    std::mutex mutex_;
    std::condition_variable news_;
    bool goes_on_ = false;
    std::vector<ClientId> guests_;
    WebServer server_;
    std::thread thread_;
};

struct TestedHead {
    WalkHead head{{"127.0.0.1", 0, kSecret, {}}, "starting"};

    [[nodiscard]] std::uint16_t port() const {
        const std::string url = head.url();  // http://127.0.0.1:PORT/
        return static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1)));
    }
    void begin(const FakeRun& run) { head.begin_run("127.0.0.1", run.port(), kSecret); }
};

/// What it hears next, but for what is said before a run is there.
bool is_welcomed(WebClient& page, bool drives) {
    std::optional<std::string> said = page.receive();
    if (said == kLoading) said = page.receive();
    return said == std::string(R"({"type":"welcome","driver":)") + (drives ? "true}" : "false}");
}

}  // namespace

TEST_CASE("head: pages stay connected while runs come and go, and who drove drives again") {
    TestedHead tested;
    WebClient first(tested.port());
    REQUIRE(first.send(hello('a')));
    CHECK(first.receive() == kLoading);
    auto run = std::make_unique<FakeRun>();
    tested.begin(*run);
    REQUIRE(is_welcomed(first, true));
    auto second = std::make_unique<WebClient>(tested.port());
    REQUIRE(second->send(hello('b')));
    REQUIRE(is_welcomed(*second, false));
    WebClient third(tested.port());
    REQUIRE(third.send(hello('c')));
    REQUIRE(is_welcomed(third, false));
    REQUIRE(third.send("look"));
    CHECK(third.receive() == "said look");

    const auto until = [](WebClient& page, const std::string& wanted) {
        std::optional<std::string> said;
        do said = page.receive();
        while (said && *said != wanted);
        return said.has_value();
    };
    run.reset();
    // What the head sees by itself.
    CHECK(third.receive() == R"({"text":"the walk does not answer","type":"interrupted"})");
    tested.head.end_run("rank 1 was killed");
    for (WebClient* page : {&first, second.get(), &third})
        CHECK(until(*page, R"({"text":"rank 1 was killed","type":"interrupted"})"));
    WebClient newcomer(tested.port());
    REQUIRE(newcomer.send(hello('d')));
    CHECK(newcomer.receive() == R"({"share":0.0,"text":"rank 1 was killed","type":"loading"})");
    second.reset();
    FakeRun next;
    tested.begin(next);
    CHECK(is_welcomed(first, true));
    CHECK(is_welcomed(third, false));
    CHECK(is_welcomed(newcomer, false));
    REQUIRE(first.send("look"));
    CHECK(first.receive() == "said look");
}

TEST_CASE("head: who comes while there is no run sees what was drawn last") {
    TestedHead tested;
    WebClient page(tested.port());
    REQUIRE(page.send(hello('a')));
    auto run = std::make_unique<FakeRun>();
    tested.begin(*run);
    REQUIRE(is_welcomed(page, true));
    WalkFrameHeader header;
    header.width = header.height = 8;
    header.whole = true;
    const std::vector<WalkFramePiece> pieces{{0, 0, 8, 8, PieceCodec::jpeg, "a picture"}};
    const std::string frame = encode_walk_frame(header, pieces);
    run->show(frame);
    REQUIRE(page.receive() == frame);
    tested.head.end_run("rank 1 was killed");
    run.reset();
    CHECK(page.receive() == R"({"text":"rank 1 was killed","type":"interrupted"})");
    const char* const why = R"({"share":0.0,"text":"rank 1 was killed","type":"loading"})";
    WebClient newcomer(tested.port()), beside(tested.port());
    REQUIRE(newcomer.send(hello('b')));
    CHECK(newcomer.receive() == frame);
    CHECK(newcomer.binary());
    CHECK(newcomer.receive() == why);
    REQUIRE(beside.send(R"({"type":"hello","session":"aaaaaaaaaaaaaaaa","beside":true})"));
    CHECK(beside.receive() == why);
    tested.head.end_run("no ranks can be started");
    CHECK(newcomer.receive() ==
          R"({"share":0.0,"text":"no ranks can be started","type":"loading"})");
    CHECK(page.receive() == R"({"text":"no ranks can be started","type":"interrupted"})");
    const FakeRun next;
    tested.begin(next);
    CHECK(is_welcomed(page, true));
    CHECK(is_welcomed(newcomer, false));
}

TEST_CASE("head: who does not speak the protocol never reaches the run") {
    TestedHead tested;
    const FakeRun run;
    tested.begin(run);
    for (const char* const text : {R"({"type":"take"})", "wrong", R"({"type":"hello"})"}) {
        CAPTURE(text);
        WebClient page(tested.port());
        REQUIRE(page.send(text));
        const std::vector<std::string> said = page.receive_all();
        REQUIRE(said.size() == 1);
        CHECK(said[0].find("\"bye\"") != std::string::npos);
        CHECK(page.close_code() == 1008);
    }
    WebClient good(tested.port());
    REQUIRE(good.send(hello('a')));
    CHECK(is_welcomed(good, true));
}

TEST_CASE("head: whom the run refuses is told why, and nobody else is disturbed") {
    TestedHead tested;
    const FakeRun run;
    tested.begin(run);
    WebClient good(tested.port()), bad(tested.port());
    REQUIRE(good.send(hello('a')));
    REQUIRE(is_welcomed(good, true));
    REQUIRE(bad.send(hello('b')));
    REQUIRE(is_welcomed(bad, false));
    REQUIRE(bad.send("wrong"));
    CHECK(bad.receive() == R"({"reason":"malformed: wrong","type":"bye"})");
    CHECK_FALSE(bad.receive());
    CHECK(bad.close_reason() == "malformed: wrong");
    REQUIRE(good.send("look"));
    CHECK(good.receive() == "said look");
}

TEST_CASE("head: what a run does not read does not pile up") {
    TestedHead tested;
    FakeRun run;
    tested.begin(run);
    WebClient page(tested.port());
    REQUIRE(page.send(hello('a')));
    REQUIRE(is_welcomed(page, true));
    REQUIRE(page.send("wait"));
    // More than the system's buffers and the head's take together. Who goes on writing may not hear
    // why nobody listens any more.
    const std::string large(60'000, 'x');
    bool cut = false;
    for (int i = 0; i < 900 && !cut; ++i) cut = !page.send(large);
    const std::vector<std::string> said = page.receive_all();
    CHECK((cut ||
           (!said.empty() && said.back().find("too many messages wait") != std::string::npos)));
    run.go_on();
    WebClient other(tested.port());
    REQUIRE(other.send(hello('b')));
    CHECK(is_welcomed(other, false));
}

TEST_CASE("head: files are those of the run, and refused where there is none") {
    TestedHead tested;
    const WebResponse early = web_request(tested.port(), "/save/picture.hdr");
    CHECK(early.status == 503);
    CHECK(early.body == "starting\n");
    CHECK(web_request(tested.port(), "/").status == 200);
    FakeRun run;
    tested.begin(run);
    WebClient page(tested.port());
    REQUIRE(page.send(hello('a')));
    while (const auto said = page.receive())
        if (said->find("welcome") != std::string::npos) break;
    const WebResponse saved = web_request(tested.port(), "/save/picture.hdr");
    CHECK(saved.status == 200);
    CHECK(saved.body == "of /save/picture.hdr");
    CHECK(saved.headers.at("Content-Disposition") == "attachment; filename=\"picture.hdr\"");
}

TEST_CASE("head: a walk that is for others, too, demands its token") {
    const WalkHead head({"0.0.0.0", 0, kSecret, {}}, "starting");
    const std::string url = head.url();
    CHECK(url.ends_with(std::string("/?token=") + kSecret));
    const auto port = static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1)));
    CHECK(web_request(port, "/").status == 403);
    CHECK(web_request(port, std::string("/?token=") + kSecret).status == 200);
    CHECK(WebClient(port).status() == 403);
}

}  // namespace lightwalk::test
