#include "parallel/shared_blocks.h"

#include <doctest/doctest.h>

#include <random>
#include <set>
#include <utility>
#include <vector>

using namespace lightwalk;

namespace {

std::pair<int, int> pair_of(const PixelPlace& place) {
    return {place.x, place.y};
}

const std::vector<Block> kTwo{{0, 0, 2, 2}, {4, 0, 6, 2}};

}  // namespace

TEST_CASE("one worker gets the pixels of blocks in the order in which packets are traced") {
    const std::vector<Block> blocks{{4, 0, 8, 3}, {0, 0, 2, 1}};
    SharedBlocks shared(blocks, 2, 1);
    const std::vector<std::pair<int, int>> expected{{4, 1}, {5, 1}, {4, 0}, {5, 0}, {6, 1},
                                                    {7, 1}, {6, 0}, {7, 0}, {4, 2}, {5, 2},
                                                    {6, 2}, {7, 2}, {0, 0}, {1, 0}};
    REQUIRE(shared.pixels() == expected.size());
    for (const auto& place : expected) CHECK(pair_of(shared.next(0)) == place);
}

TEST_CASE("a worker that has no block left helps from the end of another's") {
    SharedBlocks shared(kTwo, 2, 2);
    CHECK(pair_of(shared.next(0)) == std::pair(0, 1));
    CHECK(pair_of(shared.next(1)) == std::pair(4, 1));
    CHECK(pair_of(shared.next(1)) == std::pair(5, 1));
    CHECK(pair_of(shared.next(1)) == std::pair(4, 0));
    CHECK(pair_of(shared.next(1)) == std::pair(5, 0));
    CHECK(pair_of(shared.next(1)) == std::pair(1, 0));
    CHECK(pair_of(shared.next(0)) == std::pair(1, 1));
    CHECK(pair_of(shared.next(1)) == std::pair(0, 0));
}

TEST_CASE("more workers than blocks get each pixel once, in any order of their calls") {
    std::mt19937 random(1);
    for (int run = 0; run < 100; ++run) {
        const std::vector<Block> blocks = make_blocks({0, 0, 21, 13}, 8);
        SharedBlocks shared(blocks, 8, 8);
        std::set<std::pair<int, int>> seen;
        for (std::size_t i = 0; i < shared.pixels(); ++i)
            seen.insert(pair_of(shared.next(static_cast<int>(random() % 8))));
        CHECK(seen.size() == 21 * 13);
    }
}
