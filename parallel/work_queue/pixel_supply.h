#pragma once
// The uncached pixels of a walk's frame as a supply of runs.
#include <cstddef>
#include <optional>
#include <vector>

#include "parallel/work_queue/outbox.h"

namespace lightwalk {

/// The uncached pixels of one frame after the other, and the parts that come back. All functions
/// throw InputError for what nobody should have sent.
class PixelSupply {
  public:
    /// @param owners  ranks that own parts of the frames, by number of the part
    /// @param slots   threads that trace, of all workers together
    PixelSupply(std::vector<int> owners, int slots);

    /// The frame before must be finished.
    void start(FrameNumber frame);
    void add(int rank, UncachedPixels pixels);
    /// A run has come back. Where there was no time for all of it there is none for what is left of
    /// the frame: it is handed out in runs as long as can be, only for its owners to be told.
    void note(const FinishedWork& finished);
    /// A run of one owner's pixels: the owners' in turn, so that no owner's results pile up.
    [[nodiscard]] std::optional<PixelRun> next();
    /// Once a frame, when all of it is handed out: its number.
    [[nodiscard]] std::optional<FrameNumber> over();
    void gather(int rank, FramePart part, Outbox& out);

  private:
    /// Pixels of one owner.
    struct Store {
        bool told = false;      ///< the owner has said which these are
        bool finished = false;  ///< and has sent its part
        UncachedPixels pixels;
        std::size_t next = 0;  ///< place that is handed out next
        [[nodiscard]] std::size_t left() const { return pixels.places.size() - next; }
    };
    [[nodiscard]] Store& store_of(int rank, FrameNumber frame);

    std::vector<int> owners_;
    std::size_t slots_;
    std::vector<Store> stores_;  ///< by owner
    bool drawing_ = false;       ///< a frame
    FrameNumber frame_ = 0;
    std::size_t left_ = 0;    ///< places in the stores
    std::size_t untold_ = 0;  ///< owners whose uncached pixels are not known
    std::size_t turn_ = 0;    ///< owner whose pixels are handed out next
    bool begun_ = false;      ///< something has been handed out
    bool over_ = true;        ///< see over()
    bool late_ = false;       ///< time is over
    std::vector<FramePart> parts_;
};

}  // namespace lightwalk
