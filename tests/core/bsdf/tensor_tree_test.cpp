#include "core/bsdf/tensor_tree.h"

#include <doctest/doctest.h>

#include <vector>

#include "core/bsdf/disk_square.h"
#include "core/math/random.h"

using namespace lightwalk;

namespace {

float value_at(const TensorTree& tree, const std::vector<double>& point) {
    std::vector<HalvingPath> path;
    for (const double x : point) path.emplace_back(x);
    return find_leaf(tree, path).value;
}

}  // namespace

TEST_CASE("the map of disk and square goes both ways, and keeps areas") {
    RandomStream random(5);
    int inside = 0;
    constexpr int kPoints = 100000;
    for (int i = 0; i < kPoints; ++i) {
        const UnitSquarePoint square{random.next(), random.next()};
        const ProjectedDirection disk = square_to_disk(square);
        CHECK(disk.x * disk.x + disk.y * disk.y <= 1 + 1e-12);
        const UnitSquarePoint back = disk_to_square(disk);
        CHECK(back.x == doctest::Approx(square.x).epsilon(1e-9));
        CHECK(back.y == doctest::Approx(square.y).epsilon(1e-9));
        // A disk of any radius and place has its area over π of the square's points.
        const double x = disk.x - 0.3, y = disk.y + 0.2;
        inside += x * x + y * y < 0.25 ? 1 : 0;
    }
    const double expected = 0.25 * kPoints;
    CHECK(std::abs(inside - expected) < 5 * std::sqrt(expected));
    CHECK(disk_to_square({0, 0}).x == 0.5);
    CHECK(disk_to_square({1, 0}).x == 1);
    CHECK(disk_to_square({0, -1}).y == 0);
}

TEST_CASE("tensor trees: in a grid the last dimension runs fastest") {
    TensorTree tree(3);
    std::vector<float> values(64);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
    tree.set_root(tree.add_grid(values, 2));
    REQUIRE(tree.sound());
    for (std::size_t x = 0; x < 4; ++x) {
        for (std::size_t y = 0; y < 4; ++y) {
            for (std::size_t z = 0; z < 4; ++z) {
                const auto middle = [](std::size_t i) {
                    return (static_cast<double>(i) + 0.5) / 4;
                };
                CHECK(value_at(tree, {middle(x), middle(y), middle(z)}) ==
                      static_cast<float>(16 * x + 4 * y + z));
            }
        }
    }
}

TEST_CASE("tensor trees: bit i of a child's number is the upper half of dimension i") {
    TensorTree tree(4);
    std::vector<TensorTree::Entry> children;
    for (int c = 0; c < 16; ++c) children.push_back(TensorTree::leaf(static_cast<float>(c)));
    tree.set_root(tree.add(children));
    REQUIRE(tree.sound());
    CHECK(value_at(tree, {0.9, 0.1, 0.1, 0.1}) == 1);
    CHECK(value_at(tree, {0.1, 0.9, 0.1, 0.1}) == 2);
    CHECK(value_at(tree, {0.1, 0.1, 0.9, 0.1}) == 4);
    CHECK(value_at(tree, {0.1, 0.1, 0.1, 1.0}) == 8);
    CHECK(value_at(tree, {1.0, 0.5, 0.5, 0.5}) == 15);
    CHECK(value_at(tree, {-1.0, 0.4999, 0.0, 0.2}) == 0);
}

TEST_CASE("tensor trees: negative values count as 0, and a node costs four bytes a child") {
    CHECK(TensorTree::value(TensorTree::leaf(-2)) == 0);
    TensorTree tree(4);
    const std::vector<float> values(65536, 0.25f);  // 16 cells a side
    tree.set_root(tree.add_grid(values, 4));
    CHECK(tree.nodes().size() < values.size() * 16 / 15 + 16);
}

TEST_CASE("tensor trees: what is no tree is not sound") {
    const TensorTree::Entry one = TensorTree::leaf(1), node = 0x80000000U;
    CHECK(TensorTree(3, {}, one).sound());
    CHECK(TensorTree(3, std::vector<TensorTree::Entry>(8, one), node).sound());
    CHECK_FALSE(TensorTree(3, std::vector<TensorTree::Entry>(8, one), one).sound());  // a lost node
    CHECK_FALSE(TensorTree(3, std::vector<TensorTree::Entry>(8, node), node).sound());
    CHECK_FALSE(TensorTree(3, std::vector<TensorTree::Entry>(7, one), node).sound());
    CHECK_FALSE(TensorTree(3, {}, node).sound());
    CHECK_FALSE(TensorTree(3, {}, 0x7fc00000U).sound());  // NaN
    CHECK_FALSE(TensorTree(5, {}, one).sound());
}
