#include "io/net/web_server.h"

#include <array>
#include <atomic>
#include <cstdio>
#include <map>
#include <utility>

#include "core/error.h"
#include "io/net/http_session.h"

namespace lightwalk {
namespace {

namespace net = boost::asio;
namespace websocket = boost::beast::websocket;
using boost::beast::error_code;
using net::ip::tcp;

constexpr std::chrono::milliseconds kAcceptPause{100};  // where no socket could be had

WebAnswer not_done(std::string why) {
    return {503, "text/plain; charset=utf-8", std::move(why) + '\n', {}};
}

/// FNV-1a, 64 bits: equal for equal bytes, which is all that a browser asks.
std::string etag_of(std::string_view bytes) {
    std::uint64_t hash = 14695981039346656037u;
    for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
    std::array<char, 24> text{};
    (void)std::snprintf(text.data(), text.size(), "\"%016llx\"",
                        static_cast<unsigned long long>(hash));
    return text.data();
}

std::string place_of(const WebServerOptions& options) {
    return options.address + ":" + std::to_string(options.port);
}

tcp::endpoint endpoint_of(const WebServerOptions& options) {
    error_code error;
    const net::ip::address address = net::ip::make_address(
        options.address == "localhost" ? "127.0.0.1" : options.address, error);
    if (error) {
        throw InputError(place_of(options) + ": expected an address in numbers, as 127.0.0.1");
    }
    return {address, static_cast<std::uint16_t>(options.port)};
}

}  // namespace

struct WebReply::State {
    std::function<void(WebAnswer)> deliver;
    std::atomic<bool> answered = false;

