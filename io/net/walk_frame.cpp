#include "io/net/walk_frame.h"

#include <bit>
#include <cassert>
#include <limits>

namespace lightwalk {
namespace {

constexpr std::size_t kHeaderBytes = 48, kPieceBytes = 16;

/// Append the lowest `bytes` bytes of a number, the lowest first.
void append(std::string& out, std::uint64_t number, int bytes) {
    for (int i = 0; i < bytes; ++i) out += static_cast<char>((number >> (8 * i)) & 255);
}

void append_header(std::string& out, const WalkFrameHeader& header, std::size_t pieces) {
    out += "LWF1";
    append(out, header.frame, 4);
    append(out, header.view, 4);
    append(out, header.width, 2);
    append(out, header.height, 2);
    append(out,
           (header.whole ? 1u : 0u) | (header.at_rest ? 2u : 0u) | (header.finished ? 4u : 0u) |
               (header.denoised ? 8u : 0u),
           1);
    append(out, header.display, 1);
    append(out, pieces, 2);
    append(out, std::bit_cast<std::uint32_t>(header.exposure), 4);
    append(out, std::bit_cast<std::uint64_t>(header.eye.x), 8);
    append(out, std::bit_cast<std::uint64_t>(header.eye.y), 8);
    append(out, std::bit_cast<std::uint64_t>(header.eye.z), 8);
}

}  // namespace

std::string encode_walk_frame(const WalkFrameHeader& header,
                              std::span<const WalkFramePiece> pieces) {
    assert(pieces.size() <= std::numeric_limits<std::uint16_t>::max());
    std::size_t size = kHeaderBytes;
    for (const WalkFramePiece& piece : pieces) size += kPieceBytes + piece.bytes.size();
    std::string out;
    out.reserve(size);
    append_header(out, header, pieces.size());
    for (const WalkFramePiece& piece : pieces) {
        assert(piece.bytes.size() <= std::numeric_limits<std::uint32_t>::max());
        append(out, piece.x, 2);
        append(out, piece.y, 2);
        append(out, piece.width, 2);
        append(out, piece.height, 2);
        append(out, static_cast<std::uint8_t>(piece.codec), 1);
        append(out, 0, 3);
        append(out, piece.bytes.size(), 4);
        out += piece.bytes;
    }
    return out;
}

}  // namespace lightwalk
