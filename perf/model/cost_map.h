#pragma once
// What tracing each part of a picture costs, as a real run measured it (perf/cost_map.cpp).
#include <nlohmann/json.hpp>
#include <vector>

#include "core/view/pixels.h"

namespace lightwalk {

/// Seconds and new ambient values of a picture's cells: squares of `cell` pixels, the last of a row
/// or column cut off at the picture's edge; rows from the bottom, left to right.
struct CellCosts {
    int width = 0, height = 0, cell = 8;  ///< [pixels]
    std::vector<double> seconds;          ///< of each cell, once all its ambient values are there
    std::vector<int> values;              ///< ambient values that it made; empty: none are kept
    std::vector<double> making;           ///< what these took [s]
    [[nodiscard]] int columns() const { return (width + cell - 1) / cell; }
    [[nodiscard]] int rows() const { return (height + cell - 1) / cell; }
    [[nodiscard]] PixelRectangle area() const { return {0, 0, width, height}; }
};

struct CostMap {
    CellCosts picture;
    CellCosts prepass;         ///< the coarse picture that comes before; width 0: there is none
    double setup_seconds = 0;  ///< before the first block of a picture, on every rank
    double block_seconds = 0;  ///< more for a block than for its cells
    double encode_seconds = 0, decode_seconds = 0;  ///< of a piece, a pixel
    double packed_bytes = 6;                        ///< of a piece, a pixel
};

/// Throws InputError for what perf/cost_map.cpp does not write.
[[nodiscard]] CostMap read_cost_map(const nlohmann::json& json);

/// Seconds of any rectangle of the picture, at any resolution.
class BlockCosts {
  public:
    /// @param width, height  of the picture that is simulated; as many pixels of the map's as lie
    ///                       beside it take the time of one, each
    BlockCosts(const CellCosts& cells, int width, int height);
    [[nodiscard]] double seconds(const PixelRectangle& block) const;

  private:
    [[nodiscard]] double below(double x, double y) const;  ///< sum left of and below a place

    int columns_, rows_;
    double x_scale_, y_scale_;  ///< cells a pixel
    double cost_scale_;
    double last_width_, last_height_;  ///< of the cells at the edge, as a share of a cell
    std::vector<double> sums_;
};

}  // namespace lightwalk
