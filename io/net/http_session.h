#pragma once
// One HTTP connection of the web server: request by request, until it ends or becomes a WebSocket.
#include <memory>
#include <optional>
#include <string>

#include "io/net/client_session.h"

namespace lightwalk {

/// An asset with its ETag, by which browsers ask whether it has changed.
struct StoredAsset {
    WebAsset asset;
    std::string etag;
};

class HttpSession;

/// What an HTTP session needs of the server.
class HttpHost {
  public:
    virtual ~HttpHost() = default;
    [[nodiscard]] virtual const std::string& token() const = 0;
    /// Who may show the page within another one, in the words of a content security policy.
    [[nodiscard]] virtual std::string embedders() const = 0;
    [[nodiscard]] virtual const StoredAsset* asset(const std::string& path) const = 0;
    [[nodiscard]] virtual bool room_for_client() const = 0;
    virtual void upgrade(boost::beast::tcp_stream stream, const HttpRequest& request) = 0;
    /// Keep `session`, which waits for a call of its answer().
    virtual void save(const std::string& path, std::shared_ptr<HttpSession> session) = 0;
};

/// All member functions must be called on the server's thread.
class HttpSession final : public Connection, public std::enable_shared_from_this<HttpSession> {
  public:
    HttpSession(boost::asio::ip::tcp::socket socket, const WebLimits& limits, HttpHost& host,
                List& list);

    /// Wait for a request.
    void read();
    /// Answer the request that was passed to HttpHost::save().
    void answer(WebAnswer answer);
    void stop(const std::string& reason) override;

  private:
    using Response = boost::beast::http::response<boost::beast::http::string_body>;
    void on_read(boost::beast::error_code error);
    void decide();
    void give(const StoredAsset& stored);
    void refuse(unsigned status, std::string text);
    void write(Response response);
    void on_write(boost::beast::error_code error);
    void drain();

    boost::beast::tcp_stream stream_;
    boost::beast::flat_buffer received_;
    std::optional<boost::beast::http::request_parser<boost::beast::http::empty_body>> parser_;
    Response response_;
    const WebLimits& limits_;
    HttpHost& host_;
    bool keep_alive_ = false;
};

}  // namespace lightwalk
