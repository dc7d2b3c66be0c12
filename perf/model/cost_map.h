#pragma once
// The cost of tracing each part of a picture, measured in a real run (perf/cost_map.cpp).
#include <nlohmann/json.hpp>
#include <vector>

#include "core/view/pixels.h"

namespace lightwalk {

/// Seconds and new ambient values of the cells of a picture. Cells are squares of `cell` pixels,
/// clipped at the picture's edge; rows from the bottom, left to right.
struct CellCosts {
    int width = 0, height = 0, cell = 8;  ///< [pixels]
    std::vector<double> seconds;  ///< time of each cell when all its ambient values exist [s]
    std::vector<int> values;  ///< number of ambient values made in each cell; empty without a cache
    std::vector<double> making;  ///< time of making these values [s]
    [[nodiscard]] int columns() const { return (width + cell - 1) / cell; }
    [[nodiscard]] int rows() const { return (height + cell - 1) / cell; }
    [[nodiscard]] PixelRectangle area() const { return {0, 0, width, height}; }
};

struct CostMap {
    CellCosts picture;
    CellCosts prepass;         ///< the coarse picture that fills the cache before; width 0: none
    double setup_seconds = 0;  ///< time before the first block of a picture, on every rank
    double block_seconds = 0;  ///< time of a block beside that of its cells
    double encode_seconds = 0, decode_seconds = 0;  ///< time for a pixel of a part
    double packed_bytes = 6;                        ///< size of a pixel of a part
};

/// Parse a cost map. Throws InputError for text that perf/cost_map.cpp cannot have written.
[[nodiscard]] CostMap read_cost_map(const nlohmann::json& json);

/// The time of any rectangle of the picture, at any resolution [s].
class BlockCosts {
  public:
    /// @param width, height  size of the simulated picture; a pixel takes the same time as in the
    /// map
    BlockCosts(const CellCosts& cells, int width, int height);
    [[nodiscard]] double seconds(const PixelRectangle& block) const;

  private:
    [[nodiscard]] double below(double x, double y) const;  ///< time of all cells there

    int columns_, rows_;
    double x_scale_, y_scale_;  ///< cells for each pixel
    double cost_scale_;
    double last_width_, last_height_;  ///< size of the cells at the edge, as a share of a cell
    std::vector<double> sums_;
};

}  // namespace lightwalk
