#pragma once
// A node's cores, shared evenly by the threads that want them.
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace lightwalk {

/// Processor sharing: n busy threads on c cores each go at the speed of one core, or c / n of it.
/// Times are given in the order in which they pass.
class Processors {
  public:
    /// @param cores     at least 1
    /// @param crowding  time of a piece of work by number of busy cores, one alone = 1
    /// @param looks     cores that are lost, while all are busy, to threads that look for messages
    /// @param background  other programs' threads, which always want a core, and get their share
    Processors(int cores, std::vector<double> crowding, double looks, double background = 0);

    /// `task` starts to need `work` seconds of a core that it has for itself.
    void add(double now, int task, double work);
    /// Something else takes a core for `work` seconds: where none is free, all tasks are delayed.
    void take_away(double now, double work);
    /// The task that is done next if nothing changes, and when.
    [[nodiscard]] std::optional<std::pair<double, int>> next(double now);
    /// It is done.
    void remove(double now, int task);

    [[nodiscard]] double work_done() const { return work_done_; }

  private:
    void pass(double now);
    [[nodiscard]] double speed() const;  ///< of a task

    int cores_;
    std::vector<double> crowding_;
    double looks_, background_;
    double now_ = 0;
    double each_ = 0;  ///< work that a task which was always there would have had
    double work_done_ = 0;
    std::set<std::pair<double, int>> ends_;  ///< `each_` at the end, and the task
};

}  // namespace lightwalk
