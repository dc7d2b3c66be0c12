#pragma once
// The pictures of one command, one after the other: sizes, headers, files.
#include <deque>
#include <optional>
#include <vector>

#include "apps/checkpoint.h"
#include "apps/film.h"
#include "apps/picture_maker.h"
#include "apps/render_command.h"
#include "apps/scene_session.h"

namespace lightwalk {

/// One picture to be made.
struct WantedPicture {
    View view;
    std::optional<View> before;  ///< the view of the frame before it
    int frame = 0;               ///< number in a sequence; 0: the only picture
};

/// The options of a frame that the command's pictures have.
[[nodiscard]] FrameOptions frame_options(const RenderCommand& command, const PictureSize& size);

class PictureSeries {
  public:
    /// Everything must outlive this.
    /// @param checkpoint  null: none
    PictureSeries(const RenderCommand& command, const Model& model, WarningSink& warnings,
                  RunStatistics& statistics, Checkpoint* checkpoint)
        : command_(command),
          tone_(command.tone),
          model_(model),
          warnings_(warnings),
          statistics_(statistics),
          checkpoint_(checkpoint) {}

    /// All pictures of a sequence are exposed as the first one is: without that a walk flickers.
    void keep_exposure() { keeps_exposure_ = true; }

    /// Make and write them. False: interrupted.
    [[nodiscard]] bool make(const std::vector<WantedPicture>& wanted, PictureMaker& maker);

  private:
    PictureSize order(const WantedPicture& wanted, PictureMaker& maker);
    [[nodiscard]] bool finish(const WantedPicture& wanted, const PictureSize& size,
                              PictureMaker& maker);
    void check_size(const PictureSize& size);
    [[nodiscard]] PictureHeader header(const WantedPicture& wanted, double pixel_aspect) const;
    void write(const Frame& frame, const PictureHeader& header, int number);
    void add_to_film(const Picture& picture);

    const RenderCommand& command_;
    ToneMapping tone_;
    bool keeps_exposure_ = false;
    const Model& model_;
    WarningSink& warnings_;
    RunStatistics& statistics_;
    Checkpoint* checkpoint_;
    std::optional<Film> film_;
};

}  // namespace lightwalk
