#include "tests/io/net/web_client.h"

#include "io/net/beast.h"

namespace lightwalk::test {
namespace {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using beast::error_code;
using net::ip::tcp;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kPatience{10};

/// Start something with a handler and wait for it; give up after the time.
template <class Start>
error_code wait(net::io_context& context, tcp::socket& socket, const Start& start,
                Clock::duration time = kPatience) {
    bool done = false;
    error_code result;
    start([&](error_code error, std::size_t = 0) {
        result = error;
        done = true;
    });
    const Clock::time_point end = Clock::now() + time;
    context.restart();
    while (!done && Clock::now() < end && context.run_one_until(end) > 0) {
    }
    if (done) return result;
    error_code ignored;
    socket.cancel(ignored);
    context.restart();
    while (!done && context.run_one() > 0) {
    }
    return net::error::timed_out;
}

tcp::endpoint here(std::uint16_t port) {
    return {net::ip::address_v4::loopback(), port};
}

std::string host_text(std::uint16_t port) {
    return "127.0.0.1:" + std::to_string(port);
}

}  // namespace

WebResponse web_request(std::uint16_t port, const std::string& target, const WebHeaders& headers,
                        const std::string& method, const std::string& body) {
    net::io_context context;
    tcp::socket socket(context);
    error_code error;
    socket.connect(here(port), error);
    http::request<http::string_body> request;
    request.method_string(method);
    request.target(target);
    request.version(11);
    request.set(http::field::host, host_text(port));
    request.set(http::field::connection, "close");
    for (const auto& [name, value] : headers) request.set(name, value);
    request.body() = body;
    if (!body.empty()) request.prepare_payload();
    error = wait(context, socket,
                 [&](auto handler) { http::async_write(socket, request, std::move(handler)); });
    beast::flat_buffer buffer;
    http::response<http::string_body> response;
    error = wait(context, socket, [&](auto handler) {
        http::async_read(socket, buffer, response, std::move(handler));
    });
    if (error) return {};
    WebResponse result{response.result_int(), {}, response.body()};
    for (const auto& field : response) {
        result.headers[std::string(field.name_string())] = std::string(field.value());
    }
    return result;
}

struct WebClient::Parts {
    net::io_context context;
    websocket::stream<tcp::socket> socket{context};
    beast::flat_buffer buffer;
    unsigned status = 0;

    template <class Start>
    error_code run(const Start& start) {
        return wait(context, socket.next_layer(), start);
    }
    bool write(std::string_view bytes, bool binary) {
        socket.binary(binary);
        return !run(
            [&](auto handler) { socket.async_write(net::buffer(bytes), std::move(handler)); });
    }
};

WebClient::WebClient(std::uint16_t port, const WebHeaders& headers, const std::string& target,
                     int receive_bytes)
    : parts_(std::make_unique<Parts>()) {
    tcp::socket& socket = parts_->socket.next_layer();
    error_code error;
    socket.open(tcp::v4(), error);
    if (receive_bytes > 0) {
        socket.set_option(net::socket_base::receive_buffer_size(receive_bytes), error);
    }
    socket.connect(here(port), error);
    if (error) return;
    parts_->socket.set_option(
        websocket::stream_base::decorator([&](websocket::request_type& request) {
            for (const auto& [name, value] : headers) request.set(name, value);
        }));
    websocket::response_type response;
    error = parts_->run([&](auto handler) {
        parts_->socket.async_handshake(response, host_text(port), target, std::move(handler));
    });
    if (!error || error == websocket::error::upgrade_declined) {
        parts_->status = response.result_int();
    }
}

WebClient::~WebClient() = default;

unsigned WebClient::status() const {
    return parts_->status;
}

bool WebClient::send(std::string_view text) {
    return parts_->write(text, false);
}

bool WebClient::send_binary(std::string_view bytes) {
    return parts_->write(bytes, true);
}

bool WebClient::ping() {
    return !parts_->run([&](auto handler) { parts_->socket.async_ping({}, std::move(handler)); });
}

std::optional<std::string> WebClient::receive() {
    parts_->buffer.clear();
    const error_code error = parts_->run(
        [&](auto handler) { parts_->socket.async_read(parts_->buffer, std::move(handler)); });
    if (error) return std::nullopt;
    return beast::buffers_to_string(parts_->buffer.cdata());
}

bool WebClient::binary() const {
    return parts_->socket.got_binary();
}

std::vector<std::string> WebClient::receive_all() {
    std::vector<std::string> messages;
    while (std::optional<std::string> message = receive()) messages.push_back(std::move(*message));
    return messages;
}

unsigned WebClient::close_code() const {
    return parts_->socket.reason().code;
}

std::string WebClient::close_reason() const {
    const auto& reason = parts_->socket.reason().reason;
    return {reason.data(), reason.size()};
}

void WebClient::close() {
    (void)parts_->run([&](auto handler) {
        parts_->socket.async_close(websocket::close_code::normal, std::move(handler));
    });
}

struct BareSocket::Parts {
    net::io_context context;
    tcp::socket socket{context};
    bool closed = false;
};

BareSocket::BareSocket(std::uint16_t port) : parts_(std::make_unique<Parts>()) {
    error_code error;
    parts_->socket.connect(here(port), error);
    parts_->closed = error.failed();
}

BareSocket::~BareSocket() = default;
BareSocket::BareSocket(BareSocket&&) noexcept = default;

bool BareSocket::send(std::string_view bytes) {
    return !wait(parts_->context, parts_->socket, [&](auto handler) {
        net::async_write(parts_->socket, net::buffer(bytes), std::move(handler));
    });
}

std::string BareSocket::receive(std::chrono::milliseconds time) {
    std::string received;
    error_code error;
    const Clock::time_point end = Clock::now() + time;
    while (!error && Clock::now() < end) {
        std::string part(4096, '\0');
        std::size_t size = 0;
        error = wait(
            parts_->context, parts_->socket,
            [&](auto handler) {
                parts_->socket.async_read_some(
                    net::buffer(part), [&size, handler](error_code e, std::size_t n) mutable {
                        size = n;
                        handler(e, n);
                    });
            },
            end - Clock::now());
        received.append(part, 0, size);
    }
    parts_->closed = error.failed() && error != net::error::timed_out;
    return received;
}

bool BareSocket::closed() const {
    return parts_->closed;
}

std::string upgrade_text(std::uint16_t port) {
    return "GET /walk HTTP/1.1\r\nHost: " + host_text(port) +
           "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
           "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n";
}

}  // namespace lightwalk::test
