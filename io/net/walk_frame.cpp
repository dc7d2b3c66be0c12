#include "io/net/walk_frame.h"

#include <bit>
#include <cassert>
#include <limits>

namespace lightwalk {
namespace {

constexpr std::string_view kMagic = "LWF1";
constexpr std::size_t kHeaderBytes = 48, kPieceBytes = 16;

/// Append the lowest `bytes` bytes of a number, the lowest first.
void append(std::string& out, std::uint64_t number, int bytes) {
    for (int i = 0; i < bytes; ++i) out += static_cast<char>((number >> (8 * i)) & 255);
}

void append_header(std::string& out, const WalkFrameHeader& header, std::size_t pieces) {
    out += kMagic;
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

/// Takes the lowest bytes of numbers off the front of a text, which is long enough.
std::uint64_t take(std::string_view& text, std::size_t bytes) {
    std::uint64_t number = 0;
    for (std::size_t i = 0; i < bytes; ++i)
        number |= std::uint64_t{static_cast<std::uint8_t>(text[i])} << (8 * i);
    text.remove_prefix(bytes);
    return number;
}

std::uint16_t take_16(std::string_view& text) {
    return static_cast<std::uint16_t>(take(text, 2));
}

WalkFrameHeader take_header(std::string_view& text) {
    WalkFrameHeader header;
    header.frame = static_cast<std::uint32_t>(take(text, 4));
    header.view = static_cast<std::uint32_t>(take(text, 4));
    header.width = take_16(text);
    header.height = take_16(text);
    const std::uint64_t flags = take(text, 1);
    header.whole = (flags & 1) != 0;
    header.at_rest = (flags & 2) != 0;
    header.finished = (flags & 4) != 0;
    header.denoised = (flags & 8) != 0;
    header.display = static_cast<std::uint8_t>(take(text, 1));
    return header;
}

/// The next piece; false: there is none, or none of such a picture.
bool take_piece(std::string_view& text, const WalkFrameHeader& picture, WalkFramePiece& piece) {
    if (text.size() < kPieceBytes) return false;
    piece.x = take_16(text);
    piece.y = take_16(text);
    piece.width = take_16(text);
    piece.height = take_16(text);
    const std::uint64_t codec = take(text, 4);  // and zeros
    const std::uint64_t size = take(text, 4);
    if (codec < 1 || codec > static_cast<std::uint64_t>(PieceCodec::luminance) ||
        piece.x + piece.width > picture.width || piece.y + piece.height > picture.height ||
        size > text.size())
        return false;
    piece.codec = static_cast<PieceCodec>(codec);
    piece.bytes = text.substr(0, size);
    text.remove_prefix(size);
    return true;
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

std::optional<WalkFrameParts> parse_walk_frame(std::string_view message) {
    if (message.size() < kHeaderBytes || !message.starts_with(kMagic)) return std::nullopt;
    message.remove_prefix(kMagic.size());
    WalkFrameParts parts;
    parts.header = take_header(message);
    const std::size_t pieces = take_16(message);
    parts.header.exposure = std::bit_cast<float>(static_cast<std::uint32_t>(take(message, 4)));
    for (double* const place : {&parts.header.eye.x, &parts.header.eye.y, &parts.header.eye.z})
        *place = std::bit_cast<double>(take(message, 8));
    for (std::size_t i = 0; i < pieces; ++i)
        if (!take_piece(message, parts.header, parts.pieces.emplace_back())) return std::nullopt;
    if (!message.empty()) return std::nullopt;
    return parts;
}

}  // namespace lightwalk
