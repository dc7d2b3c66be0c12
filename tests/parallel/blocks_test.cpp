#include "parallel/blocks.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace lightwalk;

namespace {

struct Size {
    int width, height;
};

}  // namespace

TEST_CASE("blocks cover every pixel of a picture exactly once") {
    for (const Size& size : {Size{1, 1}, Size{64, 48}, Size{65, 47}, Size{7, 100}}) {
        for (const int side : {1, 8, 30}) {
            CAPTURE(size.width);
            CAPTURE(side);
            std::vector<int> covered(static_cast<std::size_t>(size.width * size.height));
            for (const Block& block : make_blocks({0, 0, size.width, size.height}, side)) {
                CHECK(block.x0 % side == 0);
                CHECK(block.y0 % side == 0);
                for (int y = block.y0; y < block.y1; ++y) {
                    for (int x = block.x0; x < block.x1; ++x)
                        ++covered[static_cast<std::size_t>(y * size.width + x)];
                }
            }
            CHECK(std::all_of(covered.begin(), covered.end(), [](int n) { return n == 1; }));
        }
    }
    CHECK(make_blocks({0, 0, 0, 10}, 8).empty());
}

TEST_CASE("early blocks are spread over the picture: any tenth of them touches all four quarters") {
    const int side = 16;
    const int size = 640;
    const std::vector<Block> blocks = make_blocks({0, 0, size, size}, side);
    const std::size_t tenth = blocks.size() / 10;
    for (std::size_t first = 0; first + tenth <= blocks.size(); first += tenth) {
        std::vector<int> quarters(4);
        for (std::size_t i = first; i < first + tenth; ++i) {
            ++quarters[static_cast<std::size_t>((blocks[i].x0 >= size / 2 ? 1 : 0) +
                                                (blocks[i].y0 >= size / 2 ? 2 : 0))];
        }
        CHECK(*std::min_element(quarters.begin(), quarters.end()) > 0);
    }
}

TEST_CASE("consecutive blocks lie apart") {
    const int side = 16;
    const std::vector<Block> blocks = make_blocks({0, 0, 640, 480}, side);
    for (std::size_t i = 1; i < blocks.size(); ++i) {
        const int dx = std::abs(blocks[i].x0 - blocks[i - 1].x0);
        const int dy = std::abs(blocks[i].y0 - blocks[i - 1].y0);
        CHECK(std::max(dx, dy) > 2 * side);
    }
}

TEST_CASE("blocks are aligned, at most 64 pixels wide, and enough for all workers") {
    for (const int workers : {1, 2, 16, 64}) {
        for (const int alignment : {8, 30, 32}) {
            const int side = block_side(640, 480, workers, alignment);
            CAPTURE(workers);
            CAPTURE(alignment);
            CHECK(side % alignment == 0);
            CHECK(side <= 64);
            const double blocks = 640.0 * 480.0 / (side * side);
            CHECK((side == alignment || blocks >= 32.0 * workers));
        }
    }
    CHECK(block_side(640, 480, 1, 8) > block_side(640, 480, 64, 8));
    CHECK(block_side(10, 10, 4, 100) == 100);
}

TEST_CASE("quarters cover a block once, with corners at multiples of the alignment") {
    for (const Block block :
         {Block{0, 0, 64, 64}, {64, 0, 70, 64}, {3, 5, 11, 6}, {8, 8, 12, 12}}) {
        for (const int alignment : {1, 4, 6}) {
            CAPTURE(alignment);
            std::size_t pixels = 0;
            for (const Block& part : quarters(block, alignment)) {
                pixels += part.pixels();
                CHECK((part.x0 % alignment == 0 || part.x0 == block.x0));
                CHECK((part.y0 % alignment == 0 || part.y0 == block.y0));
            }
            CHECK(pixels == block.pixels());
            CHECK(quarters(block, alignment).size() <= 9);
        }
    }
    CHECK(quarters({0, 0, 64, 64}, 1).size() == 4);
}

TEST_CASE("what is left of blocks: the known pixels are not among it, every other is") {
    const PixelRectangle area{0, 0, 50, 40};
    const std::vector<PixelRectangle> known{{0, 0, 16, 16}, {20, 20, 24, 28}, {49, 0, 50, 40}};
    const std::vector<Block> blocks = make_blocks(area, 16);
    std::vector<int> times(area.pixels());
    for (const Block& block : blocks_left(blocks, known, 1)) {
        for (int y = block.y0; y < block.y1; ++y)
            for (int x = block.x0; x < block.x1; ++x) ++times[area.index({x, y})];
    }
    for (int y = 0; y < area.y1; ++y) {
        for (int x = 0; x < area.x1; ++x) {
            bool is_known = false;
            for (const PixelRectangle& r : known) is_known = is_known || r.contains({x, y});
            CHECK(times[area.index({x, y})] == (is_known ? 0 : 1));
        }
    }
    // Blocks that cannot be cut so finely are traced again.
    CHECK(blocks_left({{0, 0, 8, 8}}, {{0, 0, 2, 2}}, 8) == std::vector<Block>{{0, 0, 8, 8}});
    CHECK(blocks_left(blocks, {area}, 1).empty());
    CHECK(blocks_left(blocks, {}, 1) == blocks);
}
