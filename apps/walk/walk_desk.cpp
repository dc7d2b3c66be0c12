#include "apps/walk/walk_desk.h"

#include <algorithm>
#include <utility>

#include "core/error.h"

namespace lightwalk {
namespace {

constexpr std::size_t kMostQuestions = 64;  // that wait

}  // namespace

WalkDesk::WalkDesk(WelcomeReply welcome) : welcome_(std::move(welcome)) {
    inbox_.wish.display = welcome_.display;
    inbox_.wish.settings = welcome_.settings;
}

WalkInbox WalkDesk::take(std::chrono::milliseconds longest) {
    std::unique_lock lock(mutex_);
    news_.wait_for(lock, longest, [&] { return has_news_; });
    has_news_ = false;
    WalkInbox taken;
    std::swap(taken, inbox_);
    inbox_.wish = taken.wish;
    return taken;
}

std::vector<WalkAck> WalkDesk::take_acks() {
    const std::lock_guard lock(mutex_);
    return std::exchange(inbox_.acks, {});
}

void WalkDesk::announce(const LoadingReply& reply) {
    announce_text(walk_text(reply));
}

void WalkDesk::announce(const FailedReply& reply) {
    announce_text(walk_text(reply));
}

void WalkDesk::announce(const LoadedReply& reply) {
    {
        const std::lock_guard lock(mutex_);
        welcome_.views = reply.views;
    }
    announce_text(walk_text(reply));
}

void WalkDesk::announce_text(std::string text) {
    const std::lock_guard lock(mutex_);
    for (const ClientId client : seats_.clients()) server_->send_text(client, text);
    stage_ = std::move(text);
}

void WalkDesk::tell_all(const std::string& text) {
    const std::lock_guard lock(mutex_);
    for (const ClientId client : seats_.clients()) server_->send_text(client, text);
}

void WalkDesk::tell_watchers(const std::string& text) {
    const std::lock_guard lock(mutex_);
    for (const ClientId client : seats_.clients())
        if (!seats_.drives(client)) server_->send_text(client, text);
}

void WalkDesk::set_home(const View& view) {
    const std::lock_guard lock(mutex_);
    welcome_.view = view;
}

void WalkDesk::opened(ClientId) {}

void WalkDesk::message(ClientId client, std::string_view text) {
    const WalkRequest request = parse_walk_request(text, welcome_.max_size);
    const std::lock_guard lock(mutex_);
    if (!std::holds_alternative<HelloRequest>(request) && !seats_.is_here(client))
        throw InputError("the first message must be hello");
    std::visit([&](const auto& message) { accept(client, message); }, request);
    has_news_ = true;
    news_.notify_one();
}

void WalkDesk::closed(ClientId client) {
    const std::lock_guard lock(mutex_);
    if (!seats_.is_here(client)) return;
    seats_.leave(client);
    inbox_.left.push_back(client);
    announce_roles();
    has_news_ = true;
    news_.notify_one();
}

void WalkDesk::save(const std::string& path, WebReply reply) {
    if (path != "/save/picture.hdr") {
        reply({404, "text/plain; charset=utf-8", "there is no such file\n", {}});
        return;
    }
    const std::lock_guard lock(mutex_);
    inbox_.saves.push_back(std::move(reply));
    has_news_ = true;
    news_.notify_one();
}

void WalkDesk::accept(ClientId client, const HelloRequest& request) {
    if (!seats_.join(client, request.session)) throw InputError("hello was said before");
    WelcomeReply welcome = welcome_;
    welcome.you = static_cast<std::uint32_t>(client);
    welcome.driver = seats_.drives(client);
    welcome.display = inbox_.wish.display;
    welcome.settings = inbox_.wish.settings;
    if (const std::optional<View> view = seats_.place(client)) welcome.view = view;
    server_->send_text(client, walk_text(welcome));
    if (!stage_.empty()) server_->send_text(client, stage_);
    announce_roles();
    inbox_.joined.push_back(client);
}

void WalkDesk::accept(ClientId client, const ViewRequest& request) {
    if (!seats_.drives(client)) return;
    inbox_.wish.view = request;
    seats_.remember(client, request.view);
}

void WalkDesk::accept(ClientId client, const AckRequest& request) {
    inbox_.acks.push_back({client, request.frame, std::chrono::steady_clock::now()});
}

void WalkDesk::accept(ClientId client, const DisplayRequest& request) {
    if (!seats_.drives(client)) return;
    inbox_.wish.display = request;
    for (const ClientId other : seats_.clients())
        if (other != client) server_->send_text(other, walk_text(DisplayReply{request}));
}

void WalkDesk::accept(ClientId client, const SettingsRequest& request) {
    if (seats_.drives(client)) inbox_.wish.settings = request;
}

void WalkDesk::accept(ClientId client, const ProbesRequest& request) {
    if (!seats_.drives(client)) return;
    inbox_.wish.probes = request.probes;
    inbox_.new_probes = true;
}

void WalkDesk::accept(ClientId client, const TakeRequest&) {
    if (seats_.take(client))
        announce_roles();
    else
        server_->send_text(client, walk_text(RefusedReply{"somebody else drives", {}}));
}

void WalkDesk::accept(ClientId client, const HandRequest& request) {
    if (seats_.hand(client, ClientId{request.to}))
        announce_roles();
    else
        server_->send_text(client, walk_text(RefusedReply{"only the driver hands over", {}}));
}

void WalkDesk::ask(WalkQuestion question) {
    if (inbox_.questions.size() < kMostQuestions) {
        inbox_.questions.push_back(question);
        return;
    }
    const std::uint32_t id = std::visit([](const auto& ask) { return ask.id; }, question.ask);
    server_->send_text(question.client, walk_text(RefusedReply{"too many questions", id}));
}

void WalkDesk::announce_roles() {
    RoleReply reply;
    for (const ClientId client : seats_.clients())
        reply.clients.push_back(static_cast<std::uint32_t>(client));
    if (seats_.driver()) reply.driver_id = static_cast<std::uint32_t>(*seats_.driver());
    for (const ClientId client : seats_.clients()) {
        reply.driver = seats_.drives(client);
        server_->send_text(client, walk_text(reply));
    }
}

}  // namespace lightwalk
