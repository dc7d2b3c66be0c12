#pragma once
// Who sits where in a walk: one client drives, the others watch. Values alone.
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "core/view/view.h"
#include "io/net/web_server.h"

namespace lightwalk {

class DriverLock {
  public:
    /// Walks that are remembered for clients that return.
    static constexpr std::size_t kMostSessions = 64;

    /// A client says hello. It drives when nobody else does. False: it has said so before.
    bool join(ClientId client, const std::string& session);
    /// Nobody drives when the driver leaves, until somebody takes over.
    void leave(ClientId client);
    /// A watcher wants to drive. False: somebody does, or it has not said hello.
    bool acquire(ClientId client);
    /// The driver hands over. False: it does not drive, or the other is not there.
    bool hand(ClientId from, ClientId to);

    [[nodiscard]] std::optional<ClientId> driver() const { return driver_; }
    [[nodiscard]] bool drives(ClientId client) const { return driver_ == client; }
    [[nodiscard]] bool is_here(ClientId client) const;
    /// All that have said hello, in that order.
    [[nodiscard]] std::vector<ClientId> clients() const;

    /// Where a client stands, for when it returns.
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
