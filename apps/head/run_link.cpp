#include "apps/head/run_link.h"

#include <utility>

namespace lightwalk {
namespace {

namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;

constexpr std::chrono::seconds kConnecting{5};
constexpr std::chrono::seconds kSilence{20};                    // of the run, which answers pings
constexpr std::size_t kMostWaiting = std::size_t{1024} * 1024;  // [bytes]
constexpr std::size_t kLargestMessage = std::size_t{256} * 1024 * 1024;  // frames; [bytes]

}  // namespace

RunLink::RunLink(boost::asio::io_context& context, ClientId client, RunLinkHost& host)
    : socket_(context), client_(client), host_(host) {}

void RunLink::open(const RunPlace& place) {
    target_ = "/walk?token=" + place.token;
    auto& stream = beast::get_lowest_layer(socket_);
    stream.expires_after(kConnecting);
    stream.async_connect(place.endpoints, [self = shared_from_this()](beast::error_code error,
                                                                      const auto& /*endpoint*/) {
        self->on_connect(error);
    });
}

void RunLink::on_connect(beast::error_code error) {
    if (ended_) return;
    if (error) return end(std::nullopt);
    auto& stream = beast::get_lowest_layer(socket_);
    stream.expires_never();  // the WebSocket has times of its own
    (void)stream.socket().set_option(boost::asio::ip::tcp::no_delay(true), error);
    websocket::stream_base::timeout times{};
    times.handshake_timeout = kConnecting;
    times.idle_timeout = kSilence;
    times.keep_alive_pings = true;
    socket_.set_option(times);
    socket_.read_message_max(kLargestMessage);
    socket_.auto_fragment(false);
    socket_.async_handshake(
        "localhost", target_,
        [self = shared_from_this()](beast::error_code failure) { self->on_open(failure); });
}

void RunLink::on_open(beast::error_code error) {
    if (ended_) return;
    if (error) return end(std::nullopt);
    open_ = true;
    read();
    if (!waiting_.empty()) write();
}

void RunLink::read() {
    socket_.async_read(received_,
                       [self = shared_from_this()](beast::error_code error, std::size_t) {
                           self->on_read(error);
                       });
}

void RunLink::on_read(beast::error_code error) {
    if (ended_) return;
    if (error == websocket::error::closed &&
        socket_.reason().code != websocket::close_code::going_away) {
        const auto& reason = socket_.reason().reason;
        return end(std::string(reason.data(), reason.size()));
    }
    if (error) return end(std::nullopt);
    const auto bytes = received_.cdata();
    host_.came(
        client_,
        std::make_shared<const std::string>(static_cast<const char*>(bytes.data()), bytes.size()),
        socket_.got_binary());
    received_.clear();
    if (!ended_) read();
}

bool RunLink::send(std::string text) {
    if (ended_) return true;
    if (waiting_bytes_ + text.size() > kMostWaiting) return false;
    waiting_bytes_ += text.size();
    waiting_.push_back(std::move(text));
    if (open_ && !writing_) write();
    return true;
}

void RunLink::write() {
    writing_ = true;
    socket_.async_write(boost::asio::buffer(waiting_.front()),
                        [self = shared_from_this()](beast::error_code error, std::size_t) {
                            self->on_write(error);
                        });
}

void RunLink::on_write(beast::error_code error) {
    writing_ = false;
    if (ended_) return;
    if (error) {  // why, the next read tells, where the run has said so; at the latest it ends
        beast::get_lowest_layer(socket_).socket().shutdown(
            boost::asio::ip::tcp::socket::shutdown_both, error);
        return;
    }
    waiting_bytes_ -= waiting_.front().size();
    waiting_.pop_front();
    if (!waiting_.empty()) write();
}

void RunLink::end(const std::optional<std::string>& refusal) {
    stop();
    host_.ended(client_, refusal);
}

void RunLink::stop() {
    ended_ = true;
    beast::get_lowest_layer(socket_).close();
}

}  // namespace lightwalk
