#pragma once
// A second state of a walk's scene, or another scene, that its driver sees beside it from the same
// eye: drawn in turn with the walk's, on the same threads. It is there while somebody compares.
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "apps/session/lightwalk/ranks.h"
#include "apps/walk/render_loop.h"
#include "apps/walk/walk_reception.h"

namespace lightwalk {

struct ComparisonOptions {
    RenderLoopOptions loop;  ///< as the walk's
    RendererRequest
        request;        ///< how the walk's scene is rendered; its source counts for another one
    std::string scene;  ///< the other one's files, for the page; "": it begins as the walk's is
    View home;          ///< of the walk
};

/// For the thread that draws.
class Comparison {
  public:
    /// All must outlive this.
    /// @param lead, lead_screen  of the walk
    /// @param session            of the walk's scene, at present
    Comparison(ComparisonOptions options, WalkReception& reception, WelcomeReply welcome,
               RenderLoop& lead, const WalkScreen& lead_screen,
               std::function<const SceneSession&()> session, Executor& executor,
               WarningSink& warnings);
    ~Comparison();
    Comparison(const Comparison&) = delete;
    Comparison& operator=(const Comparison&) = delete;

    /// A step of the walk, and where somebody compares one of the scene beside.
    void step(const StopFlag& stop);

    /// The walk's scene is another one, as its files were edited: one that began as it was begins
    /// anew, as what its client wants of it.
    void follow() {
        if (options_.scene.empty()) end();
    }

  private:
    /// What is there while somebody compares.
    struct Side;

    void begin(std::shared_ptr<ClientInbox> inbox);
    void end();
    /// Whether one that nobody has waited for is still being made: it is no use to stop for it.
    [[nodiscard]] bool is_leaving();
    [[nodiscard]] Renderer make_renderer();
    void enter(Side& side);
    void draw(Side& side, const StopFlag& stop);
    /// It cannot be drawn: its client is told why.
    static void fail(Side& side, const std::string& why);

    ComparisonOptions options_;
    WalkReception& reception_;
    RenderLoop& lead_;
    const WalkScreen& lead_screen_;
    std::function<const SceneSession&()> session_;
    Executor& executor_;
    WarningSink& warnings_;
    std::unique_ptr<Side> side_;
    std::future<Renderer> left_;  ///< of one that nobody has waited for; not valid: there is none
};

}  // namespace lightwalk
