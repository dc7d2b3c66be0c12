#include "parallel/ranks/topology.h"

#include "parallel/sub_images.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "core/error.h"

using namespace lightwalk;

TEST_CASE("the parts of a picture cover it once, whatever their number") {
    for (const PixelRectangle area :
         {PixelRectangle{0, 0, 64, 48}, {3, 5, 10, 6}, {0, 0, 1, 1}, {2, 2, 2, 9}}) {
        for (const std::size_t count : {1U, 2U, 3U, 7U, 16U, 61U}) {
            CAPTURE(count);
            const SubImages parts(area, count);
            REQUIRE(parts.size() == count);
            std::size_t pixels = 0;
            for (std::size_t i = 0; i < count; ++i) {
                const PixelRectangle part = parts[i];
                pixels += part.pixels();
                if (part.empty()) continue;
                CHECK(part.x0 >= area.x0);
                CHECK(part.y0 >= area.y0);
                CHECK(part.x1 <= area.x1);
                CHECK(part.y1 <= area.y1);
                for (std::size_t j = 0; j < i; ++j) {
                    const PixelRectangle other = parts[j];
                    const bool apart = part.x1 <= other.x0 || other.x1 <= part.x0 ||
                                       part.y1 <= other.y0 || other.y1 <= part.y0;
                    CHECK((apart || other.empty()));
                }
            }
            CHECK(pixels == area.pixels());
        }
    }
}

TEST_CASE("parts of a picture are about equal") {
    for (const std::size_t count : {2U, 3U, 4U, 7U, 32U, 63U}) {
        const SubImages parts({0, 0, 640, 480}, count);
        const double fair = 640.0 * 480 / static_cast<double>(count);
        for (std::size_t i = 0; i < count; ++i) {
            const PixelRectangle part = parts[i];
            CHECK(static_cast<double>(part.pixels()) > .85 * fair);  // edges fall on whole pixels
            CHECK(static_cast<double>(part.pixels()) < 1.15 * fair);
        }
    }
}

TEST_CASE("the owners of a block are all whose parts it touches, and no others") {
    for (const PixelRectangle area :
         {PixelRectangle{0, 0, 64, 48}, {3, 5, 10, 6}, {0, 0, 1, 1}, {2, 2, 2, 9}}) {
        for (const std::size_t count : {1U, 2U, 3U, 7U, 16U, 61U, 1000U}) {
            const SubImages parts(area, count);
            for (const int side : {1, 5, 16, 100}) {
                for (int y = area.y0; y < area.y1; y += side) {
                    for (int x = area.x0; x < area.x1; x += side) {
                        const PixelRectangle block{x, y, std::min(x + side, area.x1),
                                                   std::min(y + side, area.y1)};
                        std::vector<std::size_t> expected;
                        for (std::size_t i = 0; i < count; ++i) {
                            const PixelRectangle part = parts[i];
                            if (!part.empty() && part.x0 < block.x1 && block.x0 < part.x1 &&
                                part.y0 < block.y1 && block.y0 < part.y1)
                                expected.push_back(i);
                        }
                        REQUIRE(parts.overlapping(block) == expected);
                    }
                }
            }
        }
    }
}

TEST_CASE("roles of each variant") {
    const Topology ranks = make_topology(Variant::ranks, 5, true, 1);
    CHECK_FALSE(ranks.traces(0));
    CHECK_FALSE(ranks.traces(1));
    CHECK(ranks.ambient_master == 1);
    CHECK(ranks.workers.size() == 3);
    CHECK(ranks.worker_index(4) == 2);
    const Topology direct = make_topology(Variant::ranks, 3, false, 0);
    CHECK(direct.workers.size() == 2);
    CHECK_FALSE(direct.ambient_master.has_value());
    const Topology hybrid = make_topology(Variant::hybrid, 4, true, 0);
    CHECK(hybrid.traces(0));
    CHECK(hybrid.workers.size() == 4);
    CHECK(hybrid.ambient_master == 0);
    CHECK(make_topology(Variant::hybrid, 1, true, 0).workers.size() == 1);
    CHECK_THROWS_WITH_AS((void)make_topology(Variant::ranks, 2, true, 1),
                         doctest::Contains("at least 3 ranks"), InputError);
}

TEST_CASE("every worker has one queue, and every queue is another's child") {
    for (const Variant variant : {Variant::ranks, Variant::hybrid}) {
        for (const int masters : {1, 2, 3, 5}) {
            for (const int ranks : {12, 13, 40}) {
                CAPTURE(ranks);
                CAPTURE(masters);
                const Topology topology = make_topology(variant, ranks, true, masters);
                CHECK(topology.sub_queues.size() == static_cast<std::size_t>(masters - 1));
                std::multiset<int> fed(topology.children.begin(), topology.children.end());
                for (const Topology::SubQueue& sub : topology.sub_queues) {
                    const auto child = fed.find(sub.rank);
                    REQUIRE(child != fed.end());
                    fed.erase(child);  // it is no worker of rank 0
                    CHECK(sub.rank != 0);
                    CHECK_FALSE(sub.children.empty());
                    CHECK_FALSE(topology.below_sub_queue(sub.rank));
                }
                for (const Topology::SubQueue& sub : topology.sub_queues) {
                    for (const int rank : sub.children) {
                        fed.insert(rank);
                        CHECK(topology.workers[*topology.worker_index(rank)].queue == sub.rank);
                        CHECK(topology.below_sub_queue(rank) == (rank != sub.rank));
                    }
                }
                CHECK_FALSE(topology.below_sub_queue(0));
                CHECK(fed.size() == topology.workers.size());
                for (const Topology::Worker& worker : topology.workers)
                    CHECK(fed.count(worker.rank) == 1);
            }
        }
    }
}
