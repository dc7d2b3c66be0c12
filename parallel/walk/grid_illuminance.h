#pragma once
// Illuminances at the points of a grid, measured bit by bit.
#include <array>
#include <cstdint>
#include <vector>

#include "core/plan/measuring_grid.h"
#include "core/transport/light_groups.h"
#include "parallel/executor.h"
#include "parallel/stop_flag.h"
#include "parallel/worker_contexts.h"

namespace lightwalk {

/// First every fourth point of every fourth row by one sensor ray each, then every second, then
/// all; then all again until each has had 16. The same values whatever the executor, where the
/// light needs no cache.
class GridIlluminance {
  public:
    static constexpr int kSamples = 16;  ///< sensor rays a point

    explicit GridIlluminance(MeasuringGrid grid);

    /// Measure for so long, some points at least [s]. Throws what the tracer throws. Where `stop`
    /// is requested what was begun is begun anew by the next step. False: all is done.
    /// @param mixture  of the light groups by which the contexts sum
    [[nodiscard]] bool step(const Tracer& tracer, WorkerContexts& contexts, double seconds,
                            Executor& executor, const StopFlag& stop,
                            const LightMixture& mixture = {});
    /// Forget what was measured: the light is another one.
    void begin_anew();

    [[nodiscard]] const MeasuringGrid& grid() const { return grid_; }
    /// Share of the sensor rays that are traced, 0 ... 1.
    [[nodiscard]] double share() const;
    /// The finest grid whose points are all measured: every 4th, 2nd, or each point of every 4th,
    /// 2nd, or each row; 0: none is.
    [[nodiscard]] int stride() const;
    /// The illuminances of that grid, by rows [lx]; NaN for points that do not count.
    [[nodiscard]] std::vector<float> values() const;

  private:
    void measure(std::size_t point, const Tracer& tracer, TraceContext& context,
                 const LightMixture& mixture, float& out) const;

    MeasuringGrid grid_;
    std::vector<std::uint32_t> order_;   ///< points that count, coarse to fine
    std::array<std::size_t, 3> ends_{};  ///< of the points of each level in it
    std::size_t next_ = 0;               ///< in the order
    int passes_ = 0;                     ///< that are done: samples of each point
    std::vector<double> sums_;           ///< of the samples of each point [lx]
};

}  // namespace lightwalk
