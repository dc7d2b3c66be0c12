#pragma once
// Flow control (backpressure) of the frames to one client: its acknowledgements decide when the
// next frame is sent, so that no queue of old frames builds up, and only pieces that it lacks are
// sent. A pure state machine: sends nothing itself, and the time is an argument.
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

namespace lightwalk {

/// The state of one client: frames sent and acknowledged. Messages arrive in order, so the client
/// has every piece that was sent when it gets the next frame.
class FrameFlow {
  public:
    using Time = std::chrono::steady_clock::time_point;
    using Seconds = std::chrono::duration<double>;

    /// Whether the newest frame may be sent now. Yes when no frame is unacknowledged; a second one
    /// may follow when the first should have left the wire, by the bandwidth and delay estimated
    /// from sizes and acknowledgements; a third never. Thus wire and screen are busy at the same
    /// time, but next to nothing waits before the wire, and what is sent is new.
    [[nodiscard]] bool may_send(Time now) const;
    /// When may_send() will become true without another acknowledgement; Time::max() when only an
    /// acknowledgement can change it.
    [[nodiscard]] Time next_chance() const;

    /// Ascending indices of the pieces that this client lacks. `contents` has a hash of what each
    /// piece shows, `layout` is a hash of how the picture is divided into pieces.
    [[nodiscard]] std::vector<std::size_t> missing(std::uint64_t layout,
                                                   std::span<const std::uint64_t> contents) const;

    /// Record that a frame with all missing pieces was sent, as a message of `bytes` bytes. Frame
    /// numbers must rise.
    void sent(std::uint32_t frame, std::uint64_t layout, std::span<const std::uint64_t> contents,
              std::size_t bytes, Time now);
    /// Record that the client has drawn a frame, which acknowledges all before it. Returns false,
    /// and changes nothing, when no frame of that number is unacknowledged: the page is wrong or
    /// lies.
    bool acked(std::uint32_t frame, Time now);

    [[nodiscard]] std::size_t under_way() const { return under_way_.size(); }
    /// The exponentially smoothed time from sending to acknowledgement; 0 before the first one.
    [[nodiscard]] Seconds round_trip() const { return round_trip_; }
    /// The largest recent throughput over any four consecutive frames [bytes/s]: the bandwidth of
    /// the link when frames follow each other closely, else less. 0 before the first
    /// acknowledgement.
    [[nodiscard]] double bytes_per_second() const;

  private:
    struct Sent {
        std::uint32_t frame = 0;
        std::size_t bytes = 0;
        Time at;
        Time start;  ///< estimate of when its first byte was put on the wire
    };
    /// Estimated time that a message of this size takes on the wire.
    [[nodiscard]] Time::duration time_for(std::size_t bytes) const;
    /// Estimated time from a message's last byte on the wire to its acknowledgement: the least time
    /// that recent frames took beside their time on the wire.
    [[nodiscard]] Time::duration delay() const;
    struct Trip {
        Time::duration time{};
        std::size_t bytes = 0;
    };
    struct Carried {
        Seconds taken{0};  ///< from sending, or the previous acknowledgement, to its own
        std::size_t bytes = 0;
    };
    void measure(const Sent& frame, std::size_t bytes, Time now);

    std::deque<Sent> under_way_;
    std::uint32_t sent_ = 0;  ///< number of frames sent so far
    bool has_pieces_ = false;
    std::uint64_t layout_ = 0;
    std::vector<std::uint64_t> contents_;  ///< hashes of the pieces that the client has or will get
    Seconds round_trip_{0};
    Time last_ack_{};
    std::deque<Carried> carried_;  ///< one for each recent frame
    std::deque<Trip> trips_;       ///< one for each recent frame
    std::deque<double> speeds_;    ///< throughput after each recent frame [bytes/s]
};

}  // namespace lightwalk
