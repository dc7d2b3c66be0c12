#include "parallel/waiting_points.h"

#include <algorithm>
#include <utility>

#include "parallel/round_bytes.h"

namespace lightwalk {
namespace {

// Limits of the number of values in a round, which grows with the number of known values.
constexpr std::size_t kFewestValues = 64, kMostValues = 1024;
constexpr std::size_t kKnownPerValue = 4;
constexpr std::size_t kPointsPerValue = 4;  ///< points looked at, per value that a round may have

/// Sorts points in a pseudo-random order that depends on their contents only.
void put_in_order(std::vector<AmbientPoint>& points) {
    std::vector<std::pair<std::uint64_t, std::size_t>> order(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) order[i] = {hash_of(points[i]), i};
    std::sort(order.begin(), order.end());
    std::vector<AmbientPoint> sorted;
    sorted.reserve(points.size());
    for (const auto& [hash, i] : order) sorted.push_back(points[i]);
    points.swap(sorted);
}

}  // namespace

WaitingPoints::WaitingPoints(std::vector<AmbientPoint> points, const SpacingGuess& guess,
                             Served served)
    : guess_(guess), served_(std::move(served)), points_(std::move(points)) {
    put_in_order(points_);
}

std::size_t WaitingPoints::most_values(std::size_t known) {
    return std::clamp(known / kKnownPerValue, kFewestValues, kMostValues);
}

std::vector<AmbientPoint> WaitingPoints::choose(std::size_t most) {
    look(kPointsPerValue * most);
    ApartSet taken(guess_.least(), guess_.greatest());
    std::vector<AmbientPoint> chosen, rest;
    for (const AmbientPoint& point : head_) {
        if (chosen.size() >= most || taken.reached(point.query)) {
            rest.push_back(point);
            continue;
        }
        taken.add(point.query, guess_(point.query));
        chosen.push_back(point);
    }
    head_.swap(rest);
    return chosen;
}

/// Drop points from the head that have a usable value by now, and refill it to `size` or somewhat
/// more.
void WaitingPoints::look(std::size_t size) {
    drop_served(0);
    while (head_.size() < size && next_ < points_.size()) {
        const std::size_t count = std::min(points_.size() - next_, 2 * size), first = head_.size();
        const auto from = points_.begin() + static_cast<std::ptrdiff_t>(next_);
        head_.insert(head_.end(), from, from + static_cast<std::ptrdiff_t>(count));
        drop_served(first);
        next_ += count;
    }
}

/// Drop points with a usable value from index `first` of the head on.
void WaitingPoints::drop_served(std::size_t first) {
    const std::vector<char> done = served_(head_.data() + first, head_.size() - first);
    std::size_t kept = first;
    for (std::size_t i = 0; i < done.size(); ++i) {
        if (done[i] == 0) head_[kept++] = head_[first + i];
    }
    head_.resize(kept);
}

CollectingPoints::CollectingPoints(WorkerContexts& contexts)
    : contexts_(contexts), missing_(static_cast<std::size_t>(contexts.size())) {
    for (int w = 0; w < contexts.size(); ++w)
        contexts[w].ambient.missing = &missing_[static_cast<std::size_t>(w)];
}

CollectingPoints::~CollectingPoints() {
    for (int w = 0; w < contexts_.size(); ++w) contexts_[w].ambient.missing = nullptr;
}

bool CollectingPoints::left_out() const {
    return std::any_of(missing_.begin(), missing_.end(),
                       [](const MissingAmbient& missing) { return missing.left_out; });
}

std::vector<AmbientPoint> CollectingPoints::points() const {
    std::vector<AmbientPoint> all;
    for (const MissingAmbient& missing : missing_)
        all.insert(all.end(), missing.points.begin(), missing.points.end());
    return all;
}

}  // namespace lightwalk
