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

std::vector<Block> squares(const PixelRectangle& area, int side) {
    std::vector<Block> blocks;
    if (area.empty()) return blocks;
    for (int y = area.y0 / side * side; y < area.y1; y += side) {
        for (int x = area.x0 / side * side; x < area.x1; x += side)
            blocks.push_back(intersection({x, y, x + side, y + side}, area));
    }
    return blocks;
}

std::vector<Block> make_blocks(const PixelRectangle& area, int side) {
    const std::vector<Block> in_rows = squares(area, side);
    const std::size_t count = in_rows.size();
    // Multiples of the golden ratio spread evenly (Knuth, TAOCP vol. 3, section 6.4).
    std::size_t stride = std::max<std::size_t>(
        1, static_cast<std::size_t>(0.6180339887 * static_cast<double>(count)));
    while (std::gcd(stride, count) > 1) ++stride;
    std::vector<Block> blocks;
    blocks.reserve(count);
    for (std::size_t i = 0, at = 0; i < count; ++i, at = (at + stride) % count)
        blocks.push_back(in_rows[at]);
    return blocks;
}

std::vector<Block> quarters(const Block& block, int alignment) {
    const int side = std::max(block.width(), block.height());
    const int half = ((side + 1) / 2 + alignment - 1) / alignment * alignment;
    std::vector<Block> parts;
    for (int y = block.y0 / alignment * alignment; y < block.y1; y += half) {
        for (int x = block.x0 / alignment * alignment; x < block.x1; x += half) {
            const Block part = intersection({x, y, x + half, y + half}, block);
            if (!part.empty()) parts.push_back(part);
        }
    }
    return parts;
}

std::vector<Block> blocks_left(const std::vector<Block>& blocks,
                               const std::vector<PixelRectangle>& known, int alignment) {
    const auto known_pixels = [&](const Block& block) {
        std::size_t pixels = 0;
        for (const PixelRectangle& r : known) pixels += intersection(r, block).pixels();
        return pixels;
    };
    std::vector<Block> left;
    const auto sort = [&](const auto& self, const Block& block) -> void {
        const std::size_t pixels = known_pixels(block);
        if (pixels == block.pixels()) return;
        const std::vector<Block> parts = quarters(block, alignment);
        if (pixels == 0 || parts.size() < 2) {
            left.push_back(block);
        } else {
            for (const Block& part : parts) self(self, part);
        }
    };
    for (const Block& block : blocks) sort(sort, block);
    return left;
}

}  // namespace lightwalk
