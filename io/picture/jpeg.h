#pragma once
// A fast JPEG encoder for the frames of a walk, which calls libjpeg-turbo directly and reuses its
// memory.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace lightwalk {

/// A rectangle of 8-bit pixels r g b, in rows from the top that begin `stride` bytes apart.
struct RgbRows {
    const std::uint8_t* first = nullptr;
    int width = 0, height = 0;
    std::size_t stride = 0;  ///< [bytes], at least 3 width
};

/// The least quality at which colours keep their full resolution (4:4:4); below it 4:2:0.
inline constexpr int kJpegFullColour = 90;

/// A compressor whose memory is reused from rectangle to rectangle; for one thread.
class JpegCompressor {
  public:
    JpegCompressor();
    ~JpegCompressor();
    JpegCompressor(JpegCompressor&&) noexcept;
    JpegCompressor& operator=(JpegCompressor&&) noexcept;

    /// Encode a rectangle as a JPEG file. The returned bytes are valid until the next call, and
    /// depend on the pixels and `quality` (1 to 100) only. Throws InputError "cannot encode jpeg:
    /// ..." for an empty rectangle, for a side beyond 65535, and when libjpeg-turbo fails.
    [[nodiscard]] std::span<const std::uint8_t> compress(const RgbRows& rows, int quality);

  private:
    struct Release {
        void operator()(void* handle) const noexcept;
    };
    std::unique_ptr<void, Release> handle_;
    std::vector<std::uint8_t> bytes_;
};

}  // namespace lightwalk
