#pragma once
// A frame as one binary message, in the layout of io/net/README.md.
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/math/vec3.h"

namespace lightwalk {

struct WalkFrameHeader {
    std::uint32_t frame = 0;
    std::uint32_t view = 0;  ///< id of the newest view that the frame shows
    std::uint16_t width = 0, height = 0;
    bool whole = false;        ///< the message has all pieces of the picture
    bool at_rest = false;      ///< the eye stands still
    bool finished = false;     ///< the picture will not be refined any more
    bool denoised = false;     ///< its colours are of a picture for the eye, not of what was traced
    std::uint8_t display = 0;  ///< number of the settings that its colours are after
    float exposure = 1;        ///< factor that radiance was multiplied by
    Vec3 eye;                  ///< position of the eye [m]
};

/// depth: see depth_patches.h; empty where the view has none. luminance: see luminance_plane.h.
enum class PieceCodec : std::uint8_t { jpeg = 1, png = 2, depth = 3, luminance = 4 };

/// A compressed rectangle of the picture.
struct WalkFramePiece {
    std::uint16_t x = 0, y = 0;  ///< upper left corner, y downward from the picture's top
    std::uint16_t width = 0, height = 0;
    PieceCodec codec = PieceCodec::jpeg;
    std::string_view bytes;  ///< must outlive the call
};

/// The message of a frame; at most 65535 pieces of less than 4 GB each.
[[nodiscard]] std::string encode_walk_frame(const WalkFrameHeader& header,
                                            std::span<const WalkFramePiece> pieces);

struct WalkFrameParts {
    WalkFrameHeader header;
    std::vector<WalkFramePiece> pieces;  ///< their bytes are the message's
};
/// Take a message apart, which must outlive the result. Nothing: it is no frame, has pieces of an
/// unknown codec or outside its picture, or ends elsewhere.
[[nodiscard]] std::optional<WalkFrameParts> parse_walk_frame(std::string_view message);

}  // namespace lightwalk
