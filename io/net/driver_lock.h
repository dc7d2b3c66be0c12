#pragma once
// The roles of a walk's clients: one drives, the others watch. Data only, no sockets.
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "core/view/view.h"
#include "io/net/web_server.h"

namespace lightwalk {

class DriverLock {
  public:
    /// How many sessions are remembered for clients that return.
    static constexpr std::size_t kMostSessions = 64;

    /// Add a client, after its `hello`. It drives when nobody else does. False when it is here
    /// already.
    bool join(ClientId client, const std::string& session);
    /// Remove a client. When the driver leaves nobody drives until somebody takes over.
    void leave(ClientId client);
    /// Make a client the driver. False when another one is, or this one has not joined.
    bool acquire(ClientId client);
    /// Make `to` the driver in place of `from`. False when `from` does not drive, or `to` has not
    /// joined.
    bool hand(ClientId from, ClientId to);

    [[nodiscard]] std::optional<ClientId> driver() const { return driver_; }
    [[nodiscard]] bool drives(ClientId client) const { return driver_ == client; }
    /// Whether the driver's `hello` had this session.
    [[nodiscard]] bool drives(const std::string& session) const;
    [[nodiscard]] bool is_here(ClientId client) const;
    /// All clients, in the order in which they joined.
    [[nodiscard]] std::vector<ClientId> clients() const;

    /// Store a client's view under its session, for when it returns.
    void remember(ClientId client, const View& view);
    [[nodiscard]] std::optional<View> place(ClientId client) const;

  private:
    struct Member {
        ClientId client;
        std::string session;
    };
    struct Session {
        std::string name;
        std::optional<View> view;
    };
    [[nodiscard]] const Member* member(ClientId client) const;
    [[nodiscard]] const Session* session(ClientId client) const;

    std::vector<Member> members_;
    std::deque<Session> sessions_;  ///< the newest last
    std::optional<ClientId> driver_;
};

}  // namespace lightwalk
