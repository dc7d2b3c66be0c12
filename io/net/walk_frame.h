#pragma once
// A frame as the bytes of one binary message. The layout is in README.md beside this.
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/math/vec3.h"

namespace lightwalk {

struct WalkFrameHeader {
    std::uint32_t frame = 0;
    std::uint32_t view = 0;  ///< id of the newest view it shows
    std::uint16_t width = 0, height = 0;
    bool whole = false;  ///< all pieces are here
    bool at_rest = false;
    bool finished = false;  ///< as good as it gets
    float exposure = 1;     ///< factor that was applied
    Vec3 eye;               ///< [m]
};

enum class PieceCodec : std::uint8_t { jpeg = 1, png = 2 };

/// A rectangle of the picture, compressed.
struct WalkFramePiece {
    std::uint16_t x = 0, y = 0;  ///< of its upper left corner, from the picture's
    std::uint16_t width = 0, height = 0;
    PieceCodec codec = PieceCodec::jpeg;
    std::string_view bytes;  ///< must outlive the call
};

/// The message; at most 65535 pieces of less than 4 GB.
[[nodiscard]] std::string encode_walk_frame(const WalkFrameHeader& header,
                                            std::span<const WalkFramePiece> pieces);

}  // namespace lightwalk
