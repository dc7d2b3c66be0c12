#pragma once
// What ranks do that draw the frames of a walk together: the steps of who deals out the pixels that
// no point answers, and of who waits for what the others send (see roles.h).
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "parallel/ranks/message.h"
#include "parallel/ranks/roles.h"

namespace lightwalk {

/// Passes on the orders of frames, deals out their uncached pixels, and gathers their parts.
class CloudMasterRole {
  public:
    /// @param self     its own address
    /// @param workers  their ranks
    /// @param owners   of the workers, the first ones: they own the parts of the frames
    /// @param slots    threads that trace, of all workers together
    CloudMasterRole(Address self, std::vector<int> workers, std::size_t owners, int slots);

    /// From the program: CloudOrder, the next one when the frame before is there. From owners:
    /// UncachedPixels, CloudPart. From tracers: AskUncachedPixels. To the program: FinishedFrame.
    /// Throws InputError for what nobody should have sent.
    void handle(Envelope envelope, Outbox& out);

  private:
    /// Pixels of one owner that are to be dealt out.
    struct Store {
        bool told = false;      ///< the owner has said which these are
        bool finished = false;  ///< and has sent its part
        UncachedPixels uncached;
        std::size_t next = 0;  ///< place that is dealt out next
    };
    struct Wish {
        int rank = 0;
        std::uint32_t count = 0;
    };
    void begin(CloudOrder order, Outbox& out);
    void store(int rank, UncachedPixels uncached);
    void gather(int rank, CloudPart part, Outbox& out);
    void serve(Outbox& out);
    [[nodiscard]] GiveUncachedPixels next_piece();
    void tell_end(Outbox& out);

    Address self_;
    std::vector<int> workers_;
    std::size_t slots_;
    std::vector<Store> stores_;  ///< by owner
    std::deque<Wish> wishes_;
    bool drawing_ = false;  ///< a frame
    WalkFrameId frame_ = 0;
    std::size_t left_ = 0;          ///< places in the stores
    std::size_t untold_ = 0;        ///< owners whose uncached pixels are not known
    std::size_t turn_ = 0;          ///< owner whose uncached pixels are dealt out next
    bool begun_ = false;            ///< something has been dealt out
    bool ended_ = false;            ///< all were told that nothing more comes
    std::vector<CloudPart> parts_;  ///< so far
};

struct CloudWorkerOptions {
    Address self, master;
    std::size_t index = 0;   ///< among the workers
    std::size_t owners = 1;  ///< the first of them, which own parts
    int slots = 1;           ///< threads that trace here
    int ahead = 1;           ///< pieces of work that wait here
};

/// Passes on to its rank's tracer what comes for it, and says when all of it is there.
class CloudWorkerRole {
  public:
    explicit CloudWorkerRole(const CloudWorkerOptions& options) : options_(options) {}

    /// Asks for the first pieces of work.
    void begin(Outbox& out);
    /// From the master: CloudOrder, GiveUncachedPixels. From other tracers: CloudPoints, CloudUsed,
    /// TracedPixelResults. From its own: UncachedPixels, CloudPart. To it: these of others,
    /// CloudStage. Throws InputError for what nobody should have sent.
    void handle(Envelope envelope, Outbox& out);

  private:
    [[nodiscard]] bool owns() const { return options_.index < options_.owners; }
    [[nodiscard]] bool is_early(WalkFrameId frame) const;
    void start(const CloudOrder& order);
    void expect(const UncachedPixels& uncached);
    void note(const TracedPixelResults& traced);
    void tell_stages(Outbox& out);
    [[nodiscard]] Address tracer() const { return {options_.self.rank, Role::tracer}; }

    CloudWorkerOptions options_;
    std::optional<WalkFrameId> frame_;
    std::vector<Envelope> early_;     ///< of a frame whose order is still on its way
    std::size_t points_missing_ = 0;  ///< messages of other owners
    std::size_t used_missing_ = 0;    ///< messages of the owners beside this one
    std::size_t pixels_missing_ = 0;
    bool uncached_known_ = false, points_told_ = true, pixels_told_ = true;
    std::vector<bool> there_;  ///< which pixels are
};

/// Owners whose points may answer pixels of one of them: those whose parts touch its own.
[[nodiscard]] std::vector<std::size_t> owners_beside(const SubImages& parts, std::size_t index,
                                                     int width, int height);

/// How many of the workers own parts of frames: no more than `most`.
[[nodiscard]] inline std::size_t owners_of(std::size_t workers, int most) {
    return std::min(workers, static_cast<std::size_t>(std::max(most, 1)));
}

}  // namespace lightwalk
