#pragma once
// Points that wait for ambient values, in an order that depends on nothing but themselves.
#include <cstddef>
#include <functional>
#include <vector>

#include "core/ambient/ambient_point.h"
#include "core/ambient/spacing_guess.h"
#include "parallel/worker_contexts.h"

namespace lightwalk {

/// A queue of points without a usable value, of one ambient level, from which rounds choose. The
/// order is pseudo-random, so that any prefix is spread evenly.
class WaitingPoints {
  public:
    /// Whether some points have a usable value by now: a char each.
    using Served = std::function<std::vector<char>(const AmbientPoint* points, std::size_t count)>;

    /// @param guess  of the distances up to which values will be usable; must outlive this
    WaitingPoints(std::vector<AmbientPoint> points, const SpacingGuess& guess, Served served);

    /// Remove up to `most` points from the head, in order, which have no usable value and of which
    /// none is close to an earlier one.
    [[nodiscard]] std::vector<AmbientPoint> choose(std::size_t most);
    [[nodiscard]] std::size_t left() const { return head_.size() + points_.size() - next_; }

    /// How many values a round may have where so many are known: few would be needless. It does not
    /// depend on the number of workers.
    [[nodiscard]] static std::size_t most_values(std::size_t known);

  private:
    void look(std::size_t size);
    void drop_served(std::size_t first);

    const SpacingGuess& guess_;
    Served served_;
    std::vector<AmbientPoint> points_;
    std::size_t next_ = 0;  ///< index of the first point that has not been moved to the head
    std::vector<AmbientPoint> head_;  ///< in the order of points_
};

/// For its lifetime the rays of all workers record missing ambient values.
class CollectingPoints {
  public:
    explicit CollectingPoints(WorkerContexts& contexts);
    ~CollectingPoints();
    CollectingPoints(const CollectingPoints&) = delete;
    CollectingPoints& operator=(const CollectingPoints&) = delete;

    [[nodiscard]] bool left_out() const;
    [[nodiscard]] std::vector<AmbientPoint> points() const;

  private:
    WorkerContexts& contexts_;
    std::vector<MissingAmbient> missing_;
};

}  // namespace lightwalk
