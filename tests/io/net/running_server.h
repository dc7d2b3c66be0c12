#pragma once
// A web server on a thread of its own, whose handler echoes messages and records events.
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "core/error.h"
#include "io/net/web_server.h"

namespace lightwalk::test {

/// Echoes messages; the message "wrong" counts as malformed. /save/now is answered at once,
/// /save/later by another thread, /save/never not at all, /save/wrong by an error; requests for
/// other paths are kept for the test.
class EchoHandler final : public WebHandler {
  public:
    WebServer* server = nullptr;

    ~EchoHandler() override {
        if (later_.joinable()) later_.join();
    }
    void opened(ClientId client) override {
        change([&] { open_.insert(client); });
    }
    void message(ClientId client, std::string_view text) override {
        if (text == "wrong") throw InputError("malformed: wrong");
        server->send_text(client, "echo " + std::string(text));
    }
    void closed(ClientId client) override {
        change([&] {
            if (open_.erase(client) == 1) ++closed_;
        });
    }
    void save(const std::string& path, WebReply reply) override {
        if (path == "/save/wrong") throw InputError("there is no scene yet");
        if (path == "/save/never") return;
        const WebAnswer picture{200, "image/vnd.radiance", "#?RADIANCE", "picture.hdr"};
        if (path == "/save/now") return reply(picture);
        if (path == "/save/later") {
            later_ = std::thread([reply, picture] { reply(picture); });
            return;
        }
        change([&] { kept_.push_back(std::move(reply)); });
    }

    [[nodiscard]] std::set<ClientId> open() const {
        const std::lock_guard lock(mutex_);
        return open_;
    }
    /// Wait until so many clients are open and so many have closed, at most ten seconds.
    [[nodiscard]] bool wait(std::size_t open, std::size_t closed) const {
        return wait_for([&] { return open_.size() == open && closed_ == closed; });
    }
    [[nodiscard]] bool wait_for_kept(std::size_t replies) const {
        return wait_for([&] { return kept_.size() == replies; });
    }
    [[nodiscard]] std::vector<WebReply> take_kept() {
        const std::lock_guard lock(mutex_);
        return std::exchange(kept_, {});
    }

  private:
    void change(const std::function<void()>& what) {
        const std::lock_guard lock(mutex_);
        what();
        changed_.notify_all();
    }
    [[nodiscard]] bool wait_for(const std::function<bool()>& what) const {
        std::unique_lock lock(mutex_);
        return changed_.wait_for(lock, std::chrono::seconds(10), what);
    }

    mutable std::mutex mutex_;
    mutable std::condition_variable changed_;
    std::set<ClientId> open_;
    std::size_t closed_ = 0;
    std::vector<WebReply> kept_;
    std::thread later_;
};

class RunningServer {
  public:
    explicit RunningServer(WebLimits limits = {}, std::string token = "")
        : server_({"127.0.0.1", 0, std::move(token), limits}, assets(), handler) {
        handler.server = &server_;
        thread_ = std::thread([this] { server_.run(); });
    }
    ~RunningServer() { stop(); }
    RunningServer(const RunningServer&) = delete;
    RunningServer& operator=(const RunningServer&) = delete;

    WebServer& operator*() { return server_; }
    WebServer* operator->() { return &server_; }
    [[nodiscard]] std::uint16_t port() const { return server_.port(); }
    void stop(const std::string& reason = "the test ends") {
        if (!thread_.joinable()) return;
        server_.stop(reason);
        thread_.join();
    }

    EchoHandler handler;

  private:
    static std::vector<WebAsset> assets() {
        return {{"/", "text/html; charset=utf-8", "<!doctype html><title>walk</title>"},
                {"/page/walk.js", "text/javascript; charset=utf-8", "export const walk = 1;"}};
    }

    WebServer server_;
    std::thread thread_;
};

}  // namespace lightwalk::test