    explicit State(std::function<void(WebAnswer)> to) : deliver(std::move(to)) {}
    ~State() {
        if (!answered) deliver(not_done("the request was dropped without an answer"));
    }
    State(const State&) = delete;
    State& operator=(const State&) = delete;
};

WebReply::WebReply(std::function<void(WebAnswer)> deliver)
    : state_(std::make_shared<State>(std::move(deliver))) {}

void WebReply::operator()(WebAnswer answer) const {
    if (!state_->answered.exchange(true)) state_->deliver(std::move(answer));
}

/// All but post() is called on the server's thread, or before it runs.
class WebServer::Core final : public ClientHost,
                              public HttpHost,
                              public std::enable_shared_from_this<Core> {
  public:
    Core(WebServerOptions options, const std::vector<WebAsset>& assets, WebHandler& handler);

    void run();
    /// Do something on the server's thread. Any thread may call it.
    template <class Work>
    void post(Work work) {
        net::post(context_, std::move(work));
    }
    void stop(const std::string& reason);
    [[nodiscard]] std::shared_ptr<ClientSession> find(ClientId client) const;
    [[nodiscard]] tcp::endpoint endpoint() const { return endpoint_; }

    [[nodiscard]] const std::string& token() const override { return options_.token; }
    [[nodiscard]] std::string embedders() const override {
        return options_.embedders.empty() ? "'none'" : options_.embedders;
    }
    [[nodiscard]] const StoredAsset* asset(const std::string& path) const override;
    [[nodiscard]] bool room_for_client() const override;
    void upgrade(boost::beast::tcp_stream stream, const HttpRequest& request) override;
    void save(const std::string& path, std::shared_ptr<HttpSession> session) override;

    void opened(ClientId client) override { handler_.opened(client); }
    void message(ClientId client, std::string_view text) override {
        handler_.message(client, text);
    }
    void closed(ClientId client, bool opened) override;

  private:
    void listen();
    void accept();
    void on_accept(error_code error, tcp::socket socket);
    void deliver(std::uint64_t save, WebAnswer answer);

    WebServerOptions options_;
    std::map<std::string, StoredAsset, std::less<>> assets_;
    WebHandler& handler_;
    tcp::endpoint endpoint_;
    bool stopping_ = false;
    std::uint32_t last_client_ = 0;
    std::uint64_t last_save_ = 0;
    // In this order: sessions hold sockets of the context, and die with it at the latest; they
    // leave the list then.
    Connection::List connections_;
    net::io_context context_{1};
    tcp::acceptor acceptor_{context_};
    net::steady_timer pause_{context_};
    std::map<ClientId, std::shared_ptr<ClientSession>> clients_;
    std::map<std::uint64_t, std::shared_ptr<HttpSession>>
        saves_;  ///< requests without an answer yet
};

WebServer::Core::Core(WebServerOptions options, const std::vector<WebAsset>& assets,
                      WebHandler& handler)
    : options_(std::move(options)), handler_(handler) {
    for (const WebAsset& asset : assets) {
        assets_.insert_or_assign(std::string(asset.path), StoredAsset{asset, etag_of(asset.bytes)});
    }
    listen();
}

void WebServer::Core::listen() {
    const tcp::endpoint endpoint = endpoint_of(options_);
    try {
        acceptor_.open(endpoint.protocol());
        acceptor_.set_option(net::socket_base::reuse_address(true));
        acceptor_.bind(endpoint);
        acceptor_.listen();
        endpoint_ = acceptor_.local_endpoint();
    } catch (const boost::system::system_error& error) {
        throw InputError(place_of(options_) + ": " + error.code().message());
    }
}

void WebServer::Core::run() {
    accept();
    context_.run();
}

void WebServer::Core::accept() {
    if (stopping_) return;
    acceptor_.async_accept(
        [this](error_code error, tcp::socket socket) { on_accept(error, std::move(socket)); });
}

void WebServer::Core::on_accept(error_code error, tcp::socket socket) {
    if (stopping_) return;
    if (error) {  // out of descriptors, say: not at once again
        pause_.expires_after(kAcceptPause);
        return pause_.async_wait([this](error_code) { accept(); });
    }
    if (connections_.size() < static_cast<std::size_t>(options_.limits.connections)) {
        error_code ignored;
        (void)socket.set_option(tcp::no_delay(true), ignored);
        std::make_shared<HttpSession>(std::move(socket), options_.limits, *this, connections_)
            ->read();
    }
    accept();
}

void WebServer::Core::stop(const std::string& reason) {
    if (std::exchange(stopping_, true)) return;
    error_code ignored;
    (void)acceptor_.close(ignored);
    pause_.cancel();
    const auto clients = clients_;  // they leave the table as they end
    const Connection::List connections = connections_;
    for (Connection* connection : connections) connection->stop(reason);
    saves_.clear();
}

std::shared_ptr<ClientSession> WebServer::Core::find(ClientId client) const {
    const auto found = clients_.find(client);
    return found == clients_.end() ? nullptr : found->second;
}

const StoredAsset* WebServer::Core::asset(const std::string& path) const {
    const auto found = assets_.find(path);
    return found == assets_.end() ? nullptr : &found->second;
}

bool WebServer::Core::room_for_client() const {
    return clients_.size() < static_cast<std::size_t>(options_.limits.clients);
}

void WebServer::Core::upgrade(boost::beast::tcp_stream stream, const HttpRequest& request) {
    const ClientId id{++last_client_};
    const auto session = std::make_shared<ClientSession>(std::move(stream), id, options_.limits,
                                                         *this, connections_);
    clients_.emplace(id, session);
    session->accept(request);
}

void WebServer::Core::closed(ClientId client, bool opened) {
    clients_.erase(client);
    if (opened) handler_.closed(client);
}

void WebServer::Core::save(const std::string& path, std::shared_ptr<HttpSession> session) {
    const std::uint64_t number = ++last_save_;
    const bool room = saves_.size() < static_cast<std::size_t>(options_.limits.saves);
    saves_.emplace(number, std::move(session));
    if (!room) return deliver(number, not_done("too many pictures are being saved at once"));
    try {
        handler_.save(path, WebReply([weak = weak_from_this(), number](WebAnswer answer) {
                          const std::shared_ptr<Core> core = weak.lock();
                          if (!core) return;
                          core->post([&here = *core, number, answer = std::move(answer)]() mutable {
                              here.deliver(number, std::move(answer));
                          });
                      }));
    } catch (const InputError& wrong) {
        deliver(number, not_done(wrong.what()));
    }
}

void WebServer::Core::deliver(std::uint64_t save, WebAnswer answer) {
    const auto waiting = saves_.extract(save);
    if (!waiting.empty()) waiting.mapped()->answer(std::move(answer));
}

WebServer::WebServer(WebServerOptions options, const std::vector<WebAsset>& assets,
                     WebHandler& handler)
    : core_(std::make_shared<Core>(std::move(options), assets, handler)) {}

WebServer::~WebServer() = default;

std::uint16_t WebServer::port() const {
    return core_->endpoint().port();
}

std::string WebServer::url() const {
    const net::ip::address address = core_->endpoint().address();
    error_code error;
    std::string host = address.to_string();
    if (address.is_unspecified()) host = net::ip::host_name(error);
    if (host.find(':') != std::string::npos) host = '[' + host + ']';
    const std::string& token = core_->token();
    return "http://" + host + ':' + std::to_string(port()) + '/' +
           (token.empty() ? "" : "?token=" + token);
}

void WebServer::run() {
    core_->run();
}

void WebServer::stop(std::string reason) {
    core_->post([&core = *core_, reason = std::move(reason)] { core.stop(reason); });
}

void WebServer::send_text(ClientId client, std::string text) {
    send(client, std::make_shared<const std::string>(std::move(text)), false);
}

void WebServer::send_binary(ClientId client, std::shared_ptr<const std::string> bytes) {
    send(client, std::move(bytes), true);
}

void WebServer::send(ClientId client, std::shared_ptr<const std::string> bytes, bool binary) {
    core_->post([&core = *core_, client, bytes = std::move(bytes), binary] {
        if (const auto session = core.find(client)) session->send(bytes, binary);
    });
}

void WebServer::close(ClientId client, std::string reason) {
    core_->post([&core = *core_, client, reason = std::move(reason)] {
        if (const auto session = core.find(client)) {
            session->end(websocket::close_code::normal, reason);
        }
    });
}

}  // namespace lightwalk
