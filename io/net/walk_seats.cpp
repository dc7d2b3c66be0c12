#include "io/net/walk_seats.h"

#include <algorithm>

namespace lightwalk {

bool WalkSeats::join(ClientId client, const std::string& session) {
    if (is_here(client)) return false;
    seats_.push_back({client, session});
    const auto known = std::find_if(sessions_.begin(), sessions_.end(),
                                    [&](const Session& s) { return s.name == session; });
    if (known == sessions_.end()) {
        if (sessions_.size() == kMostSessions) sessions_.pop_front();
        sessions_.push_back({session, std::nullopt});
    }
    // Who returns before the old connection is known to be lost is still the same.
    const Seat* driving = driver_ ? seat(*driver_) : nullptr;
    if (driving == nullptr || driving->session == session) driver_ = client;
    return true;
}

void WalkSeats::leave(ClientId client) {
    std::erase_if(seats_, [&](const Seat& seat) { return seat.client == client; });
    if (driver_ == client) driver_.reset();
}

bool WalkSeats::take(ClientId client) {
    if (driver_ || !is_here(client)) return false;
    driver_ = client;
    return true;
}

bool WalkSeats::hand(ClientId from, ClientId to) {
    if (driver_ != from || !is_here(to)) return false;
    driver_ = to;
    return true;
}

bool WalkSeats::is_here(ClientId client) const {
    return seat(client) != nullptr;
}

std::vector<ClientId> WalkSeats::clients() const {
    std::vector<ClientId> all;
    for (const Seat& seat : seats_) all.push_back(seat.client);
    return all;
}

void WalkSeats::remember(ClientId client, const View& view) {
    const Seat* own = seat(client);
    if (own == nullptr) return;
    for (Session& s : sessions_)
        if (s.name == own->session) s.view = view;
}

std::optional<View> WalkSeats::place(ClientId client) const {
    const Session* own = session(client);
    return own != nullptr ? own->view : std::nullopt;
}

const WalkSeats::Seat* WalkSeats::seat(ClientId client) const {
    for (const Seat& seat : seats_)
        if (seat.client == client) return &seat;
    return nullptr;
}

const WalkSeats::Session* WalkSeats::session(ClientId client) const {
    const Seat* own = seat(client);
    if (own == nullptr) return nullptr;
    for (const Session& s : sessions_)
        if (s.name == own->session) return &s;
    return nullptr;
}

}  // namespace lightwalk
