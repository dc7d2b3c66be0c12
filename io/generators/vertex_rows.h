#pragma once
// The points of a surface grid as text, each converted once for the four cells around it.
#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "io/generators/surface_grid.h"

namespace lightwalk {

/// A cache of two rows of points, for writing cells row by row.
class VertexRows {
  public:
    explicit VertexRows(const SurfaceGrid& grid) : grid_(grid) {}

    /// Point (i, j) in the form of a polygon's vertex. The view is valid until row i + 2 or i - 2
    /// is asked for.
    [[nodiscard]] std::string_view text(std::size_t i, std::size_t j) {
        Row& row = rows_[i % rows_.size()];
        if (row.i != i) write(i, row);
        return std::string_view(row.text).substr(row.begin[j], row.begin[j + 1] - row.begin[j]);
    }

  private:
    struct Row {
        std::size_t i = std::numeric_limits<std::size_t>::max();  ///< none yet
        std::string text;
        std::vector<std::size_t> begin;  ///< offsets of the points' texts, and the last's end
    };
    void write(std::size_t i, Row& row) const;

    const SurfaceGrid& grid_;
    std::array<Row, 2> rows_;
};

}  // namespace lightwalk
