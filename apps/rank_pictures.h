#pragma once
// Pictures whose blocks many ranks render: what rank 0 tells the others of one, and what they make
// of it.
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "apps/rank_link.h"
#include "apps/rank_work.h"
#include "apps/session/picture_maker.h"
#include "apps/session/progress_reporter.h"
#include "parallel/cache_prepass.h"
#include "parallel/frame.h"
#include "parallel/frame_options.h"
#include "parallel/published_cache.h"

namespace lightwalk {

/// A picture as rank 0 describes it. Everything else follows from the command line, which all ranks
/// have read.
struct PictureOrder {
    View view;
    std::optional<View> previous;  ///< for motion blur
    int width = 0, height = 0;
    int step = 1;
    bool deterministic = false;  ///< fill the cache before, all ranks together
    bool indirect = true;        ///< false: by direct light alone
};
[[nodiscard]] std::string encode_order(const PictureOrder& order);
/// Throws InputError for bytes that encode_order did not make.
[[nodiscard]] PictureOrder decode_order(const std::string& bytes);

/// Rank 0's pictures, which all ranks make.
class LeadPictures final : public PictureMaker {
  public:
    /// Everything must outlive this.
    LeadPictures(RankLink& link, const Tracer& tracer, CachePrepass prepass,
                 WorkerContexts& contexts, ProgressListener listener, const StopFlag& stop)
        : link_(link),
          tracer_(tracer),
          prepass_(prepass),
          contexts_(contexts),
          listener_(std::move(listener)),
          stop_(stop) {}

    void order(std::shared_ptr<const PictureRequest> request) override;
    [[nodiscard]] std::optional<Frame> take() override;
    /// The next picture's blocks are there when the last ones of this one are still out. But before
    /// a deterministic one all rays of the one before must have ended.
    [[nodiscard]] std::size_t ahead() const override {
        return prepass_ == CachePrepass::deterministic ? 1 : 2;
    }

  private:
    struct Ordered {
        JobId job = 0;
        std::shared_ptr<const PictureRequest> request;
    };
    RankLink& link_;
    const Tracer& tracer_;
    CachePrepass prepass_;
    WorkerContexts& contexts_;
    ProgressListener listener_;
    const StopFlag& stop_;
    std::deque<Ordered> ordered_;
    JobId next_ = 0;
};

/// Renders the blocks of orders, on every rank that traces.
class RankPictures final : public RankWork {
  public:
    /// @param options  of all pictures, but for what an order says
    /// @param cache     null without ambient values
    RankPictures(RankLink& link, const Tracer& tracer, const FrameOptions& options,
                 PublishedCache* cache, WorkerContexts& contexts, WarningSink& warnings,
                 const StopFlag& stop)
        : link_(link),
          tracer_(tracer),
          options_(options),
          cache_(cache),
          contexts_(contexts),
          warnings_(warnings),
          stop_(stop) {}

    void trace(Executor& executor) override;
    [[nodiscard]] RayCounters rays() const override;
    [[nodiscard]] AmbientCounters ambient() const override;

  private:
    [[nodiscard]] std::shared_ptr<const BlockRenderer> make(const PictureJob& job);
    void fill(const Camera& camera, const FrameOptions& options);

    RankLink& link_;
    const Tracer& tracer_;
    FrameOptions options_;
    PublishedCache* cache_;
    WorkerContexts& contexts_;
    WarningSink& warnings_;
    const StopFlag& stop_;
    RayCounters prepass_rays_;
    AmbientCounters prepass_ambient_;
};

/// The pieces put together. Throws InputError for pieces that do not make the picture.
[[nodiscard]] Frame assemble(const FinishedPicture& picture, int width, int height);

}  // namespace lightwalk
