#pragma once
// What a run has drawn last, for pages that come while there is none.
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "io/net/walk_frame.h"
#include "io/net/walk_request.h"
#include "io/net/web_server.h"

namespace lightwalk {

/// Frames bring only what has changed, so it follows those of one client, from one on that has the
/// whole picture. Holds no more than such a frame, of at most 64 MB. For one thread.
class NewestFrame {
  public:
    /// Who drives tells the run something.
    void said(std::string_view text);
    /// The run has sent a frame.
    void came(ClientId client, bool drives, std::string_view message);
    /// It sends this client no more; what it has sent stays.
    void left(ClientId client);

    struct Messages {
        std::vector<std::string> texts;  ///< the view, and how radiance became colours, if known
        std::string frame;               ///< the whole picture
    };
    /// As somebody who watches is told. Nothing: there has been no frame.
    [[nodiscard]] std::optional<Messages> messages(const HelloRequest& to) const;

  private:
    using Place = std::tuple<PieceCodec, int, int, int, int>;  ///< codec, x, y, width, height
    static Place place_of(const WalkFramePiece& piece);
    void note_view(std::uint32_t id);

    std::deque<ViewRequest> views_;  ///< that were wished for, and may still be drawn
    std::optional<DisplayRequest> display_;
    std::optional<ClientId> followed_;
    WalkFrameHeader header_;
    std::optional<ViewRequest> view_;  ///< of the frame
    std::map<Place, std::string> pieces_;
};

}  // namespace lightwalk
