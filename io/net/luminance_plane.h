#pragma once
// The luminance of a picture at a quarter of its size, as a piece of a frame: pages change exposure
// and colours, and read luminance, without asking. Its bytes are described in io/net/README.md.
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/math/rgb.h"
#include "core/view/pixels.h"
#include "io/picture/jpeg.h"

namespace lightwalk {

/// For one thread, but for measure().
class LuminancePlane {
  public:
    static constexpr int kSquare = 4;  ///< side of what a value stands for [pixels]

    /// Begin with a picture of that size, row by row from the top [pixels].
    void begin(int width, int height);
    /// Measure the squares of an area: x0 and y0 are multiples of kSquare, as are x1 and y1 within
    /// the picture. Threads may measure areas apart from each other at the same time.
    /// @param picture  radiance of all its pixels
    void measure(std::span<const Rgb> picture, const PixelRectangle& area);
    /// When all is measured.
    /// @param white  see Display::white()
    void finish(float white);
    /// Keep none.
    void forget() { content_ = 0; }

    /// A hash of what is kept; 0: nothing.
    [[nodiscard]] std::uint64_t content() const { return content_; }
    /// The piece's bytes; empty where content() is 0.
    [[nodiscard]] const std::string& bytes(JpegCompressor& compressor);

  private:
    int width_ = 0, height_ = 0;             ///< of the picture [pixels]
    int columns_ = 0, rows_ = 0;             ///< of squares
    std::vector<float> logarithms_;          ///< to the base of 2 [cd/m²]; -infinity: black
    std::vector<std::uint8_t> greys_;        ///< 0: black
    float low_ = 0, step_ = 0, white_ = 0;   ///< see README.md
    std::uint64_t content_ = 0, coded_ = 0;  ///< coded_: content of the bytes
    std::string bytes_;
};

}  // namespace lightwalk
