#include "io/net/client_session.h"

#include <algorithm>

#include "core/error.h"
#include "io/net/walk_reply.h"

namespace lightwalk {
namespace {

namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;

/// The reason as ASCII, cut to 120 characters, as a close frame has room for 123 bytes.
std::string short_reason(std::string text) {
    text.resize(std::min<std::size_t>(text.size(), 120));
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return text;
}

}  // namespace

ClientSession::ClientSession(beast::tcp_stream stream, ClientId id, const WebLimits& limits,
                             ClientHost& host, List& list)
    : Connection(list),
      socket_(std::move(stream)),
      close_timer_(socket_.get_executor()),
      rate_(limits.messages_per_second, limits.messages_at_once),
      id_(id),
      limits_(limits),
      host_(host) {}

void ClientSession::accept(const HttpRequest& request) {
    beast::get_lowest_layer(socket_).expires_never();  // the WebSocket has times of its own
    websocket::stream_base::timeout times{};
    times.handshake_timeout = limits_.request;
    times.idle_timeout = limits_.silence;
    times.keep_alive_pings = true;
    socket_.set_option(times);
    socket_.read_message_max(limits_.message_bytes);
    socket_.auto_fragment(false);
    socket_.control_callback(
        [this](websocket::frame_type /*type*/, beast::string_view /*text*/) { on_control(); });
    socket_.async_accept(
        request, [self = shared_from_this()](beast::error_code error) { self->on_accept(error); });
}

void ClientSession::on_accept(beast::error_code error) {
    if (ended_) return;
    if (error) return cut();
    open_ = true;
    host_.opened(id_);
    read();
}

void ClientSession::read() {
    socket_.async_read(received_,
                       [self = shared_from_this()](beast::error_code error, std::size_t) {
                           self->on_read(error);
                       });
}

void ClientSession::on_read(beast::error_code error) {
    if (ended_) return;
    if (error) return cut();  // gone, silent too long, or refused by Beast, which told it so
    if (!socket_.got_text()) {
        return end(websocket::close_code::unknown_data, "text messages are expected");
    }
    if (!rate_.try_acquire(RateLimit::Time::clock::now())) {
        return end(websocket::close_code::policy_error, "too many messages");
    }
    try {
        const auto bytes = received_.cdata();
        host_.message(id_, {static_cast<const char*>(bytes.data()), bytes.size()});
    } catch (const InputError& wrong) {
        return end(websocket::close_code::policy_error, wrong.what());
    }
    received_.clear();
    read();
}

/// A ping, pong or close came. Called from within a read, where nothing may be closed.
void ClientSession::on_control() {
    if (flooded_ || rate_.try_acquire(RateLimit::Time::clock::now())) return;
    flooded_ = true;
    boost::asio::post(socket_.get_executor(), [self = shared_from_this()] {
        self->end(websocket::close_code::policy_error, "too many messages");
    });
}

void ClientSession::send(std::shared_ptr<const std::string> bytes, bool binary) {
    if (!open_ || ended_) return;
    if (binary) {
        ++frames_;
    } else {
        text_bytes_ += bytes->size();
    }
    // Nothing could be said to it: it does not read.
    if (frames_ > limits_.frames || text_bytes_ > limits_.text_bytes) return cut();
    waiting_.push_back({std::move(bytes), binary});
    if (!writing_) write();
}

void ClientSession::write() {
    writing_ = true;
    socket_.binary(waiting_.front().binary);
    socket_.async_write(boost::asio::buffer(*waiting_.front().bytes),
                        [self = shared_from_this()](beast::error_code error, std::size_t) {
                            self->on_write(error);
                        });
}

void ClientSession::on_write(beast::error_code error) {
    writing_ = false;
    if (error) return cut();
    const Outgoing& sent = waiting_.front();
    if (sent.binary) {
        --frames_;
    } else {
        text_bytes_ -= sent.bytes->size();
    }
    waiting_.pop_front();
    if (!waiting_.empty()) return write();
    if (!ended_) return;
    socket_.async_close(reason_, [self = shared_from_this()](beast::error_code) { self->cut(); });
}

void ClientSession::end(websocket::close_code code, const std::string& reason) {
    if (ended_) return;
    if (!open_) return cut();
    ended_ = true;
    reason_ = websocket::close_reason(code, short_reason(reason));
    waiting_.erase(std::remove_if(waiting_.begin() + (writing_ ? 1 : 0), waiting_.end(),
                                  [](const Outgoing& one) { return one.binary; }),
                   waiting_.end());
    waiting_.push_back({std::make_shared<const std::string>(walk_text(ByeReply{reason})), false});
    close_timer_.expires_after(limits_.close_timeout);
    close_timer_.async_wait([self = shared_from_this()](beast::error_code error) {
        if (!error) self->cut();
    });
    if (!writing_) write();
    leave();
}

void ClientSession::stop(const std::string& reason) {
    end(websocket::close_code::going_away, reason);
}

void ClientSession::cut() {
    ended_ = true;
    close_timer_.cancel();
    beast::get_lowest_layer(socket_).close();
    leave();
}

void ClientSession::leave() {
    if (left_) return;
    left_ = true;
    host_.closed(id_, open_);
}

}  // namespace lightwalk
