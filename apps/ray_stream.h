#pragma once
// The rays that a command reads from standard input and has answered, many at a time.
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <vector>

#include "apps/session/lightwalk/renderer.h"
#include "core/math/function_ref.h"
#include "io/rays/ray_reader.h"

namespace lightwalk {

struct RayStreamLimits {
    std::uint64_t expected = 0;  ///< rays after which it stops; 0: at the end of the input
    int row = 0;  ///< rays after which whoever sends them may wait for answers; 0: no such number
    bool waits = false;  ///< whoever sends them: lists of rays do not depend on how fast they come
    std::size_t most = std::size_t{1} << 20;  ///< rays that are given to the renderer at once
};

class RayStream {
  public:
    /// Takes the answers to some rays; all together these are in the order of the rays.
    using Take = FunctionRef<void(const std::string& bytes)>;
    /// Takes the answers of several renderers to the same rays, a string a renderer.
    using TakeEach = FunctionRef<void(std::span<const std::string> bytes)>;

    explicit RayStream(NumberFormat format);
    void limit(const RayStreamLimits& limits) { limits_ = limits; }

    /// Read rays that are not traced. False: there are not so many.
    bool skip(std::uint64_t rays);
    /// All other rays to the renderer, as many at a time as it asks for. Ends early when the run is
    /// interrupted.
    /// @param flush  is called where whoever sends the rays waits for the answers
    void answer_all(Renderer& renderer, Take take, FunctionRef<void()> flush);
    /// The same, by each of several renderers of this process.
    void answer_all(std::span<Renderer> renderers, TakeEach take, FunctionRef<void()> flush);

    /// Whether the input ended before the rays that were expected.
    [[nodiscard]] bool ended_early() const {
        return limits_.expected > 0 && read_ < limits_.expected;
    }
    /// Whether answer_all() came to the end.
    [[nodiscard]] bool is_complete() const { return complete_; }
    [[nodiscard]] const RayReader& reader() const { return reader_; }

  private:
    void give_batch(std::span<Renderer> renderers, TakeEach take, FunctionRef<void()> flush);
    bool put_answer(std::span<Renderer> renderers, TakeEach take);
    bool read_batch(std::size_t most);

    RayStreamLimits limits_;
    RayReader reader_;
    std::vector<RayQuery> queries_;
    std::deque<std::vector<Ticket<RayBytes>>> lists_;  ///< that were started, one a renderer
    std::uint64_t read_ = 0;
    int in_row_ = 0;
    bool flush_due_ = false, complete_ = false;
};

}  // namespace lightwalk
