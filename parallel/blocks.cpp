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

std::vector<Block> quarters(const Block& block, int alignment) {
    const int side = std::max(block.width(), block.height());
    const int half = ((side + 1) / 2 + alignment - 1) / alignment * alignment;
    std::vector<Block> parts;
    for (int y = block.y0 / alignment * alignment; y < block.y1; y += half) {
        for (int x = block.x0 / alignment * alignment; x < block.x1; x += half) {
            const Block part{std::max(x, block.x0), std::max(y, block.y0),
                             std::min(x + half, block.x1), std::min(y + half, block.y1)};
            if (!part.empty()) parts.push_back(part);
        }
    }
    return parts;
}

BlocksLeft blocks_left(const std::vector<Block>& blocks, const std::vector<PixelRectangle>& known,
                       int alignment) {
    const auto known_pixels = [&](const Block& block) {
        std::size_t pixels = 0;
        for (const PixelRectangle& r : known) {
            pixels += PixelRectangle{std::max(r.x0, block.x0), std::max(r.y0, block.y0),
                                     std::min(r.x1, block.x1), std::min(r.y1, block.y1)}
                          .pixels();
        }
        return pixels;
    };
    BlocksLeft result;
    const auto sort = [&](const auto& self, const Block& block) -> void {
        const std::size_t pixels = known_pixels(block);
        const std::vector<Block> parts = quarters(block, alignment);
        if (pixels == block.pixels()) {
            result.known.push_back(block);
        } else if (pixels == 0 || parts.size() < 2) {
            result.left.push_back(block);
        } else {
            for (const Block& part : parts) self(self, part);
        }
    };
    for (const Block& block : blocks) sort(sort, block);
    return result;
}

}  // namespace lightwalk
