#pragma once
// How frames flow to one client: by its acknowledgements, never a queue of old ones, and only the
// pieces that it lacks. Values alone: time is passed in.
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

namespace lightwalk {

/// What was sent to one client, and what came back. Messages arrive in order, so what was sent is
/// what the client will have when it sees the next frame.
class FrameFlow {
  public:
    using Time = std::chrono::steady_clock::time_point;
    using Seconds = std::chrono::duration<double>;

    /// Whether the newest frame may be sent now: at once when nothing is under way; a second one
    /// behind the first when that should be about to leave the wire, as sizes and acknowledgements
    /// tell; never a third. So wire and screen are busy at the same time, but next to nothing
    /// waits before the wire, and what is sent is new.
    [[nodiscard]] bool may_send(Time now) const;
    /// When to ask again, while may_send says no and no acknowledgement comes; Time::max(): an
    /// acknowledgement alone will change it.
    [[nodiscard]] Time next_chance() const;

    /// Indices of the pieces that this client lacks, rising. `contents` has a number for every
    /// piece that changes with what the piece shows; `layout` one that changes with how the
    /// picture is cut into pieces.
    [[nodiscard]] std::vector<std::size_t> missing(std::uint64_t layout,
                                                   std::span<const std::uint64_t> contents) const;

    /// A frame with all missing pieces went out, as a message of `bytes`. Frame numbers rise.
    void sent(std::uint32_t frame, std::uint64_t layout, std::span<const std::uint64_t> contents,
              std::size_t bytes, Time now);
    /// The client drew a frame, and so all before it. False, and nothing changed, when none of
    /// that number is under way: the page is wrong, or lies.
    bool acked(std::uint32_t frame, Time now);

    [[nodiscard]] std::size_t under_way() const { return under_way_.size(); }
    /// From sending to acknowledgement, of late; 0 before the first.
    [[nodiscard]] Seconds round_trip() const { return round_trip_; }
    /// The most that was carried of late [bytes/s], over any four frames: what the link can take
    /// once frames follow each other closely, else less. 0 before the first.
    [[nodiscard]] double bytes_per_second() const;

  private:
    struct Sent {
        std::uint32_t frame = 0;
        std::size_t bytes = 0;
        Time at;
        Time start;  ///< when the wire was free for it, as far as we can tell
    };
    /// On the wire.
    [[nodiscard]] Time::duration time_for(std::size_t bytes) const;
    /// From the wire's end to the acknowledgement here: the least that frames took beside their
    /// time on the wire.
    [[nodiscard]] Time::duration delay() const;
    struct Trip {
        Time::duration time{};
        std::size_t bytes = 0;
    };
    struct Carried {
        Seconds taken{0};  ///< since it was sent, or the one before was acknowledged
        std::size_t bytes = 0;
    };
    void measure(const Sent& frame, std::size_t bytes, Time now);

    std::deque<Sent> under_way_;
    std::uint32_t sent_ = 0;  ///< frames in all
    bool has_pieces_ = false;
    std::uint64_t layout_ = 0;
    std::vector<std::uint64_t> contents_;  ///< that the client has, or will have
    Seconds round_trip_{0};
    Time last_ack_{};
    std::deque<Carried> carried_;  ///< the last frames
    std::deque<Trip> trips_;       ///< of the last frames
    std::deque<double> speeds_;    ///< after each of the last frames [bytes/s]
};

}  // namespace lightwalk
