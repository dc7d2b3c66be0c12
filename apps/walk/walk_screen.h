#pragma once
// From pictures of radiance to what browsers show: colours, compressed pieces, frames.
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/walk/client_inbox.h"
#include "apps/walk/depth_piece.h"
#include "core/view/pixels.h"
#include "io/net/frame_flow.h"
#include "io/net/luminance_plane.h"
#include "io/picture/display.h"
#include "io/picture/jpeg.h"
#include "parallel/executor.h"
#include "parallel/walk/live_walk.h"

namespace lightwalk {

/// What goes with a picture.
struct ShownView {
    std::uint32_t id = 0;  ///< of the newest view it shows
    Vec3 eye;              ///< [m]
    bool at_rest = false;
    bool finished = false;  ///< as good as it gets
    bool denoised = false;  ///< its colours are those of a picture for the eye
    friend bool operator==(const ShownView&, const ShownView&) = default;
};

/// For one thread.
class WalkScreen {
  public:
    using Time = FrameFlow::Time;

    /// The executor must outlive this.
    explicit WalkScreen(Executor& executor);

    /// Who has joined, left, and drawn frames.
    void update_clients(const InboxContents& news);
    /// Clients have drawn frames. What was never sent to them counts for nothing.
    void acked(std::span<const WalkAck> acks);

    /// Whether all clients draw the camera of the moment themselves, from how far away things are.
    [[nodiscard]] bool all_want_depth() const {
        return !clients_.empty() && how_many(&Client::wants_depth) == clients_.size();
    }
    /// How many pixels a frame of a view in motion may have, that no client waits for long for it.
    [[nodiscard]] double most_moving_pixels() const;
    /// The colours of the pictures to come are those of another screen, so that both can be
    /// compared; null: its own.
    /// @param lead        must outlive this, or its being followed
    /// @param difference  from this picture is shown in place of colours; null: it is not
    void follow(const WalkScreen* lead, const LivePicture* difference) {
        lead_ = lead;
        difference_ = difference;
    }
    /// Whether the screen that it follows has shown another picture since this one has.
    [[nodiscard]] bool is_outdated() const {
        return lead_ != nullptr && followed_ != lead_->pictures_;
    }
    /// Before show(): how far away what the picture shows is, for the pages that want to know.
    /// @param eye_height  see DepthPiece
    void measure_depth(const LivePicture& picture, const View& view, double eye_height);
    /// The newest picture, in its colours.
    /// @param clean  radiance whose colours are shown in place of the picture's, as many pixels;
    ///               empty: none. How bright it is, its luminance and its difference from another
    ///               one stay those of the picture
    void show(const LivePicture& picture, const DisplayRequest& request, const ShownView& view,
              Time now, std::span<const Rgb> clean = {});
    /// Compress what clients lack, and send it to all that are ready for a frame.
    void send(ClientInbox& client_inbox, Time now);
    /// When a client may be ready that is not now; Time::max(): only when it says so.
    [[nodiscard]] Time next_chance() const;

  private:
    struct Piece {
        PixelRectangle area;  ///< rows from the top
        std::uint64_t content = 0;
        int quality = 0;
        bool compressed = false;
        std::string bytes = "";
    };
    struct Client {
        FrameFlow flow;
        bool wants_depth = false, wants_luminance = false;
        std::optional<ShownView> shown;  ///< nothing: no picture yet
    };

    void cut(int width, int height);
    [[nodiscard]] std::size_t how_many(bool Client::*want) const;
    void adapt(const LivePicture& picture, Time now);
    void colour(Piece& piece, const LivePicture& picture, std::span<const Rgb> radiance,
                const Display& display, int quality);
    [[nodiscard]] int moving_quality() const;
    static void show_difference(const LivePicture& base, const LivePicture& picture,
                                const PixelRectangle& area, int y, std::span<std::uint8_t> row);
    void compress(std::span<const std::size_t> pieces);
    // Beside the picture's pieces.
    [[nodiscard]] std::size_t depth_index() const { return pieces_.size(); }
    [[nodiscard]] std::size_t luminance_index() const { return pieces_.size() + 1; }
    [[nodiscard]] std::size_t wanted(const Client& client) const {
        return pieces_.size() + (client.wants_depth ? 1 : 0) + (client.wants_luminance ? 1 : 0);
    }
    /// How the picture is divided into pieces.
    [[nodiscard]] std::uint64_t layout() const {
        return static_cast<std::uint64_t>(width_) << 32U | static_cast<std::uint64_t>(height_);
    }
    /// The pieces that a client wants and lacks.
    [[nodiscard]] std::vector<std::size_t> missing(const Client& client) const;
    [[nodiscard]] bool lacks(const Client& client) const {
        return client.shown != view_ || !missing(client).empty();
    }
    [[nodiscard]] std::shared_ptr<const std::string> frame_of(std::span<const std::size_t> pieces,
                                                              bool whole);

    Executor& executor_;
    std::vector<JpegCompressor> compressors_;  ///< one for each worker
    std::map<ClientId, Client> clients_;
    int width_ = 0, height_ = 0;
    std::vector<Piece> pieces_;
    DepthPiece depth_;
    LuminancePlane luminance_;
    std::vector<std::uint64_t> contents_;  ///< of the pieces, of the depth, of the luminance
    std::vector<std::uint8_t> bytes_;      ///< r, g, b of the picture
    ShownView view_;
    Adaptation eye_;
    std::optional<BrightnessHistogram> brightness_;  ///< of the picture; nothing: there is none
    const WalkScreen* lead_ = nullptr;               ///< see follow()
    const LivePicture* difference_ = nullptr;        ///< see follow()
    std::uint64_t pictures_ = 0, followed_ = 0;      ///< that it, and its lead, has shown
    Time last_look_{};
    float exposure_ = 1;
    std::uint8_t display_ = 0;  ///< number of the settings that the colours are after
    std::uint32_t frame_ = 0;
};

}  // namespace lightwalk
