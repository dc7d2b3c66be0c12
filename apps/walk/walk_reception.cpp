#include "apps/walk/walk_reception.h"

#include <optional>
#include <utility>
#include <variant>

#include "core/error.h"

namespace lightwalk {
namespace {

/// The session of a first message that asks for the scene beside; nothing for any other text.
std::optional<std::string> session_beside(std::string_view text) {
    try {
        const WalkRequest request = parse_walk_request(text);
        const auto* const hello = std::get_if<HelloRequest>(&request);
        if (hello != nullptr && hello->beside) return hello->session;
    } catch (const InputError&) {  // which the walk's inbox tells
    }
    return std::nullopt;
}

}  // namespace

void WalkReception::attach(WebSender& sender) {
    sender_ = &sender;
    walk_.attach(sender);
}

void WalkReception::open(WelcomeReply welcome, bool copies) {
    const std::lock_guard lock(mutex_);
    welcome_ = std::move(welcome);
    copies_ = copies;
    refusal_.clear();
}

void WalkReception::close(const std::string& why) {
    const std::lock_guard lock(mutex_);
    refusal_ = why;
    dismiss(why);
}

void WalkReception::dismiss(const std::string& why) {
    if (!beside_) return;
    sender_->close(client_, why);
    beside_.reset();
}

std::shared_ptr<ClientInbox> WalkReception::beside() const {
    const std::lock_guard lock(mutex_);
    return beside_;
}

std::shared_ptr<ClientInbox> WalkReception::inbox_of(ClientId client) const {
    const std::lock_guard lock(mutex_);
    return beside_ && client_ == client ? beside_ : nullptr;
}

void WalkReception::opened(ClientId client) {
    walk_.opened(client);
}

void WalkReception::message(ClientId client, std::string_view text) {
    if (const auto beside = inbox_of(client)) return beside->message(client, text);
    if (!walk_.is_here(client))
        if (const auto session = session_beside(text)) return admit(client, text, *session);
    walk_.message(client, text);
    check_driver();
}

void WalkReception::admit(ClientId client, std::string_view text, const std::string& session) {
    std::shared_ptr<ClientInbox> made;  // whoever drives may send it away at any time
    {
        const std::lock_guard lock(mutex_);
        if (!refusal_.empty()) throw InputError(refusal_);
        if (!walk_.is_driver(session))
            throw InputError("a scene beside the walk's is for who drives");
        if (beside_) throw InputError("there is a scene beside the walk's already");
        WalkWish start = walk_.wish();
        start.probes.clear();
        if (!copies_) {
            start.lights = {};
            start.edits = {};
            start.time = {};
        }
        made = beside_ = std::make_shared<ClientInbox>(welcome_, std::move(start));
        made->attach(*sender_);
        client_ = client;
        session_ = session;
    }
    made->message(client, text);
    walk_.wake();
}

/// Who drives no more has nothing to compare.
void WalkReception::check_driver() {
    const std::lock_guard lock(mutex_);
    if (beside_ && !walk_.is_driver(session_))
        dismiss("a scene beside the walk's is for who drives");
}

void WalkReception::closed(ClientId client) {
    {
        const std::lock_guard lock(mutex_);
        if (beside_ && client_ == client) {
            beside_->closed(client);
            beside_.reset();
            return;
        }
    }
    walk_.closed(client);
    check_driver();
}

void WalkReception::save(const std::string& path, WebReply reply) {
    constexpr std::string_view kBeside = "/save/beside/";
    if (!path.starts_with(kBeside)) return walk_.save(path, std::move(reply));
    const std::shared_ptr<ClientInbox> inbox = beside();
    if (!inbox) throw InputError("there is no scene beside the walk's");
    inbox->save("/save/" + path.substr(kBeside.size()), std::move(reply));
}

}  // namespace lightwalk
