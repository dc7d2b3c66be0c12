#pragma once
// Pictures as a supply of blocks.
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>

#include "parallel/work_queue/outbox.h"

namespace lightwalk {

struct BlockPolicy {
    int side = 0;               ///< of blocks [pixels]; 0: follows what blocks take
    int stride = 0;             ///< consecutive blocks lie so many apart; 0: the number of workers
    int slots = 1;              ///< threads that trace, of all workers together
    bool makes_values = false;  ///< pixels make ambient values, and so take very different times
};

/// The blocks of several pictures, one picture after the other, and the parts that come back.
class BlockSupply {
  public:
    /// @param workers  number of all workers: each sends a part of every picture
    BlockSupply(std::size_t workers, const BlockPolicy& policy)
        : workers_(workers), policy_(policy) {}

    void start(const PictureJob& job, Outbox& out);
    /// The next block, oldest picture first; nothing: all are handed out.
    [[nodiscard]] std::optional<JobBlock> next();
    void note(const FinishedWork& finished, Outbox& out);
    void gather(PicturePart part, Outbox& out);

    /// Blocks that were handed out and are not finished.
    [[nodiscard]] std::size_t blocks_out() const { return blocks_out_; }

  private:
    struct Job {
        PictureJob start;
        std::deque<PixelRectangle> blocks;          ///< to be handed out
        double pixels_waiting = 0;                  ///< in these
        double pixels_done = 0;                     ///< in this run or an earlier one
        double pixels_timed = 0, seconds_done = 0;  ///< in this run
        std::size_t parts_missing = 0;
        FinishedPicture picture;
    };
    [[nodiscard]] JobBlock take_block(Job& job) const;

    std::size_t workers_;
    BlockPolicy policy_;
    std::map<JobId, Job> jobs_;  ///< oldest first; until their last part or block is there
    std::size_t blocks_out_ = 0;
};

}  // namespace lightwalk
