#pragma once
// Where the web server's thread leaves what browsers want, and the drawing thread fetches it.
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "io/net/driver_lock.h"
#include "io/net/walk_reply.h"
#include "io/net/walk_request.h"
#include "io/net/web_server.h"

namespace lightwalk {

/// What the driver wants to see.
struct WalkWish {
    std::optional<ViewRequest> view;  ///< nothing: nobody has asked yet
    DisplayRequest display;
    SettingsRequest settings;
    LightsRequest lights;
    EditsRequest edits;
    TimeRequest time;
    std::vector<ProbePlace> probes;
    bool difference = false;  ///< of a scene beside the walk's: see DifferenceRequest
};

/// What one client asks.
struct WalkQuestion {
    ClientId client;
    std::variant<PickRequest, MeanRequest, GlareRequest, PlanRequest, IsoluxRequest,
                 MaterialRequest>
        ask;
    [[nodiscard]] std::uint32_t id() const {
        return std::visit([](const auto& request) { return request.id; }, ask);
    }
};

/// A frame is on a client's screen.
struct WalkAck {
    ClientId client;
    std::uint32_t frame;
    std::chrono::steady_clock::time_point came;
};

/// All that has come since the last time.
struct InboxContents {
    WalkWish wish;  ///< the newest one
    bool new_probes = false;
    std::vector<WalkQuestion> questions;
    std::vector<WalkAck> acks;
    std::vector<ClientId> joined, left;
    std::vector<ClientId> want_depth, want_luminance;  ///< of those who joined
    std::vector<WebReply> saves;                       ///< who waits for the picture as a file
    std::vector<WebReply> light_saves;                 ///< the same, for the dimmed modifiers
    std::vector<WebReply> material_saves;              ///< the same, for the changed ones
    std::vector<WebReply> sky_saves;                   ///< for the sky of another time
};

/// Answers by itself who drives, and greets; everything else waits in the inbox.
class ClientInbox final : public WebHandler {
  public:
    /// @param welcome  what newcomers are told, but for what is theirs
    explicit ClientInbox(WelcomeReply welcome);
    /// Of a scene beside another one: what is seen, and in which colours, is not for its clients to
    /// say but follows that one (follow()), and all of them are told it as watchers are.
    /// @param start  what is wished for at first
    ClientInbox(WelcomeReply welcome, WalkWish start);

    /// Before the server runs; it must outlive the inbox's use.
    void attach(WebSender& sender) { sender_ = &sender; }

    // For the drawing thread.
    /// Waits for something, so long at most.
    [[nodiscard]] InboxContents pop(std::chrono::milliseconds longest);
    /// Before pop(): what is seen and in which colours, where that follows another walk.
    void follow(const WalkWish& lead);
    /// Only the acknowledgements.
    [[nodiscard]] std::vector<WalkAck> pop_acks();
    /// What becomes of the scene: all are told, and those who come later.
    void announce(std::string text);
    /// What has become of the edits: the same.
    void announce_edits(std::string text);
    /// What has become of files that were edited: all are told.
    /// @param problem  whether newcomers are told, too, until something else is announced of them
    /// @param stage    of the scene from now on, for newcomers; "": as it was
    void announce_files(const std::string& text, bool problem, const std::string& stage);
    void tell(ClientId client, std::string text) { sender_->send_text(client, std::move(text)); }
    void tell_all(const std::string& text);
    void tell_watchers(const std::string& text);
    void send(ClientId client, std::shared_ptr<const std::string> frame) {
        sender_->send_binary(client, std::move(frame));
    }
    /// Who asks, or waits for a file, is told why there is none.
    void refuse(const InboxContents& contents, const std::string& why);
    /// End the connections.
    void close_all(const std::string& why);
    /// What newcomers are told of the scene.
    /// @param home  to go on from after it was read again, or until somebody asks for another view
    void set_views(const View& home, std::vector<NamedView> views);

    // For both.
    [[nodiscard]] WalkWish wish() const;
    [[nodiscard]] bool is_here(ClientId client) const;
    /// Whether who drives has said this session.
    [[nodiscard]] bool is_driver(const std::string& session) const;
    /// Let pop() return.
    void wake();

    // For the server's.
    void opened(ClientId client) override;
    void message(ClientId client, std::string_view text) override;
    void closed(ClientId client) override;
    void save(const std::string& path, WebReply reply) override;

  private:
    /// Throws InputError: all but `hello` come after it.
    void expect_greeted(ClientId client) const;
    void accept(ClientId client, const WalkRequest& request);
    void greet(ClientId client, const HelloRequest& request);
    /// After a request to drive: all are told who does, or the client why nothing changes.
    void change_roles(ClientId client, bool allowed, const std::string& why_not);
    void ask(WalkQuestion question);
    /// To all but one, who may be nobody. Under the mutex.
    void send_to_others(std::optional<ClientId> one, const std::string& text);
    void announce_roles();

    WebSender* sender_ = nullptr;
    mutable std::mutex mutex_;
    std::condition_variable news_;
    bool has_news_ = false;
    bool follows_ = false;  ///< see the constructor
    InboxContents inbox_;
    DriverLock driver_lock_;
    WelcomeReply welcome_;
    std::string stage_;  ///< what was announced last
    std::string files_;  ///< what is wrong with edited files; "": nothing
    std::string edits_;  ///< what was last announced of them; "": nothing
};

}  // namespace lightwalk
