#pragma once
// The head of a walk: a process that draws nothing and serves the page, while others, the run, draw
// and may be lost. Pages stay connected to it; it passes on what they and the run say.
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "io/net/web_server.h"

namespace lightwalk {

/// Serves from construction on, on threads of its own.
class WalkHead {
  public:
    /// @param options  the token is demanded where the address is not this machine's alone
    /// @param why  what pages are told that come before there is a run
    /// Throws InputError "address:port: why" when it cannot listen there.
    WalkHead(const WebServerOptions& options, const std::string& why);
    /// Pages are told that the server ends.
    ~WalkHead();
    WalkHead(const WalkHead&) = delete;
    WalkHead& operator=(const WalkHead&) = delete;

    /// The address to open in a browser.
    [[nodiscard]] std::string url() const;
    /// A run's web server has begun to listen: all pages are connected to it, whoever drove first.
    void begin_run(const std::string& host, std::uint16_t port, const std::string& token);
    /// The run is lost, or ends: pages are told, and wait for the next one.
    /// @param why  in words for users
    void end_run(const std::string& why);
    /// How long nobody has asked for anything, by moving or otherwise.
    [[nodiscard]] std::chrono::duration<double> quiet() const;
    /// One of its threads could not go on: it has said why, and told this process to end.
    [[nodiscard]] bool failed() const;

  private:
    class Core;
    std::unique_ptr<Core> core_;
};

}  // namespace lightwalk
