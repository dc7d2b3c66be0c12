#include "perf/model/cost_map.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace lightwalk {
namespace {

CellCosts read_cells(const nlohmann::json& json) {
    CellCosts cells;
    cells.width = json.at("width");
    cells.height = json.at("height");
    cells.cell = json.at("cell");
    if (cells.width < 1 || cells.height < 1 || cells.cell < 1)
        throw InputError("a cost map: its picture has no pixels");
    cells.seconds = json.at("seconds").get<std::vector<double>>();
    if (json.contains("values")) {
        cells.values = json["values"].get<std::vector<int>>();
        cells.making = json.at("making").get<std::vector<double>>();
    }
    const std::size_t count =
        static_cast<std::size_t>(cells.columns()) * static_cast<std::size_t>(cells.rows());
    if (cells.seconds.size() != count ||
        (!cells.values.empty() && (cells.values.size() != count || cells.making.size() != count)))
        throw InputError("a cost map: expected a figure for each cell of the picture");
    return cells;
}

}  // namespace

CostMap read_cost_map(const nlohmann::json& json) {
    try {
        CostMap map;
        map.picture = read_cells(json.at("picture"));
        if (json.contains("overture")) map.prepass = read_cells(json["overture"]);
        map.setup_seconds = json.at("setup_seconds");
        map.block_seconds = json.at("block_seconds");
        map.encode_seconds = json.at("encode_seconds");
        map.decode_seconds = json.at("decode_seconds");
        map.packed_bytes = json.at("packed_bytes");
        return map;
    } catch (const nlohmann::json::exception& error) {
        throw InputError(std::string("a cost map: ") + error.what());
    }
}

BlockCosts::BlockCosts(const CellCosts& cells, int width, int height)
    : columns_(cells.columns()),
      rows_(cells.rows()),
      x_scale_(static_cast<double>(cells.width) / cells.cell / width),
      y_scale_(static_cast<double>(cells.height) / cells.cell / height),
      cost_scale_(static_cast<double>(width) * height /
                  (static_cast<double>(cells.width) * cells.height)),
      last_width_(static_cast<double>(cells.width) / cells.cell - (columns_ - 1)),
      last_height_(static_cast<double>(cells.height) / cells.cell - (rows_ - 1)) {
    const auto at = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_ + 1) +
               static_cast<std::size_t>(x);
    };
    sums_.resize(static_cast<std::size_t>(columns_ + 1) * static_cast<std::size_t>(rows_ + 1));
    for (int y = 0; y < rows_; ++y) {
        for (int x = 0; x < columns_; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
                                  static_cast<std::size_t>(x);
            sums_[at(x + 1, y + 1)] =
                cells.seconds[i] + sums_[at(x, y + 1)] + sums_[at(x + 1, y)] - sums_[at(x, y)];
        }
    }
}

double BlockCosts::below(double x, double y) const {
    const int column = std::clamp(static_cast<int>(x), 0, columns_ - 1);
    const int row = std::clamp(static_cast<int>(y), 0, rows_ - 1);
    // Inside a cell its cost is spread evenly; a cell at the edge is a smaller one.
    const double u =
        std::clamp((x - column) / (column == columns_ - 1 ? last_width_ : 1), 0.0, 1.0);
    const double v = std::clamp((y - row) / (row == rows_ - 1 ? last_height_ : 1), 0.0, 1.0);
    const auto sum = [&](int a, int b) {
        return sums_[static_cast<std::size_t>(b) * static_cast<std::size_t>(columns_ + 1) +
                     static_cast<std::size_t>(a)];
    };
    return (1 - v) * ((1 - u) * sum(column, row) + u * sum(column + 1, row)) +
           v * ((1 - u) * sum(column, row + 1) + u * sum(column + 1, row + 1));
}

double BlockCosts::seconds(const PixelRectangle& block) const {
    if (block.empty()) return 0;
    const double x0 = block.x0 * x_scale_, x1 = block.x1 * x_scale_;
    const double y0 = block.y0 * y_scale_, y1 = block.y1 * y_scale_;
    return std::max(0.0,
                    cost_scale_ * (below(x1, y1) - below(x0, y1) - below(x1, y0) + below(x0, y0)));
}

}  // namespace lightwalk
