#include "parallel/walk/grid_illuminance.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "core/math/xyz.h"

namespace lightwalk {
namespace {

constexpr std::array<int, 3> kStrides{4, 2, 1};
constexpr std::size_t kPointsAWorker = 4;  // between two looks at the clock

}  // namespace

GridIlluminance::GridIlluminance(MeasuringGrid grid) : grid_(std::move(grid)) {
    sums_.resize(grid_.counts.size());
    for (std::size_t level = 0; level < kStrides.size(); ++level) {
        const int stride = kStrides[level];
        for (int y = 0; y < grid_.rows; y += stride)
            for (int x = 0; x < grid_.columns; x += stride) {
                const bool known = level > 0 && x % (2 * stride) == 0 && y % (2 * stride) == 0;
                if (!known && grid_.counts_at(x, y))
                    order_.push_back(static_cast<std::uint32_t>(y * grid_.columns + x));
            }
        ends_[level] = order_.size();
    }
}

bool GridIlluminance::step(const Tracer& tracer, WorkerContexts& contexts, double seconds,
                           Executor& executor, const StopFlag& stop, const LightMixture& mixture) {
    using Clock = std::chrono::steady_clock;
    const auto deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                             std::chrono::duration<double>(seconds));
    const std::size_t batch = kPointsAWorker * static_cast<std::size_t>(executor.concurrency());
    std::vector<float> values;
    do {
        if (passes_ == kSamples || order_.empty()) return false;
        values.assign(std::min(batch, order_.size() - next_), 0);
        executor.for_each(
            values.size(),
            [&](std::size_t task, int worker) {
                measure(order_[next_ + task], tracer, contexts[worker], mixture, values[task]);
            },
            stop);
        if (stop.requested()) return true;
        for (std::size_t i = 0; i < values.size(); ++i)
            sums_[order_[next_ + i]] += static_cast<double>(values[i]);
        next_ += values.size();
        if (next_ == order_.size()) {
            next_ = 0;
            ++passes_;
        }
    } while (Clock::now() < deadline);
    return passes_ < kSamples;
}

void GridIlluminance::begin_anew() {
    next_ = 0;
    passes_ = 0;
    std::fill(sums_.begin(), sums_.end(), 0.0);
}

void GridIlluminance::measure(std::size_t point, const Tracer& tracer, TraceContext& context,
                              const LightMixture& mixture, float& out) const {
    const auto width = static_cast<std::size_t>(grid_.columns);
    const auto x = static_cast<std::uint32_t>(point % width);
    const auto y = static_cast<std::uint32_t>(point / width);
    const auto random = RandomStream::of_pixel(1, x, y, static_cast<std::uint32_t>(passes_));
    const Vec3 place = grid_.point(static_cast<int>(x), static_cast<int>(y));
    if (context.groups) context.groups->clear();
    const Rgb whole = tracer.irradiance(place, grid_.normal, random, context).value;
    out = kEfficacy * brightness(context.groups ? mixture(whole, context.groups->sums()) : whole);
}

double GridIlluminance::share() const {
    if (order_.empty()) return 1;
    const auto all = static_cast<double>(order_.size());
    return (passes_ + static_cast<double>(next_) / all) / kSamples;
}

int GridIlluminance::stride() const {
    if (passes_ > 0) return 1;
    for (std::size_t level = kStrides.size(); level-- > 0;)
        if (next_ >= ends_[level] && ends_[level] > 0) return kStrides[level];
    return 0;
}

std::vector<float> GridIlluminance::values() const {
    std::vector<float> values;
    const int stride = this->stride();
    if (stride == 0) return values;
    std::vector<float> all(sums_.size(), std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = 0; i < order_.size(); ++i) {
        const int samples = passes_ + (i < next_ ? 1 : 0);
        if (samples > 0) all[order_[i]] = static_cast<float>(sums_[order_[i]] / samples);
    }
    for (int y = 0; y < grid_.rows; y += stride)
        for (int x = 0; x < grid_.columns; x += stride)
            values.push_back(
                all[static_cast<std::size_t>(y) * static_cast<std::size_t>(grid_.columns) +
                    static_cast<std::size_t>(x)]);
    return values;
}

}  // namespace lightwalk
