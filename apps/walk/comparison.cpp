#include "apps/walk/comparison.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "apps/session/local_backend.h"
#include "apps/walk/scene_changer.h"
#include "core/error.h"

namespace lightwalk {
namespace {

constexpr double kTurnShare = 0.5;  // of the time, for each
constexpr std::chrono::milliseconds kTurn{
    8};  // that one waits for news while the other may have some

bool is_ready(const std::future<Renderer>& made) {
    return made.valid() && made.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

struct Comparison::Side {
    explicit Side(std::shared_ptr<ClientInbox> to) : inbox(std::move(to)) {}

    const std::shared_ptr<ClientInbox> inbox;
    WalkStart start;
    // In this order: each uses those above it.
    std::future<Renderer> making;  ///< not valid: it is made, or was not to be made
    std::optional<Renderer> renderer;
    std::optional<WalkScreen> screen;
    std::optional<RenderLoop> loop;  ///< nothing: not made yet, or not to be made
};

Comparison::Comparison(ComparisonOptions options, WalkReception& reception, WelcomeReply welcome,
                       RenderLoop& lead, const WalkScreen& lead_screen,
                       std::function<const SceneSession&()> session, Executor& executor,
                       WarningSink& warnings)
    : options_(std::move(options)),
      reception_(reception),
      lead_(lead),
      lead_screen_(lead_screen),
      session_(std::move(session)),
      executor_(executor),
      warnings_(warnings) {
    options_.request.options.ambient_file.clear();  // which is the walk's
    welcome.views.clear();
    if (!options_.scene.empty()) welcome.scene = options_.scene;
    reception_.open(std::move(welcome), options_.scene.empty());
}

Comparison::~Comparison() {
    reception_.close("the scene is read again");
    end();
}

void Comparison::step(const StopFlag& stop) {
    const bool draws = side_ && side_->loop;
    lead_.step(stop, draws ? std::min(side_->loop->patience(), kTurn) : RenderLoop::kMoment);
    std::shared_ptr<ClientInbox> wanted = reception_.beside();
    if (side_ && side_->inbox != wanted) end();
    if (!wanted || stop.requested() || is_leaving()) return;
    if (!side_) begin(std::move(wanted));
    if (is_ready(side_->making)) enter(*side_);
    draw(*side_, stop);
}

/// It is made beside the frames of the walk, which go on.
void Comparison::begin(std::shared_ptr<ClientInbox> inbox) {
    side_ = std::make_unique<Side>(std::move(inbox));
    if (!options_.scene.empty()) {
        side_->inbox->announce(walk_text(LoadingReply{"reading " + options_.scene, kTurnShare}));
        side_->making = std::async(std::launch::async,
                                   [request = options_.request] { return open_renderer(request); });
        return;
    }
    side_->start = lead_.present();
    side_->making = std::async(std::launch::async, [scene = session_().shared_compiled(),
                                                    options = options_.request.options]() mutable {
        options.warn = {};  // what is to be said of it has been said
        return Renderer(std::make_unique<LocalBackend>(std::move(scene), std::move(options)));
    });
}

void Comparison::end() {
    if (side_ && side_->making.valid()) left_ = std::move(side_->making);
    side_.reset();
    lead_.share_time(1);
}

bool Comparison::is_leaving() {
    if (is_ready(left_)) left_ = {};
    return left_.valid();
}

void Comparison::enter(Side& side) {
    try {
        side.renderer = side.making.get();
    } catch (const InputError& error) {
        return fail(side, error.what());
    }
    RenderBackend& backend = side.renderer->backend();
    RenderLoopOptions options = options_.loop;
    options.change = scene_changer(backend);
    options.start = std::move(side.start);
    const EditedReply edited = options.start.edits.reply;
    side.screen.emplace(executor_);
    side.loop.emplace(std::move(options), backend.session(), options_.home, backend.frames(),
                      executor_, warnings_, *side.inbox, *side.screen);
    side.loop->share_time(kTurnShare);
    lead_.share_time(kTurnShare);
    LoadedReply loaded;
    loaded.eye_height = side.loop->eye_height();
    loaded.time = side.loop->time_place();
    if (const auto& groups = backend.frames().light_groups()) loaded.lights = groups->names;
    side.inbox->announce(walk_text(loaded));
    if (!edited.materials.empty()) side.inbox->announce_edits(walk_text(edited));
}

void Comparison::draw(Side& side, const StopFlag& stop) {
    if (side.making.valid()) return;
    if (!side.loop)
        return side.inbox->refuse(side.inbox->pop(std::chrono::milliseconds(0)),
                                  "there is no scene beside the walk's");
    const WalkWish seen = lead_.seen();
    const LivePicture* const picture = lead_.picture();
    if (!seen.view || picture == nullptr) return;
    side.inbox->follow(seen);
    side.screen->follow(&lead_screen_, side.inbox->wish().difference ? picture : nullptr);
    try {
        side.loop->step(stop, std::min(lead_.patience(), kTurn));
    } catch (const InputError& error) {
        fail(side, error.what());
    }
}

void Comparison::fail(Side& side, const std::string& why) {
    side.loop.reset();
    side.screen.reset();
    side.renderer.reset();
    side.inbox->announce(walk_text(FailedReply{{why}}));
}

}  // namespace lightwalk
