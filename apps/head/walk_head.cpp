#include "apps/head/walk_head.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <exception>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <thread>
#include <utility>
#include <variant>

#include "apps/head/newest_frame.h"
#include "apps/head/run_file.h"
#include "apps/head/run_link.h"
#include "apps/walk/pages.h"
#include "core/error.h"
#include "io/net/walk_reply.h"
#include "io/net/walk_request.h"
#include "io/net/web_rules.h"

namespace lightwalk {
namespace {

namespace net = boost::asio;
using net::ip::tcp;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kBetweenTries{100};  // to reach a run
constexpr std::size_t kLongestToRead = 8192;  // of what a run says about roles and ends [bytes]

/// A message of the run, where it is short and an object; else nothing.
nlohmann::json read_short(const std::string& text) {
    if (text.size() > kLongestToRead) return nullptr;
    nlohmann::json message = nlohmann::json::parse(text, nullptr, false);
    return message.is_object() ? message : nlohmann::json();
}

/// To this machine alone a page is served without a token, as `walk` does it.
WebServerOptions outward(WebServerOptions options) {
    options.limits.close_timeout = std::chrono::milliseconds(300);  // Ctrl-C is soon over
    if (is_loopback(options.address)) options.token.clear();
    return options;
}

/// Sent for each frame, also while nobody does anything.
bool is_acknowledgement(std::string_view text) {
    return text.size() < 64 && text.find("\"ack\"") != std::string_view::npos;
}

}  // namespace

/// The web server calls it on a thread of the server's; what these calls leave to be done, and all
/// that concerns runs, is done on another one, that of the context.
class WalkHead::Core final : public WebHandler, public RunLinkHost {
  public:
    Core(const WebServerOptions& options, const std::string& why)
        : why_(why), server_(outward(options), viewer_pages(), *this) {
        run_thread_ = std::thread([this] { serve([this] { context_.run(); }); });
        try {
            server_thread_ = std::thread([this] { serve([this] { server_.run(); }); });
        } catch (...) {
            end_threads();
            throw;
        }
    }
    ~Core() override { end_threads(); }
    Core(const Core&) = delete;
    Core& operator=(const Core&) = delete;

    [[nodiscard]] std::string url() const { return server_.url(); }
    [[nodiscard]] Clock::duration quiet() const { return Clock::now() - last_asked_.load(); }
    [[nodiscard]] bool failed() const { return failed_; }
    template <class Work>
    void post(Work work) {
        net::post(context_, std::move(work));
    }

    void begin_run(const std::string& host, std::uint16_t port, std::string token);
    void end_run(const std::string& why);

    void opened(ClientId /*client*/) override {}
    void message(ClientId client, std::string_view text) override;
    void closed(ClientId client) override;
    void save(const std::string& path, WebReply reply) override;

    void came(ClientId client, std::shared_ptr<const std::string> bytes, bool binary) override;
    void ended(ClientId client, const std::optional<std::string>& refusal) override;

  private:
    struct Guest {
        std::string hello;
        HelloRequest wants = {};             ///< the same
        std::shared_ptr<RunLink> link = {};  ///< null: there is none
        bool drives = false;                 ///< the run has said so last
        bool welcomed = false;               ///< by this run or one before
        bool interrupted = false;            ///< it has been told, and not welcomed since
        bool pictured = false;               ///< it sees what was drawn last
    };

    template <class Work>
    void serve(Work work);
    void end_threads();
    void greet(ClientId client, Guest guest);
    void pass_on(ClientId client, std::string text);
    void connect_next();
    void try_again();
    void interrupt(ClientId client, Guest& guest, const std::string& why);
    void say_why(ClientId client, Guest& guest);

    std::atomic<bool> failed_{false};
    // Of the server's thread.
    std::set<ClientId> greeted_;
    std::atomic<Clock::time_point> last_asked_{Clock::now()};
    // Of the context's.
    net::io_context context_{1};
    net::executor_work_guard<net::io_context::executor_type> work_{context_.get_executor()};
    net::steady_timer pause_{context_};
    tcp::resolver resolver_{context_};
    std::optional<RunPlace> run_;
    std::string why_;  ///< why there is no run
    std::map<ClientId, Guest> guests_;
    std::optional<ClientId> connecting_;  ///< who waits for its welcome
    NewestFrame newest_;

    WebServer server_;
    std::thread server_thread_, run_thread_;
};

/// Without the head nobody sees the walk: what ends one of its threads ends the process, in order.
template <class Work>
void WalkHead::Core::serve(Work work) {
    try {
        work();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "lightwalk launch: the page's server: %s\n", error.what());
        failed_ = true;
        (void)kill(getpid(), SIGTERM);
    }
}

void WalkHead::Core::end_threads() {
    server_.stop();
    if (server_thread_.joinable()) server_thread_.join();
    context_.stop();
    run_thread_.join();
}

void WalkHead::Core::message(ClientId client, std::string_view text) {
    if (!is_acknowledgement(text)) last_asked_ = Clock::now();
    if (greeted_.contains(client))
        return post([this, client, said = std::string(text)]() mutable {
            pass_on(client, std::move(said));
        });
    // Nobody who does not speak the protocol reaches the run.
    const WalkRequest request = parse_walk_request(text);
    const auto* const hello = std::get_if<HelloRequest>(&request);
    if (hello == nullptr) throw InputError("the first message must be hello");
    greeted_.insert(client);
    Guest guest{std::string(text)};
    guest.wants = *hello;
    post([this, client, guest = std::move(guest)]() mutable { greet(client, std::move(guest)); });
}

void WalkHead::Core::closed(ClientId client) {
    greeted_.erase(client);
    post([this, client] {
        const auto guest = guests_.extract(client);
        if (guest.empty()) return;
        if (guest.mapped().link) guest.mapped().link->stop();
        newest_.left(client);
        if (connecting_ == client) connecting_.reset();
        connect_next();
    });
}

