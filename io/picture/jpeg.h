#pragma once
// A fast JPEG encoder for the frames of a walk, which calls libjpeg-turbo directly and reuses its
// memory.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace lightwalk {

/// A rectangle of pixels of 8 bits a channel, in rows from the top that begin `stride` bytes apart.
struct PixelRows {
    const std::uint8_t* first = nullptr;
    int width = 0, height = 0;
    std::size_t stride = 0;  ///< [bytes], at least that of a row
};

/// The least quality at which colours keep their full resolution (4:4:4); below it 4:2:0.
inline constexpr int kJpegFullColour = 85;

/// A compressor whose memory is reused from rectangle to rectangle; for one thread.
class JpegCompressor {
  public:
    JpegCompressor();
    ~JpegCompressor();
    JpegCompressor(JpegCompressor&&) noexcept;
    JpegCompressor& operator=(JpegCompressor&&) noexcept;

    /// Encode a rectangle of r g b as a JPEG file. The returned bytes are valid until the next
    /// call, and depend on the pixels and `quality` (1 to 100) only. Throws InputError "cannot
    /// encode jpeg:
    /// ..." for an empty rectangle, for a side beyond 65535, and when libjpeg-turbo fails.
    [[nodiscard]] std::span<const std::uint8_t> compress(const PixelRows& rows, int quality);
    /// The same for a rectangle of greys.
    [[nodiscard]] std::span<const std::uint8_t> compress_grey(const PixelRows& rows, int quality);

  private:
    struct Release {
        void operator()(void* handle) const noexcept;
    };
    std::span<const std::uint8_t> encode(const PixelRows& rows, int quality, int pixel_format,
                                         int sampling);

    std::unique_ptr<void, Release> handle_;
    std::vector<std::uint8_t> bytes_;
};

}  // namespace lightwalk
