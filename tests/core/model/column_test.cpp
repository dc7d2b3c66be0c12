// Long arrays that grow without a copy of themselves.
#include "core/model/column.h"

#include <doctest/doctest.h>

#include <limits>
#include <numeric>

using namespace lightwalk;

TEST_CASE("a column grows one by one and by many, and keeps what it holds") {
    Column<int> column;
    std::vector<int> expected;
    for (int i = 0; i < 3000000; ++i) {  // past where malloc begins to map pages
        column.push_back(i);
        expected.push_back(i);
    }
    column.append(std::vector<int>{7, 8, 9});
    expected.insert(expected.end(), {7, 8, 9});
    CHECK(std::vector<int>(column.begin(), column.end()) == expected);
    CHECK(column.own_bytes() >= column.size() * sizeof(int));
    column.trim();
    CHECK(column.own_bytes() == column.size() * sizeof(int));
    column.push_back(column[5]);
    CHECK(column.back() == 5);
    CHECK(std::vector<int>(column.begin(), column.end() - 1) == expected);
}

TEST_CASE("a column that is moved from is empty, and can be used") {
    Column<int> one(std::vector<int>{1, 2, 3});
    Column<int> other(std::move(one));
    CHECK(other.size() == 3);
    CHECK(one.empty());  // NOLINT: that is what is asked
    CHECK(one.own_bytes() == 0);
    one.push_back(4);
    other = std::move(one);
    CHECK(other.size() == 1);
    CHECK(other[0] == 4);
}

TEST_CASE("values to be filled in are zero at first, and none need no memory") {
    Column<double> column;
    const std::span<double> values = column.zeros(1000);
    CHECK(std::accumulate(values.begin(), values.end(), 0.0) == 0);
    values[3] = 5;
    CHECK(column[3] == 5);
    CHECK(column.zeros(0).empty());
    CHECK(column.empty());
    CHECK(column.own_bytes() == 0);
    column.trim();
    CHECK(column.empty());
}

TEST_CASE("room that is taken in advance is room for as many, and gone once trimmed") {
    Column<int> column;
    column.reserve(100);
    CHECK(column.empty());
    CHECK(column.own_bytes() == 100 * sizeof(int));
    column.reserve(50);
    column.push_back(0);
    const int* const first = column.data();
    for (int i = 1; i < 100; ++i) column.push_back(i);
    CHECK(column.data() == first);
    CHECK(column.own_bytes() == 100 * sizeof(int));
    column.reserve(200);
    column.trim();
    CHECK(column.own_bytes() == 100 * sizeof(int));
    CHECK(column.back() == 99);
}

TEST_CASE("mapped values are shown, and weigh nothing") {
    const std::vector<int> elsewhere{1, 2, 3};
    Column<int> column = Column<int>::mapped(elsewhere);
    column.trim();
    CHECK(column.is_mapped());
    CHECK(column.data() == elsewhere.data());
    CHECK(column.own_bytes() == 0);
    CHECK(column.mapped_bytes() == 3 * sizeof(int));
}

TEST_CASE("more than fits into memory is refused as such") {
    Column<double> column;
    CHECK_THROWS_AS(column.zeros(std::numeric_limits<std::size_t>::max() / 4), std::bad_alloc);
    CHECK(column.empty());
}
