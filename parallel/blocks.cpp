#include "parallel/blocks.h"

#include <algorithm>
#include <numeric>

namespace lightwalk {

int block_side(int width, int height, int workers, int alignment) {
    constexpr double kBlocksPerWorker = 32;
    constexpr int kLargest = 64;
    const double pixels = static_cast<double>(width) * height;
    int side = alignment;
    while (side + alignment <= kLargest) {
        const double next = side + alignment;
        if (pixels / (next * next) < kBlocksPerWorker * workers) break;
        side += alignment;
    }
    return side;
}

std::vector<Block> make_blocks(const PixelRectangle& area, int side) {
    if (area.empty()) return {};
    const int left = area.x0 / side, bottom = area.y0 / side;
    const int right = (area.x1 - 1) / side, top = (area.y1 - 1) / side;
    const std::size_t columns = static_cast<std::size_t>(right - left) + 1;
    const std::size_t rows = static_cast<std::size_t>(top - bottom) + 1;
    const std::size_t count = columns * rows;
    // Multiples of the golden ratio spread evenly (Knuth, TAOCP vol. 3, section 6.4).
    std::size_t stride = std::max<std::size_t>(
        1, static_cast<std::size_t>(0.6180339887 * static_cast<double>(count)));
    while (std::gcd(stride, count) != 1) ++stride;
    std::vector<Block> blocks;
    blocks.reserve(count);
    std::size_t at = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const int x = (left + static_cast<int>(at % columns)) * side;
        const int y = (bottom + static_cast<int>(at / columns)) * side;
        blocks.push_back({std::max(x, area.x0), std::max(y, area.y0), std::min(x + side, area.x1),
                          std::min(y + side, area.y1)});
        at = (at + stride) % count;
    }
    return blocks;
}

}  // namespace lightwalk
