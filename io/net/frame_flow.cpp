#include "io/net/frame_flow.h"

#include <algorithm>

namespace lightwalk {
namespace {

constexpr std::size_t kMostUnderWay = 2;
constexpr std::size_t kMeasured = 4;  // frames of one measurement: acknowledgements come in pairs
constexpr std::size_t kRemembered = 16;  // measurements whose best counts
constexpr double kNewShare = 0.25;       // weight of a new round trip in the smoothed one
constexpr double kShortest = 1e-6;       // [s]: of a time that is divided by
constexpr double kLongest = 3600;        // [s]: of a time on the wire
// Of a frame's time on the wire, until the next is sent. Less than all of it: frames that are sent
// one by one seem to take as long as their round trip; sent a little closer each time, they follow
// each other until the wire is what they wait for, and its speed is known. More, once in a while:
// the frame finds the wire free, and so the delay beside the wire is known.
constexpr double kPatience = 0.75, kLongPatience = 1.25;
constexpr std::uint32_t kPatientEvery = 8;

}  // namespace

bool FrameFlow::may_send(Time now) const {
    return now >= next_chance();
}

FrameFlow::Time FrameFlow::next_chance() const {
    if (under_way_.empty()) return Time::min();
    if (under_way_.size() >= kMostUnderWay || speeds_.empty()) return Time::max();
    const Sent& last = under_way_.back();
    const double patience = sent_ % kPatientEvery == 0 ? kLongPatience : kPatience;
    return last.start + std::chrono::duration_cast<Time::duration>(patience * time_for(last.bytes));
}

FrameFlow::Time::duration FrameFlow::time_for(std::size_t bytes) const {
    if (speeds_.empty()) return {};
    const Seconds time(std::min(static_cast<double>(bytes) / bytes_per_second(), kLongest));
    return std::chrono::duration_cast<Time::duration>(time);
}

std::vector<std::size_t> FrameFlow::missing(std::uint64_t layout,
                                            std::span<const std::uint64_t> contents) const {
    const bool same = has_pieces_ && layout == layout_ && contents.size() == contents_.size();
    std::vector<std::size_t> pieces;
    for (std::size_t i = 0; i < contents.size(); ++i) {
        if (!same || contents[i] != contents_[i]) pieces.push_back(i);
    }
    return pieces;
}

void FrameFlow::sent(std::uint32_t frame, std::uint64_t layout,
                     std::span<const std::uint64_t> contents, std::size_t bytes, Time now) {
    Time start = now;
    if (!under_way_.empty()) {
        const Sent& before = under_way_.back();
        start = std::max(now, before.start + time_for(before.bytes));
    }
    under_way_.push_back({frame, bytes, now, start});
    ++sent_;
    has_pieces_ = true;
    layout_ = layout;
    contents_.assign(contents.begin(), contents.end());
}

bool FrameFlow::acked(std::uint32_t frame, Time now) {
    const auto found = std::find_if(under_way_.begin(), under_way_.end(),
                                    [&](const Sent& sent) { return sent.frame == frame; });
    if (found == under_way_.end()) return false;
    std::size_t bytes = 0;
    for (auto drawn = under_way_.begin(); drawn <= found; ++drawn) bytes += drawn->bytes;
    measure(*found, bytes, now);
    under_way_.erase(under_way_.begin(), found + 1);
    if (!under_way_.empty()) {
        Sent& next = under_way_.front();
        next.start = std::max(next.at, now - delay());
    }
    return true;
}

FrameFlow::Time::duration FrameFlow::delay() const {
    Time::duration least = Time::duration::max();
    for (const Trip& trip : trips_) least = std::min(least, trip.time - time_for(trip.bytes));
    return std::max(least, Time::duration::zero());
}

void FrameFlow::measure(const Sent& frame, std::size_t bytes, Time now) {
    const Seconds trip = now - frame.at;
    round_trip_ = round_trip_.count() == 0 ? trip : round_trip_ + kNewShare * (trip - round_trip_);
    trips_.push_back({now - frame.at, frame.bytes});
    if (trips_.size() > kRemembered) trips_.pop_front();
    // Sent before the acknowledgement of the one before, it has followed that on the wire.
    carried_.push_back({now - std::max(under_way_.front().at, last_ack_), bytes});
    if (carried_.size() > kMeasured) carried_.pop_front();
    Carried sum;
    for (const Carried& one : carried_) {
        sum.taken += one.taken;
        sum.bytes += one.bytes;
    }
    speeds_.push_back(static_cast<double>(sum.bytes) / std::max(sum.taken.count(), kShortest));
    if (speeds_.size() > kRemembered) speeds_.pop_front();
    last_ack_ = now;
}

double FrameFlow::bytes_per_second() const {
    return speeds_.empty() ? 0 : *std::max_element(speeds_.begin(), speeds_.end());
}

}  // namespace lightwalk
