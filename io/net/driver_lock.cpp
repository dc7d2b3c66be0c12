#include "io/net/driver_lock.h"

#include <algorithm>

namespace lightwalk {

bool DriverLock::join(ClientId client, const std::string& session) {
    if (is_here(client)) return false;
    members_.push_back({client, session});
    const auto known = std::find_if(sessions_.begin(), sessions_.end(),
                                    [&](const Session& s) { return s.name == session; });
    if (known == sessions_.end()) {
        if (sessions_.size() == kMostSessions) sessions_.pop_front();
        sessions_.push_back({session, std::nullopt});
    }
    // Who returns before the old connection is known to be lost is still the same.
    if (!driver_ || drives(session)) driver_ = client;
    return true;
}

void DriverLock::leave(ClientId client) {
    std::erase_if(members_, [&](const Member& member) { return member.client == client; });
    if (driver_ == client) driver_.reset();
}

bool DriverLock::acquire(ClientId client) {
    if (driver_ || !is_here(client)) return false;
    driver_ = client;
    return true;
}

bool DriverLock::hand(ClientId from, ClientId to) {
    if (driver_ != from || !is_here(to)) return false;
    driver_ = to;
    return true;
}

bool DriverLock::drives(const std::string& session) const {
    const Member* driving = driver_ ? member(*driver_) : nullptr;
    return driving != nullptr && driving->session == session;
}

bool DriverLock::is_here(ClientId client) const {
    return member(client) != nullptr;
}

std::vector<ClientId> DriverLock::clients() const {
    std::vector<ClientId> all;
    for (const Member& member : members_) all.push_back(member.client);
    return all;
}

void DriverLock::remember(ClientId client, const View& view) {
    const Member* own = member(client);
    if (own == nullptr) return;
    for (Session& s : sessions_)
        if (s.name == own->session) s.view = view;
}

std::optional<View> DriverLock::place(ClientId client) const {
    const Session* own = session(client);
    return own != nullptr ? own->view : std::nullopt;
}

const DriverLock::Member* DriverLock::member(ClientId client) const {
    for (const Member& member : members_)
        if (member.client == client) return &member;
    return nullptr;
}

const DriverLock::Session* DriverLock::session(ClientId client) const {
    const Member* own = member(client);
    if (own == nullptr) return nullptr;
    for (const Session& s : sessions_)
        if (s.name == own->session) return &s;
    return nullptr;
}

}  // namespace lightwalk
