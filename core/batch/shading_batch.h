#pragma once
// A batch of rays whose shading is interleaved: a ray that needs direct light waits (as a fiber)
// until all others have come to such a point, and then the direct light of all is calculated at
// once. Results are the same, to the bit, as of rays that are shaded alone.
#include <cstddef>
#include <exception>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/batch/fibers.h"
#include "core/transport/light_transport.h"

namespace lightwalk {

/// Where the rays of a batch may wait.
enum class BatchWaits {
    anywhere,
    /// As the last thing that they do, so that a ray asks for all its ambient values before the
    /// next ray begins: values then depend neither on the size of the batch nor on whether there is
    /// one.
    at_their_end,
};

/// Belongs to one thread. Rays are begun in the order of their numbers; how far one is when the
/// next begins is not specified.
class ShadingBatch {
  public:
    /// Calculates the direct light of several points at once.
    using Calculate = FunctionRef<void(std::span<const DirectRequest> requests)>;

    /// @param fibers  their number is that of the rays in flight; further rays follow
    explicit ShadingBatch(std::unique_ptr<Fibers> fibers);

    /// Calls body(i) for i = 0 ... count - 1, each on a fiber, with context.batches.current set to
    /// this batch. `calculate` runs on the caller's stack. When bodies throw, the run ends after
    /// all bodies have ended, and the exception of the first one is thrown again.
    void run(std::size_t count, FunctionRef<void(std::size_t)> body, Calculate calculate,
             TraceContext& context, BatchWaits waits = BatchWaits::anywhere);

    // To be called in a body:
    /// Whether the code that runs may wait. Rays of another ambient level than the batch's own may
    /// not, nor those that run outside().
    [[nodiscard]] bool may_wait(const TraceContext& context) const;
    /// Wait until the direct light has been calculated.
    void wait(const DirectRequest& request, TraceContext& context);
    /// Whether the fiber's stack has room for one more level of recursion (a ray or a mixture);
    /// where it has not, call outside().
    [[nodiscard]] bool has_room() const { return fibers_->has_room(); }
    /// Run `work` on the stack that called run(): the thread's own, or that of a fiber of an
    /// enclosing batch.
    void outside(FunctionRef<void()> work, TraceContext& context);

  private:
    struct ShadingTask {
        const DirectRequest* request = nullptr;        ///< direct light that it waits for
        const FunctionRef<void()>* outside = nullptr;  ///< work for outside() that it waits for
        Nesting nesting;                               ///< of the context, while it waits
        GroupAccount* account = nullptr;  ///< of what groups of emitters bring, while it waits
        std::exception_ptr failed;        ///< thrown by what it waits for; at the end, by its body
    };
    void run_part(std::size_t first, std::size_t count, FunctionRef<void(std::size_t)> body,
                  Calculate calculate, TraceContext& context);
    void leave(TraceContext& context);
    void go_outside(ShadingTask& task, TraceContext& context);
    void calculate_all(Calculate calculate, TraceContext& context);

    BatchWaits waits_ = BatchWaits::anywhere;
    int level_ = 0;                    ///< ambient level of the bodies
    Nesting nesting_{};                ///< outside of the bodies
    GroupAccount* account_ = nullptr;  ///< the same; null: nobody asks for groups
    ShadingBatch* around_ = nullptr;   ///< the batch whose fiber runs this one
    std::unique_ptr<Fibers> fibers_;
    std::vector<ShadingTask> tasks_;
    std::size_t running_ = 0;
    std::vector<std::size_t> waiting_, answered_;  ///< these three have room for all tasks
    std::vector<DirectRequest> requests_;
};

}  // namespace lightwalk
