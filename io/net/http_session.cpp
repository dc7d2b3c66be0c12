#include "io/net/http_session.h"

namespace lightwalk {
namespace {

namespace beast = boost::beast;
namespace http = boost::beast::http;

// Nothing from elsewhere, nothing inline: what a scene's names hold is never run.
constexpr const char* kContentPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
    "font-src 'self'; manifest-src 'self'; connect-src 'self'; worker-src 'self' blob:; "
    "base-uri 'none'; form-action 'none'; frame-ancestors ";

constexpr std::size_t kDrained = 4096;  // at once [bytes]

std::string_view view_of(beast::string_view text) {
    return {text.data(), text.size()};
}

/// The HTTP status for an error in the reading of a request.
unsigned status_of(beast::error_code error) {
    if (error == http::error::header_limit) return 431;
    if (error == http::error::unexpected_body || error == http::error::body_limit) return 413;
    return 400;
}

WebRequest facts_of(const HttpRequest& request) {
    WebRequest facts;
    facts.get = request.method() == http::verb::get;
    facts.upgrade = beast::websocket::is_upgrade(request);
    facts.target = view_of(request.target());
    facts.host = view_of(request[http::field::host]);
    if (request.count(http::field::origin) > 0) {
        facts.origin = view_of(request[http::field::origin]);
    }
    facts.fetch_site = view_of(request["Sec-Fetch-Site"]);
    return facts;
}

}  // namespace

HttpSession::HttpSession(boost::asio::ip::tcp::socket socket, const WebLimits& limits,
                         HttpHost& host, List& list)
    : Connection(list), stream_(std::move(socket)), limits_(limits), host_(host) {}

void HttpSession::read() {
    parser_.emplace();
    parser_->header_limit(static_cast<std::uint32_t>(limits_.header_bytes));
    stream_.expires_after(limits_.request);
    http::async_read(stream_, received_, *parser_,
                     [self = shared_from_this()](beast::error_code error, std::size_t) {
                         self->on_read(error);
                     });
}

void HttpSession::on_read(beast::error_code error) {
    keep_alive_ = !error && parser_->get().keep_alive();
    if (!error) return decide();
    static const auto& malformed = make_error_code(http::error::bad_method).category();
    if (error == http::error::end_of_stream || error == http::error::partial_message ||
        error.category() != malformed) {
        return stream_.close();  // gone, or too slow
    }
    refuse(status_of(error), "bad request");
}

void HttpSession::decide() {
    const WebVerdict verdict = judge_request(facts_of(parser_->get()), host_.token());
    switch (verdict.door) {
        case WebDoor::refused:
            return refuse(verdict.status, verdict.text);
        case WebDoor::asset:
            if (const StoredAsset* stored = host_.asset(verdict.path)) return give(*stored);
            return refuse(404, "not found");
        case WebDoor::walk:
            if (!host_.room_for_client()) return refuse(503, "too many clients are connected");
            return host_.upgrade(std::move(stream_), parser_->get());
        case WebDoor::save:
            stream_.expires_never();
            return host_.save(verdict.path, shared_from_this());
    }
}

void HttpSession::give(const StoredAsset& stored) {
    Response response;
    response.set(http::field::etag, stored.etag);
    response.set(http::field::cache_control, "no-cache");  // ask each time whether it changed
    if (view_of(parser_->get()[http::field::if_none_match]) == stored.etag) {
        response.result(http::status::not_modified);
    } else {
        response.set(
            http::field::content_type,
            beast::string_view(stored.asset.content_type.data(), stored.asset.content_type.size()));
        response.body() = stored.asset.bytes;
    }
    write(std::move(response));
}

void HttpSession::refuse(unsigned status, std::string text) {
    answer({status, "text/plain; charset=utf-8", std::move(text) + '\n', {}});
}

void HttpSession::answer(WebAnswer answer) {
    Response response;
    response.result(answer.status);
    response.set(http::field::content_type, answer.content_type);
    response.set(http::field::cache_control, "no-store");
    if (answer.status == 405) response.set(http::field::allow, "GET");
    if (!answer.file_name.empty()) {
        response.set(http::field::content_disposition,
                     "attachment; filename=\"" + answer.file_name + '"');
    }
    response.body() = std::move(answer.bytes);
    write(std::move(response));
}

void HttpSession::write(Response response) {
    response.version(11);
    response.set(http::field::server, "Lightwalk");
    response.set("Content-Security-Policy", std::string(kContentPolicy) + host_.embedders());
    response.set("X-Content-Type-Options", "nosniff");
    response.set("Referrer-Policy", "no-referrer");  // the address may hold the token
    response.set("Cross-Origin-Resource-Policy", "same-origin");
    response.set("Cross-Origin-Opener-Policy", "same-origin");
    response.keep_alive(keep_alive_);
    if (response.result() != http::status::not_modified) response.prepare_payload();
    response_ = std::move(response);
    stream_.expires_after(limits_.answer);
    http::async_write(stream_, response_,
                      [self = shared_from_this()](beast::error_code error, std::size_t) {
                          self->on_write(error);
                      });
}

void HttpSession::on_write(beast::error_code error) {
    if (!error && keep_alive_) return read();
    if (error) return stream_.close();
    beast::error_code ignored;
    stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
    stream_.expires_after(limits_.close_timeout);
    drain();
}

/// Take what still comes and throw it away: to close with unread bytes would take back the answer.
void HttpSession::drain() {
    received_.clear();
    stream_.async_read_some(received_.prepare(kDrained),
                            [self = shared_from_this()](beast::error_code error, std::size_t) {
                                error ? self->stream_.close() : self->drain();
                            });
}

void HttpSession::stop(const std::string& /*reason*/) {
    stream_.close();
}

}  // namespace lightwalk
