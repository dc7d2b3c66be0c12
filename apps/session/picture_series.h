#pragma once
// The pictures of one run, one after the other: rendered, and written to files.
#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/session/checkpoint.h"
#include "apps/session/lightwalk/renderer.h"
#include "core/view/view.h"
#include "io/picture/denoiser.h"
#include "io/picture/film.h"
#include "io/picture/picture.h"
#include "io/picture/tone.h"
#include "parallel/stop_flag.h"

namespace lightwalk {

/// One picture to be made.
struct WantedPicture {
    View view;
    std::optional<View> before;  ///< the view of the frame before it
    int frame = 0;               ///< number in a sequence; 0: the only picture
};

/// Where the pictures go, and what their headers say.
struct SeriesOutput {
    std::string picture;  ///< file, with %d for the frame's number; "": to `bytes`
    std::string depth;    ///< file for distances; "": none
    std::function<void(const std::string& bytes)> bytes;  ///< takes a Radiance picture
    std::vector<std::string> history;                     ///< first lines of the headers
    std::optional<std::array<double, 8>> primaries;       ///< what the header says of the channels
    bool layers = false;              ///< pictures have them: see io/picture/layers.h for `picture`
    bool xyz = false;                 ///< pictures hold CIE XYZ, not RGB
    ToneMapping tone;                 ///< of pictures for screens
    bool denoise = false;             ///< of these, before
    bool keep_exposure = false;       ///< all are exposed as the first one is: else a walk flickers
    std::optional<double> film_rate;  ///< `picture` is a film of so many frames a second
};

/// What happens to a picture of a series.
enum class SeriesStage {
    rendering,  ///< it can be given up
    writing,    ///< it should be finished
    between,    ///< all that was begun is finished
};

/// Who accompanies a series; functions that are not there are not called, but for `size_of`.
struct SeriesObserver {
    /// The size of the picture of a view; may refuse it by an exception.
    std::function<PictureSize(const View& view)> size_of;
    /// A picture is about to be started.
    std::function<void(const WantedPicture& picture)> begins;
    std::function<void(SeriesStage stage)> enters;
    /// Where a picture's error is known and it is denoised: before and after that.
    std::function<void(const Denoiser::Errors& errors)> denoised;
    /// The name of a file that has to be removed if the process ends before it tells ""
    std::function<void(const std::string& path)> unfinished_file;
};

/// What a series has made so far.
struct SeriesResult {
    int frames = 0;
    int width = 0, height = 0;  ///< of the last picture [pixels]
    double seconds = 0;         ///< spent on waiting for pictures
};

class PictureSeries {
  public:
    /// @param stop        requested: no further picture is begun; must outlive this
    /// @param checkpoint  null: none
    PictureSeries(SeriesOutput output, SeriesObserver observer, const StopFlag& stop,
                  Checkpoint* checkpoint);

    /// Make and write them. False: stopped. Throws InputError.
    [[nodiscard]] bool make(const std::vector<WantedPicture>& wanted, Renderer& renderer);
    [[nodiscard]] const SeriesResult& result() const { return result_; }

  private:
    /// A picture that was started; without a ticket it has no pixels.
    struct Started {
        PictureSize size;
        std::optional<Ticket<RenderedPicture>> ticket;
    };
    [[nodiscard]] Started start(const WantedPicture& wanted, Renderer& renderer);
    [[nodiscard]] bool finish(const WantedPicture& wanted, const Started& started,
                              Renderer& renderer);
    [[nodiscard]] PictureHeader header(const WantedPicture& wanted, double pixel_aspect) const;
    void write(RenderedPicture& rendered, const PictureHeader& header, int number);
    void write_layers_of(const Picture& whole, const RenderedPicture& rendered,
                         const PictureHeader& header, int number) const;
    void add_to_film(const Picture& picture);
    void enter(SeriesStage stage) const;

    SeriesOutput output_;
    SeriesObserver observer_;
    const StopFlag& stop_;
    Checkpoint* checkpoint_;
    std::optional<Denoiser> denoiser_;  ///< where pictures are denoised
    std::optional<Film> film_;
    SeriesResult result_;
};

}  // namespace lightwalk
