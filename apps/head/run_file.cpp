#include "apps/head/run_file.h"

#include <memory>
#include <utility>

namespace lightwalk {
namespace {

namespace beast = boost::beast;
namespace http = boost::beast::http;

constexpr std::chrono::seconds kPatience{60};
constexpr std::size_t kLargestFile = std::size_t{256} * 1024 * 1024;  // pictures; [bytes]

/// Lives as long as an operation of it is under way. What comes in between drops the reply, which
/// is a 503.
class RunFile final : public std::enable_shared_from_this<RunFile> {
  public:
    RunFile(boost::asio::io_context& context, const RunPlace& place, const std::string& path,
            WebReply reply)
        : stream_(context), reply_(std::move(reply)) {
        request_ = {http::verb::get, path + "?token=" + place.token, 11};
        request_.set(http::field::host, "localhost");
        request_.keep_alive(false);
        parser_.body_limit(kLargestFile);
    }

    void fetch(const RunPlace& place) {
        stream_.expires_after(kPatience);
        stream_.async_connect(place.endpoints, [self = shared_from_this()](beast::error_code error,
                                                                           const auto& /*at*/) {
            if (!error) self->ask();
        });
    }

  private:
    void ask() {
        http::async_write(stream_, request_,
                          [self = shared_from_this()](beast::error_code error, std::size_t) {
                              if (!error) self->read();
                          });
    }

    void read() {
        http::async_read(stream_, received_, parser_,
                         [self = shared_from_this()](beast::error_code error, std::size_t) {
                             if (!error) self->answer();
                         });
    }

    void answer() {
        auto response = parser_.release();
        WebAnswer answer;
        answer.status = response.result_int();
        answer.content_type = std::string(response[http::field::content_type]);
        const std::string disposition(response[http::field::content_disposition]);
        const std::string before = "filename=\"";
        const std::size_t at = disposition.find(before);
        if (at != std::string::npos)
            answer.file_name =
                disposition.substr(at + before.size(), disposition.size() - at - before.size() - 1);
        answer.bytes = std::move(response.body());
        reply_(std::move(answer));
    }

    beast::tcp_stream stream_;
    beast::flat_buffer received_;
    http::request<http::empty_body> request_;
    http::response_parser<http::string_body> parser_;
    WebReply reply_;
};

}  // namespace

void fetch_run_file(boost::asio::io_context& context, const RunPlace& place,
                    const std::string& path, WebReply reply) {
    std::make_shared<RunFile>(context, place, path, std::move(reply))->fetch(place);
}

}  // namespace lightwalk
