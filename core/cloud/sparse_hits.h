#pragma once
// Nearest hits of a square's pixels from few rays: what the rays at the corners of a cell meet, if
// it is one plane, those between them meet as well.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/geometry.h"
#include "core/view/pixels.h"

namespace lightwalk {

/// Akimoto, Mase and Suenaga, "Pixel-selected ray tracing", IEEE Computer Graphics and Applications
/// 11 (1991). A cell whose corners do not agree is divided; what is smaller than a cell, and lies
/// between its corners, is not seen. Each thread needs its own, whose memory is reused.
class SparseHits {
  public:
    static constexpr int kSide = 8;  ///< of the squares, which are aligned to multiples of it
    /// Pixels of a square from which on it is worth while to cast the rays of all its corners.
    static constexpr std::size_t kWorthCorners = 24;

    /// The pixels whose rays find() needs beside those of `places`: corners of cells.
    /// @param places   the pixels of a square one after the other
    /// @param spacing  of the coarsest corners: 2 or 4 [pixels]
    [[nodiscard]] std::span<const PixelPlace> corners(std::span<const PixelPlace> places,
                                                      int spacing);

    /// The nearest hits of the pixels that corners() was called for, and of the corners.
    /// @param rays  of `places`, then of what corners() returned; these places must still be there
    /// @param hits  one a ray
    void find(const Geometry& geometry, std::span<const RaySegment> rays, std::span<Hit> hits);

  private:
    /// Pixels x0 ... x1, y0 ... y1 of a square, corners included.
    struct Cell {
        std::uint32_t square;
        std::uint8_t x0, y0, x1, y1;
    };
    using Square =
        std::array<std::int32_t, std::size_t{kSide} * kSide>;  ///< rays by pixel; kNone: none
    static constexpr std::int32_t kNone = -1;

    [[nodiscard]] std::int32_t& at(std::uint32_t square, int x, int y) {
        const auto row = static_cast<std::size_t>(y) * kSide;
        return squares_[square][row + static_cast<std::size_t>(x)];
    }
    void begin_square(std::span<const PixelPlace> pixels, int spacing);
    void cast(const Geometry& geometry, std::span<const RaySegment> rays, std::span<Hit> hits);
    [[nodiscard]] bool is_plane(const Cell& cell, std::span<const Hit> hits);
    void fill(const Cell& cell, std::span<const RaySegment> rays, std::span<Hit> hits);
    void split(const Cell& cell, std::vector<Cell>& parts) const;
    void want(std::int32_t ray);

    std::vector<Square> squares_;
    std::vector<PixelPlace> corners_;
    std::vector<Cell> cells_, parts_;
    std::vector<std::uint32_t> wanted_;  ///< rays to be cast next
    std::vector<std::uint8_t> known_;    ///< by ray: its hit is known, or will be after cast()
    std::vector<RaySegment> segments_;
    std::vector<Hit> found_;
    std::size_t places_ = 0;
};

}  // namespace lightwalk
