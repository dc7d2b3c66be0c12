#pragma once
// What comes for the threads of a rank that trace, and waits until they take it.
#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "parallel/block_renderer.h"
#include "parallel/ranks/rank_threads.h"
#include "parallel/stop_flag.h"
#include "parallel/work_queue/outbox.h"

namespace lightwalk {

/// What the other ranks have sent the owner of a part of a frame; in any order, and also before the
/// frame is announced here.
struct FrameMail {
    std::vector<SharedPoints> points;
    std::vector<UsedPixels> used;
    std::vector<TracedRun> runs;
    std::size_t traced = 0;  ///< pixels of these
};

/// A picture at hand. The first of its rank's threads to get here makes what renders its blocks.
struct OpenPicture {
    PictureJob start;
    std::once_flag made;
    std::shared_ptr<const BlockRenderer> renderer;
};

class TracerInbox {
  public:
    explicit TracerInbox(std::shared_ptr<RankThreads> threads = std::make_shared<RankThreads>())
        : threads_(std::move(threads)) {}

    /// From any thread.
    void push(TracerNews news);
    /// No more work comes: whoever waits is told so.
    void close();
    /// Another work begins.
    void reopen();

    // All of these wait until there is something, the inbox is closed, or `stop` is requested;
    // nothing: one of the latter two.

    struct PictureBlock {
        JobBlock work;
        std::shared_ptr<OpenPicture> picture;
    };
    /// A picture whose blocks follow, or a piece of work.
    using Item = std::variant<std::shared_ptr<OpenPicture>, PictureBlock, RayChunk>;
    [[nodiscard]] std::optional<Item> next(const StopFlag& stop);
    using Order = std::variant<FrameOrder, ChangeOrder>;
    [[nodiscard]] std::optional<Order> next_order(const StopFlag& stop);
    /// Pixels of this frame. Nothing: also where no more come. Those of the next frame may be there
    /// already, where a rank has not been needed for this one.
    [[nodiscard]] std::optional<PixelRun> next_run(FrameNumber frame, const StopFlag& stop);
    /// As many lists of points.
    [[nodiscard]] std::optional<std::vector<SharedPoints>> points(FrameNumber frame,
                                                                  std::size_t lists,
                                                                  const StopFlag& stop);
    /// So many pixels, traced or too late, and lists of used points; then the frame is forgotten.
    [[nodiscard]] std::optional<FrameMail> mail(FrameNumber frame, std::size_t pixels,
                                                std::size_t lists, const StopFlag& stop);
    /// Until the inbox is closed.
    void wait_for_end(const StopFlag& stop);

    /// Pieces of work, orders, and frames' mail that nobody has taken.
    [[nodiscard]] std::size_t waiting() const;

  private:
    void push_picture(PictureJob job);
    void push_grant(WorkGrant grant);
    /// Calls `take()` until it gives something; nothing: closed or stopped.
    template <class Take>
    auto wait_for(const StopFlag& stop, Take take) -> decltype(take());

    std::shared_ptr<RankThreads> threads_;
    mutable std::mutex mutex_;  ///< guards what follows
    std::condition_variable changed_;
    std::deque<Item> items_;
    std::map<JobId, std::shared_ptr<OpenPicture>> pictures_;  ///< the newest kJobsAtOnce
    std::deque<PixelRun> runs_;
    std::deque<Order> orders_;
    FrameNumber frames_over_ = 0;  ///< of frames before this one no more runs come
    std::map<FrameNumber, FrameMail> mail_;
    bool closed_ = false;
};

}  // namespace lightwalk