void WalkHead::Core::save(const std::string& path, WebReply reply) {
    post([this, path, reply = std::move(reply)] {
        if (run_)
            fetch_run_file(context_, *run_, path, reply);
        else
            reply({503, "text/plain; charset=utf-8", why_ + '\n', {}});
    });
}

void WalkHead::Core::greet(ClientId client, Guest guest) {
    Guest& there = guests_.emplace(client, std::move(guest)).first->second;
    if (!run_) say_why(client, there);
    connect_next();
}

/// To who has not been welcomed by any run.
void WalkHead::Core::say_why(ClientId client, Guest& guest) {
    if (!std::exchange(guest.pictured, true) && !guest.wants.beside) {
        const std::optional<NewestFrame::Messages> seen = newest_.messages(guest.wants);
        guest.pictured = seen.has_value();
        if (seen) {
            for (const std::string& text : seen->texts) server_.send_text(client, text);
            server_.send_binary(client, std::make_shared<const std::string>(seen->frame));
        }
    }
    server_.send_text(client, walk_text(LoadingReply{why_, 0}));
}

/// What is said while there is no run is lost: who said it is told so, and says it again.
void WalkHead::Core::pass_on(ClientId client, std::string text) {
    const auto guest = guests_.find(client);
    if (guest == guests_.end() || !guest->second.link) return;
    if (guest->second.drives && !guest->second.wants.beside) newest_.said(text);
    if (!guest->second.link->send(std::move(text)))
        server_.close(client, "too many messages wait for an answer");
}

void WalkHead::Core::begin_run(const std::string& host, std::uint16_t port, std::string token) {
    resolver_.async_resolve(
        host, std::to_string(port),
        [this, host, token = std::move(token)](boost::system::error_code error,
                                               const tcp::resolver::results_type& found) {
            if (error) {
                std::fprintf(stderr, "lightwalk launch: %s: %s\n", host.c_str(),
                             error.message().c_str());
                return;
            }
            run_.emplace();
            for (const auto& one : found) run_->endpoints.push_back(one.endpoint());
            run_->token = token;
            connect_next();
        });
}

void WalkHead::Core::end_run(const std::string& why) {
    resolver_.cancel();
    pause_.cancel();
    run_.reset();
    connecting_.reset();
    why_ = why;
    for (auto& [client, guest] : guests_) interrupt(client, guest, why);
}

void WalkHead::Core::interrupt(ClientId client, Guest& guest, const std::string& why) {
    if (guest.link) std::exchange(guest.link, nullptr)->stop();
    newest_.left(client);
    if (guest.wants.beside) return server_.close(client, why);  // its walk is another one now
    guest.interrupted = true;
    if (!guest.welcomed) return say_why(client, guest);
    server_.send_text(client, walk_text(InterruptedReply{why}));
}

/// One after the other, as the first who greets a run drives: that is who drove before.
void WalkHead::Core::connect_next() {
    if (!run_ || connecting_) return;
    const auto waits = [](const auto& one) { return !one.second.link; };
    auto next = std::ranges::find_if(
        guests_, [&](const auto& one) { return waits(one) && one.second.drives; });
    if (next == guests_.end()) next = std::ranges::find_if(guests_, waits);
    if (next == guests_.end()) return;
    connecting_ = next->first;
    Guest& guest = next->second;
    guest.link = std::make_shared<RunLink>(context_, next->first, *this);
    guest.link->open(*run_);
    (void)guest.link->send(guest.hello);
}

void WalkHead::Core::came(ClientId client, std::shared_ptr<const std::string> bytes, bool binary) {
    Guest& guest = guests_.at(client);
    if (connecting_ == client) {
        connecting_.reset();
        guest.welcomed = true;
        guest.interrupted = false;
        connect_next();
    }
    if (binary) {
        if (!guest.wants.beside) newest_.came(client, guest.drives, *bytes);
        return server_.send_binary(client, std::move(bytes));
    }
    const nlohmann::json message = read_short(*bytes);
    if (message.contains("driver")) guest.drives = message["driver"] == true;
    // Whether the page's connection ends, too, the link's end tells.
    if (message.contains("type") && message["type"] == "bye") return;
    server_.send_text(client, *bytes);
}

void WalkHead::Core::ended(ClientId client, const std::optional<std::string>& refusal) {
    Guest& guest = guests_.at(client);
    guest.link.reset();
    newest_.left(client);
    if (connecting_ == client) connecting_.reset();
    if (refusal) {
        guests_.erase(client);
        server_.close(client, *refusal);
        return connect_next();
    }
    if (guest.welcomed && !guest.interrupted) interrupt(client, guest, "the walk does not answer");
    try_again();
}

/// The run may be about to end, which is known a moment later.
void WalkHead::Core::try_again() {
    pause_.expires_after(kBetweenTries);
    pause_.async_wait([this](boost::system::error_code error) {
        if (!error) connect_next();
    });
}

WalkHead::WalkHead(const WebServerOptions& options, const std::string& why)
    : core_(std::make_unique<Core>(options, why)) {}

WalkHead::~WalkHead() = default;

std::string WalkHead::url() const {
    return core_->url();
}

void WalkHead::begin_run(const std::string& host, std::uint16_t port, const std::string& token) {
    core_->post([core = core_.get(), host, port, token] { core->begin_run(host, port, token); });
}

void WalkHead::end_run(const std::string& why) {
    core_->post([core = core_.get(), why] { core->end_run(why); });
}

std::chrono::duration<double> WalkHead::quiet() const {
    return core_->quiet();
}

bool WalkHead::failed() const {
    return core_->failed();
}

}  // namespace lightwalk
