#pragma once
// Where the time of a rank goes: by thread and by what it did.
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

namespace lightwalk {

/// What a thread of a rank may be doing.
enum class Activity : std::uint8_t {
    trace,     ///< blocks
    wait,      ///< for blocks
    send,      ///< results: shared out, or put into the own part of a picture
    compress,  ///< the own part of a picture
    exchange,  ///< ambient values
    handle,    ///< other messages: the master's work
};
inline constexpr std::size_t kActivities = 6;
inline constexpr std::array<const char*, kActivities> kActivityNames{
    "trace",    "wait for blocks",         "send results",
    "compress", "exchange ambient values", "serve messages"};

/// Rows of spans, one a thread. Costs two readings of the clock and a lock that nobody else wants a
/// span.
class Timeline {
  public:
    using Clock = std::chrono::steady_clock;
    struct Span {
        Activity activity{};
        double begin = 0, end = 0;  ///< since the timeline was made [s]
    };
    struct Row {
        std::array<double, kActivities> seconds{};  ///< by activity [s]
        std::vector<Span> spans;                    ///< in order; empty unless kept
    };

    /// @param rows  threads; the last row is that of the thread that serves messages
    /// @param keep  whether spans are kept, or only their sums
    Timeline(int rows, bool keep) : rows_(static_cast<std::size_t>(rows)), keep_(keep) {}

    /// From any thread, as is row().
    void add(int row, Activity activity, Clock::time_point begin, Clock::time_point end) {
        Guarded& r = rows_[static_cast<std::size_t>(row)];
        const std::chrono::duration<double> seconds = end - begin;
        const std::lock_guard lock(r.mutex);
        r.row.seconds[static_cast<std::size_t>(activity)] += seconds.count();
        if (keep_) r.row.spans.push_back({activity, since(begin), since(end)});
    }
    [[nodiscard]] Row row(int number) const {
        const Guarded& r = rows_[static_cast<std::size_t>(number)];
        const std::lock_guard lock(r.mutex);
        return r.row;
    }
    /// All rows, their spans told since a moment [s since the timeline was made].
    [[nodiscard]] std::vector<Row> rows_since(double moment) const {
        std::vector<Row> told;
        for (int number = 0; number < rows(); ++number) {
            told.push_back(row(number));
            for (Span& span : told.back().spans) {
                span.begin -= moment;
                span.end -= moment;
            }
        }
        return told;
    }
    [[nodiscard]] double since(Clock::time_point when) const {
        return std::chrono::duration<double>(when - made_).count();
    }
    [[nodiscard]] int rows() const { return static_cast<int>(rows_.size()); }
    [[nodiscard]] int message_row() const { return rows() - 1; }

  private:
    struct alignas(64) Guarded {
        mutable std::mutex mutex;
        Row row;
    };
    std::vector<Guarded> rows_;
    bool keep_;
    Clock::time_point made_ = Clock::now();
};

/// Adds the time until it goes.
class TimedActivity {
  public:
    TimedActivity(Timeline& timeline, int row, Activity activity)
        : timeline_(timeline), row_(row), activity_(activity), begin_(Timeline::Clock::now()) {}
    ~TimedActivity() { timeline_.add(row_, activity_, begin_, Timeline::Clock::now()); }
    TimedActivity(const TimedActivity&) = delete;
    TimedActivity& operator=(const TimedActivity&) = delete;

  private:
    Timeline& timeline_;
    int row_;
    Activity activity_;
    Timeline::Clock::time_point begin_;
};

}  // namespace lightwalk
