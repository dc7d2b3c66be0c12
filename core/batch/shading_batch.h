#pragma once
// Rays that are shaded side by side: where one needs direct light it waits, until that of all is
// calculated at once. What a ray brings back is the same as when it is shaded alone.
#include <cstddef>
#include <exception>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/batch/fibers.h"
#include "core/transport/tracer.h"

namespace lightwalk {

/// One thread's. The order in which rays are begun is that of their numbers; nothing is said of how
/// far one is when the next begins.
class ShadingBatch {
  public:
    /// Calculates direct light of several points.
    using Calculate = FunctionRef<void(std::span<const DirectRequest> requests)>;

    /// @param fibers  for as many rays side by side; the others follow
    explicit ShadingBatch(std::unique_ptr<Fibers> fibers)
        : fibers_(std::move(fibers)), tasks_(fibers_->size()) {}

    /// body(i) for i = 0 ... count - 1, in which context.batch is this; `calculate` runs outside.
    /// What a body throws ends the run when all have ended: the first one's exception goes on.
    void run(std::size_t count, FunctionRef<void(std::size_t)> body, Calculate calculate,
             TraceContext& context);

    /// The context's level of ambient light in the bodies. What asks for direct light on another
    /// one is not of this batch, and does not wait in it.
    [[nodiscard]] int level() const { return level_; }

    // In a body:
    /// Wait until the request has been served.
    void wait(const DirectRequest& request, TraceContext& context);
    /// Whether the stack suffices for going deeper by a ray or a mixture; if not: outside().
    [[nodiscard]] bool has_room() const { return fibers_->has_room(); }
    /// Do `work` on the stack that runs the batch: the thread's, or that of the batch around it.
    void outside(FunctionRef<void()> work, TraceContext& context);

  private:
    struct ShadingTask {
        const DirectRequest* request = nullptr;        ///< while it waits for direct light
        const FunctionRef<void()>* outside = nullptr;  ///< while it waits for that
        int depth = 0;                                 ///< of the context, while it waits
        std::exception_ptr failed;  ///< what it waited for threw this; at the end, what it threw
    };
    void run_part(std::size_t first, std::size_t count, FunctionRef<void(std::size_t)> body,
                  Calculate calculate, TraceContext& context);
    void leave(TraceContext& context);
    void go_outside(ShadingTask& task, TraceContext& context);
    void calculate_all(Calculate calculate, TraceContext& context);

    int level_ = 0;
    ShadingBatch* around_ = nullptr;  ///< the batch whose fiber runs this one
    std::unique_ptr<Fibers> fibers_;
    std::vector<ShadingTask> tasks_;
    std::size_t running_ = 0;
    std::vector<std::size_t> waiting_, answered_;
    std::vector<DirectRequest> requests_;
};

}  // namespace lightwalk
