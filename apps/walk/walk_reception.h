#pragma once
// Whom a walk's clients have come to: to the walk, or to the scene that its driver sees beside it.
#include <memory>
#include <mutex>
#include <string>

#include "apps/walk/client_inbox.h"

namespace lightwalk {

/// Hands each client's messages to the inbox that it has come to. The scene beside has one client,
/// who has said the session of the walk's driver, and who goes when that one drives no more.
class WalkReception final : public WebHandler {
  public:
    /// @param walk  must outlive this
    explicit WalkReception(ClientInbox& walk) : walk_(walk) {}

    /// Before the server runs; it must outlive the use of this, and of the inbox.
    void attach(WebSender& sender);

    // For the drawing thread.
    /// From now on there may be a scene beside the walk's.
    /// @param welcome  as for ClientInbox
    /// @param copies   whether it begins as the walk's is, not as another one is
    void open(WelcomeReply welcome, bool copies);
    /// There may be none any more; who has come for it is sent away.
    void close(const std::string& why);
    /// What its client wants; null: nobody has come for it, or has gone again.
    [[nodiscard]] std::shared_ptr<ClientInbox> beside() const;

    // For the server's.
    void opened(ClientId client) override;
    void message(ClientId client, std::string_view text) override;
    void closed(ClientId client) override;
    /// `/save/beside/NAME` is the file of the scene beside.
    void save(const std::string& path, WebReply reply) override;

  private:
    [[nodiscard]] std::shared_ptr<ClientInbox> inbox_of(ClientId client) const;
    void admit(ClientId client, std::string_view text, const std::string& session);
    void check_driver();
    /// Under the mutex.
    void dismiss(const std::string& why);

    ClientInbox& walk_;
    WebSender* sender_ = nullptr;
    mutable std::mutex mutex_;
    WelcomeReply welcome_;
    bool copies_ = true;
    std::string refusal_ = "there is no scene";  ///< why there can be none; "": there can
    std::shared_ptr<ClientInbox> beside_;        ///< null: nobody has come
    ClientId client_{};                          ///< of that
    std::string session_;                        ///< its driver's
};

}  // namespace lightwalk
