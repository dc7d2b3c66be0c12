#include "perf/model/processors.h"

#include <algorithm>
#include <cmath>

namespace lightwalk {

Processors::Processors(int cores, std::vector<double> crowding, double looks, double background)
    : cores_(cores),
      crowding_(std::move(crowding)),
      looks_(std::min(looks, 0.5 * cores)),
      background_(background) {}

double Processors::speed() const {
    if (ends_.empty()) return 0;
    const double wanted = static_cast<double>(ends_.size()) + background_;
    const int busy = std::clamp(static_cast<int>(std::lround(wanted)), 1, cores_);
    const double time = crowding_[std::min(static_cast<std::size_t>(busy), crowding_.size()) - 1];
    return (wanted < cores_ ? 1 : (cores_ - looks_) / wanted) / time;
}

void Processors::pass(double now) {
    const double work = std::max(0.0, now - now_) * speed();
    each_ += work;
    work_done_ += work * static_cast<double>(ends_.size());
    now_ = std::max(now, now_);
}

void Processors::add(double now, int task, double work) {
    pass(now);
    if (ends_.empty()) each_ = 0;  // keeps its digits
    ends_.emplace(each_ + work, task);
}

void Processors::take_away(double now, double work) {
    pass(now);
    const auto tasks = static_cast<double>(ends_.size());
    if (tasks + background_ < cores_ || ends_.empty()) return;
    const double lost = work * speed() / cores_;
    each_ -= lost;
    work_done_ -= lost * tasks;
}

std::optional<std::pair<double, int>> Processors::next(double now) {
    pass(now);
    if (ends_.empty()) return std::nullopt;
    const auto& [end, task] = *ends_.begin();
    return std::pair{now + std::max(0.0, end - each_) / speed(), task};
}

void Processors::remove(double now, int task) {
    pass(now);
    const auto found = std::find_if(ends_.begin(), ends_.end(),
                                    [&](const auto& entry) { return entry.second == task; });
    if (found != ends_.end()) ends_.erase(found);
}

}  // namespace lightwalk
