#pragma once
// The cores of a node, shared evenly by its threads (processor sharing).
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace lightwalk {

/// n busy threads on c cores each have the speed of one core, or c / n of it if n > c. Calls must
/// be in the order of their times.
class Processors {
  public:
    /// @param cores     at least 1
    /// @param crowding  relative time of work by number of busy cores, 1 for one core
    /// @param looks     cores that threads polling for messages take while all cores are busy
    /// @param background  threads of other programs, which are always ready and get their share
    Processors(int cores, std::vector<double> crowding, double looks, double background = 0);

    /// Start `task`, which needs `work` seconds of a core.
    void add(double now, int task, double work);
    /// Account for other work of `work` seconds; if no core is free it delays all tasks.
    void take_away(double now, double work);
    /// The task that ends next if nothing changes, and the time of its end.
    [[nodiscard]] std::optional<std::pair<double, int>> next(double now);
    /// Remove the task that next() returned.
    void remove(double now, int task);

    [[nodiscard]] double work_done() const { return work_done_; }

  private:
    void pass(double now);
    [[nodiscard]] double speed() const;  ///< speed of a task, as a share of a core

    int cores_;
    std::vector<double> crowding_;
    double looks_, background_;
    double now_ = 0;
    double each_ = 0;  ///< work that a task present from the beginning would have done [s]
    double work_done_ = 0;
    std::set<std::pair<double, int>> ends_;  ///< the value of each_ at a task's end, and the task
};

}  // namespace lightwalk
