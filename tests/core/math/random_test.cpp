#include "core/math/random.h"

#include <doctest/doctest.h>

#include <cmath>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "tests/core/chi_square.h"

using namespace lightwalk;
using lightwalk::test::agrees;
using lightwalk::test::cell_masses;
using lightwalk::test::chi_square;
using lightwalk::test::count_cells;
using lightwalk::test::SquarePoint;
using lightwalk::test::UnitSquareCells;

namespace {

using Draw = std::optional<SquarePoint> (*)(std::uint64_t seed);

/// Whether places are uniform in the square over seeds, for a sample of a pixel.
void check_uniform(Draw draw) {
    const UnitSquareCells cells{16, 16};
    const auto counts =
        count_cells(cells, cell_masses(cells, [](double, double) { return 1.0; }), 40000, 5,
                    [&](RandomStream& random) {
                        return draw(static_cast<std::uint64_t>(random.next() * 0x1p53));
                    });
    CHECK(agrees(chi_square(counts)));
}

RandomStream sample_of(std::uint64_t seed, std::uint32_t sample = 3) {
    return RandomStream::of_samples(seed, 37, 12, sample, 16);
}

/// How many of 4 x 4 boxes the places of these streams lie in.
template <class Place>
std::size_t boxes(const std::vector<RandomStream>& streams, Place place) {
    std::set<std::pair<int, int>> found;
    for (RandomStream stream : streams) {
        const SequencePoint p = place(stream);
        found.emplace(static_cast<int>(4 * p.first), static_cast<int>(4 * p.second));
    }
    return found.size();
}

}  // namespace

TEST_CASE("what one stratified sample draws is uniform, and independent of what else it draws") {
    SUBCASE("a pair") {
        check_uniform([](std::uint64_t seed) -> std::optional<SquarePoint> {
            RandomStream random = sample_of(seed);
            const auto [x, y] = random.next_pair();
            return SquarePoint{x, y};
        });
    }
    SUBCASE("numbers one by one, of two pairs") {
        check_uniform([](std::uint64_t seed) -> std::optional<SquarePoint> {
            RandomStream random = sample_of(seed);
            (void)random.next();
            const double x = random.next();
            return SquarePoint{x, random.next()};
        });
    }
    SUBCASE("first numbers of two pairs") {
        check_uniform([](std::uint64_t seed) -> std::optional<SquarePoint> {
            RandomStream random = sample_of(seed);
            const double x = random.next_pair().first;
            return SquarePoint{x, random.next_pair().first};
        });
    }
    SUBCASE("a ray's and a spawned ray's") {
        check_uniform([](std::uint64_t seed) -> std::optional<SquarePoint> {
            RandomStream random = sample_of(seed);
            RandomStream child = random.child();
            const double x = random.next();
            return SquarePoint{x, child.next()};
        });
    }
    SUBCASE("two spawned rays'") {
        check_uniform([](std::uint64_t seed) -> std::optional<SquarePoint> {
            RandomStream random = sample_of(seed);
            RandomStream child = random.child(), other = random.child();
            const double x = child.next_pair().second;
            return SquarePoint{x, other.next_pair().second};
        });
    }
}

TEST_CASE("16 samples of a pixel, or 4 of each of 2 x 2 pixels, share out the boxes of a square") {
    int together = 0;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        std::vector<RandomStream> of_one, of_four;
        for (std::uint32_t i = 0; i < 16; ++i) {
            of_one.push_back(RandomStream::of_samples(seed, 7, 9, i, 16));
            of_four.push_back(RandomStream::of_samples(seed, 6 + i / 4 % 2, 8 + i / 8, i % 4, 4));
        }
        for (const std::vector<RandomStream>& streams : {of_one, of_four}) {
            CHECK(boxes(streams, [](RandomStream r) { return r.next_pair(); }) == 16);
            CHECK(boxes(streams, [](RandomStream r) {
                      (void)r.next();
                      return r.next_pair();
                  }) == 16);
            CHECK(boxes(streams, [](RandomStream r) {
                      (void)r.child();
                      return r.child().next_pair();
                  }) == 16);
            // Each pair is in an order of its own: together they are stratified by chance alone.
            together += boxes(streams,
                              [](RandomStream r) {
                                  const double x = r.next_pair().first;
                                  return SequencePoint{x, r.next_pair().first};
                              }) == 16
                            ? 1
                            : 0;
        }
    }
    CHECK(together < 10);  // of 40
}

TEST_CASE("a pair of an independent stream is what two calls give") {
    RandomStream a = RandomStream::of_pixel(1, 2, 3, 4), b = a;
    const auto [x, y] = a.next_pair();
    CHECK(x == b.next());
    CHECK(y == b.next());
    CHECK(a.next() == b.next());
}

TEST_CASE("pixels far apart, samples and seeds have numbers of their own") {
    std::set<double> found;
    for (const std::uint32_t far : {0U, 1U << 15, 1U << 16, 1U << 20}) {
        for (std::uint32_t sample = 0; sample < 3; ++sample) {
            for (std::uint64_t seed = 0; seed < 3; ++seed) {
                found.insert(RandomStream::of_samples(seed, far, 5, sample, 65536).next());
                found.insert(RandomStream::of_samples(seed, 5, far, sample, 65536).next());
            }
        }
    }
    CHECK(found.size() == 2 * 4 * 3 * 3);
}
