#pragma once
// Pictures whose blocks many ranks render: what rank 0 tells the others of one, and what they make
// of it.
#include <memory>
#include <optional>
#include <string>

#include "apps/rank_link.h"
#include "parallel/frame.h"
#include "parallel/frame_options.h"
#include "parallel/freezable_cache.h"

namespace lightwalk {

/// A picture as rank 0 describes it. Everything else follows from the command line, which all ranks
/// have read.
struct PictureOrder {
    View view;
    std::optional<View> previous;  ///< for motion blur
    int width = 0, height = 0;
    int step = 1;
    bool deterministic = false;  ///< fill the cache before, each rank by itself
};
[[nodiscard]] std::string encode_order(const PictureOrder& order);
/// Throws InputError for text that encode_order did not make.
[[nodiscard]] PictureOrder decode_order(const std::string& text);

/// Renders the blocks of orders, on every rank that traces.
class RankPictures {
  public:
    /// @param options  of all pictures, but for what an order says
    /// @param cache    null without ambient values
    RankPictures(const Tracer& tracer, const FrameOptions& options, FreezableCache* cache,
                 WorkerContexts& contexts, WarningSink& warnings, const StopFlag& stop)
        : tracer_(tracer),
          options_(options),
          cache_(cache),
          contexts_(contexts),
          warnings_(warnings),
          stop_(stop) {}

    /// For RankLink::trace.
    [[nodiscard]] std::shared_ptr<const BlockRenderer> make(const JobStart& job);

    [[nodiscard]] RayCounters rays() const;
    [[nodiscard]] AmbientCounters ambient() const;

  private:
    void fill(const Camera& camera, const FrameOptions& options);

    const Tracer& tracer_;
    FrameOptions options_;
    FreezableCache* cache_;
    WorkerContexts& contexts_;
    WarningSink& warnings_;
    const StopFlag& stop_;
    RayCounters overture_rays_;
    AmbientCounters overture_ambient_;
};

/// The pieces put together. Throws InputError for pieces that do not make the picture.
[[nodiscard]] Frame assemble(const FinishedPicture& picture, int width, int height);

}  // namespace lightwalk
