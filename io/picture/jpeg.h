#pragma once
// JPEG for pictures that are seen for a moment: by libjpeg-turbo itself, without OpenImageIO's
// module, and without memory of its own a picture.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace lightwalk {

/// A rectangle of 8-bit pixels r g b, rows from the top, their beginnings `stride` bytes apart.
struct RgbRows {
    const std::uint8_t* first = nullptr;
    int width = 0, height = 0;
    std::size_t stride = 0;  ///< [bytes], at least 3 width
};

/// From this quality on colours keep their full resolution (4:4:4, else 4:2:0).
inline constexpr int kJpegFullColour = 90;

/// Compresses one rectangle after another; one object a thread.
class JpegCompressor {
  public:
    JpegCompressor();
    ~JpegCompressor();
    JpegCompressor(JpegCompressor&&) noexcept;
    JpegCompressor& operator=(JpegCompressor&&) noexcept;

    /// The bytes of a JPEG file, up to the next call; `quality` 1 to 100. The same pixels give the
    /// same bytes. Throws InputError "cannot encode jpeg: ..." for a rectangle that is empty or has
    /// a side beyond 65535, and when libjpeg-turbo fails.
    [[nodiscard]] std::span<const std::uint8_t> compress(const RgbRows& rows, int quality);

  private:
    struct Release {
        void operator()(void* handle) const noexcept;
    };
    std::unique_ptr<void, Release> handle_;
    std::vector<std::uint8_t> bytes_;
};

}  // namespace lightwalk
