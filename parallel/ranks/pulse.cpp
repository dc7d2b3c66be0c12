#include "parallel/ranks/pulse.h"

#include <algorithm>

namespace lightwalk {

void Pulse::start(Time now) {
    started_ = true;
    looked_ = told_ = now;
    heard_.assign(static_cast<std::size_t>(ranks_), now);
}

void Pulse::heard(int from, Time now) {
    if (started_) heard_[static_cast<std::size_t>(from)] = now;
}

Pulse::Beat Pulse::beat(Time now) {
    Beat beat;
    if (!started_) return beat;
    const Duration away = now - looked_;
    looked_ = now;
    // What has come since this process runs again was heard now, not later.
    if (away > times_.every)
        for (Time& time : heard_) time = std::min(now, time + away);
    if (now - told_ < times_.every) return beat;
    told_ = now;
    beat.due = true;
    for (int other = 0; other < ranks_ && !beat.lost; ++other) {
        const bool watched = other != rank_ && (rank_ == 0 || other == 0);
        if (watched && now - heard_[static_cast<std::size_t>(other)] > times_.silence)
            beat.lost = other;
    }
    return beat;
}

}  // namespace lightwalk
