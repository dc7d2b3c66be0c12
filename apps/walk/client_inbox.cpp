#include "apps/walk/client_inbox.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/math/overloaded.h"

namespace lightwalk {
namespace {

constexpr std::size_t kMostQuestions = 64;  // that wait

}  // namespace

ClientInbox::ClientInbox(WelcomeReply welcome) : welcome_(std::move(welcome)) {
    inbox_.wish.display = welcome_.display;
    inbox_.wish.settings = welcome_.settings;
}

ClientInbox::ClientInbox(WelcomeReply welcome, WalkWish start)
    : follows_(true), welcome_(std::move(welcome)) {
    inbox_.wish = std::move(start);
}

void ClientInbox::follow(const WalkWish& lead) {
    const std::lock_guard lock(mutex_);
    inbox_.wish.view = lead.view;
    inbox_.wish.display = lead.display;
    inbox_.wish.settings = lead.settings;
}

WalkWish ClientInbox::wish() const {
    const std::lock_guard lock(mutex_);
    return inbox_.wish;
}

bool ClientInbox::is_here(ClientId client) const {
    const std::lock_guard lock(mutex_);
    return driver_lock_.is_here(client);
}

bool ClientInbox::is_driver(const std::string& session) const {
    const std::lock_guard lock(mutex_);
    return driver_lock_.drives(session);
}

void ClientInbox::wake() {
    const std::lock_guard lock(mutex_);
    has_news_ = true;
    news_.notify_one();
}

InboxContents ClientInbox::pop(std::chrono::milliseconds longest) {
    std::unique_lock lock(mutex_);
    news_.wait_for(lock, longest, [&] { return has_news_; });
    has_news_ = false;
    InboxContents taken;
    std::swap(taken, inbox_);
    inbox_.wish = taken.wish;
    return taken;
}

std::vector<WalkAck> ClientInbox::pop_acks() {
    const std::lock_guard lock(mutex_);
    return std::exchange(inbox_.acks, {});
}

void ClientInbox::send_to_others(std::optional<ClientId> one, const std::string& text) {
    for (const ClientId client : driver_lock_.clients())
        if (client != one) sender_->send_text(client, text);
}

void ClientInbox::announce(std::string text) {
    const std::lock_guard lock(mutex_);
    send_to_others(std::nullopt, text);
    stage_ = std::move(text);
    files_.clear();
}

void ClientInbox::announce_files(const std::string& text, bool problem, const std::string& stage) {
    const std::lock_guard lock(mutex_);
    send_to_others(std::nullopt, text);
    if (!stage.empty()) stage_ = stage;
    files_ = problem ? text : std::string();
}

void ClientInbox::announce_edits(std::string text) {
    const std::lock_guard lock(mutex_);
    send_to_others(std::nullopt, text);
    edits_ = std::move(text);
}

void ClientInbox::tell_all(const std::string& text) {
    const std::lock_guard lock(mutex_);
    send_to_others(std::nullopt, text);
}

void ClientInbox::tell_watchers(const std::string& text) {
    const std::lock_guard lock(mutex_);
    send_to_others(follows_ ? std::nullopt : driver_lock_.driver(), text);
}

void ClientInbox::refuse(const InboxContents& contents, const std::string& why) {
    for (const std::vector<WebReply>* waiting :
         {&contents.saves, &contents.light_saves, &contents.material_saves, &contents.sky_saves})
        for (const WebReply& reply : *waiting)
            reply({503, "text/plain; charset=utf-8", why + '\n', {}});
    for (const WalkQuestion& question : contents.questions)
        tell(question.client, walk_text(RefusedReply{why, question.id()}));
}

void ClientInbox::close_all(const std::string& why) {
    const std::lock_guard lock(mutex_);
    for (const ClientId client : driver_lock_.clients()) sender_->close(client, why);
}

void ClientInbox::set_views(const View& home, std::vector<NamedView> views) {
    const std::lock_guard lock(mutex_);
    welcome_.view = home;
    welcome_.views = std::move(views);
}

void ClientInbox::opened(ClientId) {}

void ClientInbox::message(ClientId client, std::string_view text) {
    try {
        const WalkRequest request = parse_walk_request(text, welcome_.max_size);
        const std::lock_guard lock(mutex_);
        if (!std::holds_alternative<HelloRequest>(request)) expect_greeted(client);
        accept(client, request);
        has_news_ = true;
        news_.notify_one();
    } catch (const UndrawableView& error) {
        const std::lock_guard lock(mutex_);
        expect_greeted(client);
        RefusedReply refusal{std::string("The view cannot be drawn: ") + error.what(), {}};
        (error.kind() == UndrawableView::Kind::view ? refusal.view : refusal.id) = error.id();
        sender_->send_text(client, walk_text(refusal));
    }
}

void ClientInbox::expect_greeted(ClientId client) const {
    if (!driver_lock_.is_here(client)) throw InputError("the first message must be hello");
}

/// What steers the walk counts from the driver alone.
void ClientInbox::accept(ClientId client, const WalkRequest& request) {
    WalkWish& wish = inbox_.wish;
    const bool drives = driver_lock_.drives(client);
    std::visit(Overloaded{[&](const HelloRequest& hello) { greet(client, hello); },
                          [&](const ViewRequest& view) {
                              if (!drives || follows_) return;
                              wish.view = view;
                              driver_lock_.remember(client, view.seen.value_or(view.view));
                          },
                          [&](const DisplayRequest& display) {
                              if (!drives || follows_) return;
                              wish.display = display;
                              send_to_others(client, walk_text(DisplayReply{display}));
                          },
                          [&](const SettingsRequest& settings) {
                              if (drives && !follows_) wish.settings = settings;
                          },
                          [&](const LightsRequest& lights) {
                              if (!drives) return;
                              wish.lights = lights;
                              send_to_others(client, walk_text(LightsReply{lights}));
                          },
                          [&](const EditsRequest& edits) {
                              if (drives) wish.edits = edits;
                          },
                          [&](const TimeRequest& time) {
                              if (drives) wish.time = time;
                          },
                          [&](const DifferenceRequest& difference) {
                              if (drives && follows_) wish.difference = difference.shown;
                          },
                          [&](const ProbesRequest& pins) {
                              if (!drives) return;
                              wish.probes = pins.probes;
                              inbox_.new_probes = true;
                          },
                          [&](const AckRequest& ack) {
                              const auto now = std::chrono::steady_clock::now();
                              inbox_.acks.push_back({client, ack.frame, now});
                          },
                          [&](const PickRequest& pick) {
                              ask({client, pick});
                          },
                          [&](const MeanRequest& mean) {
                              ask({client, mean});
                          },
                          [&](const GlareRequest& glare) {
                              ask({client, glare});
                          },
                          [&](const PlanRequest& plan) {
                              ask({client, plan});
                          },
                          [&](const IsoluxRequest& isolux) {
                              ask({client, isolux});
                          },
                          [&](const MaterialRequest& material) {
                              ask({client, material});
                          },
                          [&](const TakeRequest&) {
                              change_roles(client, driver_lock_.acquire(client),
                                           "somebody else drives");
                          },
                          [&](const HandRequest& hand) {
                              change_roles(client, driver_lock_.hand(client, ClientId{hand.to}),
                                           "only the driver hands over");
                          }},
               request);
}

void ClientInbox::closed(ClientId client) {
    const std::lock_guard lock(mutex_);
    if (!driver_lock_.is_here(client)) return;
    driver_lock_.leave(client);
    inbox_.left.push_back(client);
    announce_roles();
    has_news_ = true;
    news_.notify_one();
}

void ClientInbox::save(const std::string& path, WebReply reply) {
    std::vector<WebReply>* const waiting = path == "/save/picture.hdr"     ? &inbox_.saves
                                           : path == "/save/lights.rad"    ? &inbox_.light_saves
                                           : path == "/save/materials.rad" ? &inbox_.material_saves
                                           : path == "/save/sky.rad"       ? &inbox_.sky_saves
                                                                           : nullptr;
    if (waiting == nullptr) {
        reply({404, "text/plain; charset=utf-8", "there is no such file\n", {}});
        return;
    }
    const std::lock_guard lock(mutex_);
    waiting->push_back(std::move(reply));
    has_news_ = true;
    news_.notify_one();
}

void ClientInbox::greet(ClientId client, const HelloRequest& request) {
    if (!driver_lock_.join(client, request.session)) throw InputError("hello was sent before");
    WelcomeReply welcome = welcome_;
    welcome.you = static_cast<std::uint32_t>(client);
    welcome.driver = driver_lock_.drives(client);
    welcome.display = inbox_.wish.display;
    welcome.settings = inbox_.wish.settings;
    if (const std::optional<View> view = driver_lock_.place(client)) welcome.view = view;
    sender_->send_text(client, walk_text(welcome));
    if (!stage_.empty()) sender_->send_text(client, stage_);
    if (!inbox_.wish.lights.levels.empty())
        sender_->send_text(client, walk_text(LightsReply{inbox_.wish.lights}));
    if (!edits_.empty()) sender_->send_text(client, edits_);
    if (!files_.empty()) sender_->send_text(client, files_);
    announce_roles();
    inbox_.joined.push_back(client);
    if (request.depth) inbox_.want_depth.push_back(client);
    if (request.luminance) inbox_.want_luminance.push_back(client);
}

void ClientInbox::change_roles(ClientId client, bool allowed, const std::string& why_not) {
    if (allowed)
        announce_roles();
    else
        sender_->send_text(client, walk_text(RefusedReply{why_not, {}}));
}

void ClientInbox::ask(WalkQuestion question) {
    if (inbox_.questions.size() < kMostQuestions) return inbox_.questions.push_back(question);
    sender_->send_text(
        question.client,
        walk_text(RefusedReply{"too many requests are waiting for an answer", question.id()}));
}

void ClientInbox::announce_roles() {
    RoleReply reply;
    for (const ClientId client : driver_lock_.clients())
        reply.clients.push_back(static_cast<std::uint32_t>(client));
    if (driver_lock_.driver()) reply.driver_id = static_cast<std::uint32_t>(*driver_lock_.driver());
    for (const ClientId client : driver_lock_.clients()) {
        reply.driver = driver_lock_.drives(client);
        sender_->send_text(client, walk_text(reply));
    }
}

}  // namespace lightwalk
