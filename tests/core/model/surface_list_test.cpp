// Surfaces in columns: they come out as they went in, and nothing else is taken from a file.
#include "core/model/surface_list.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "core/model/primitive.h"
#include "tests/all_primitives.h"

using namespace lightwalk;

namespace {

Primitive make_surface(PrimitiveType type, const std::string& name, std::vector<double> reals,
                       std::vector<std::string> strings = {}, const char* file = "a.rad",
                       int line = 1) {
    return {type, kVoidIndex, name, std::move(strings), std::move(reals), {}, {file, line}};
}

std::vector<Primitive> samples() {
    return {make_surface(PrimitiveType::sphere, "ball", {1, 2, 3, 4}, {}, "a.rad", 5),
            make_surface(PrimitiveType::instance, "tree", {}, {"tree.oct", "-t", "1", "", "3"},
                         "b.rad", 7),
            make_surface(PrimitiveType::polygon, "", {}, {}, "b.rad", 8),
            make_surface(PrimitiveType::mesh, "m", {2}, {"m.rtm"}, "a.rad", 9),
            make_surface(PrimitiveType::polygon, "p", {0, 0, 0, 1, 0, 0, 0, 1, 0})};
}

SurfaceList list_of(const std::vector<Primitive>& primitives) {
    SurfaceList list;
    for (const Primitive& primitive : primitives) list.add(primitive);
    return list;
}

/// The columns of a list, to be changed and stored again.
struct Stored {
    explicit Stored(const SurfaceList& list)
        : records(list.columns().records.begin(), list.columns().records.end()),
          reals(list.columns().reals.begin(), list.columns().reals.end()),
          corners(list.columns().corners.begin(), list.columns().corners.end()),
          text(list.columns().text.begin(), list.columns().text.end()),
          strings(list.columns().strings.begin(), list.columns().strings.end()),
          files(list.columns().files) {}
    [[nodiscard]] SurfaceList list(std::size_t modifiers = 0) const {
        return SurfaceList({Column<SurfaceRecord>::mapped(records), Column<double>::mapped(reals),
                            Column<std::uint32_t>::mapped(corners), Column<char>::mapped(text),
                            Column<SurfaceStrings>::mapped(strings), files},
                           modifiers);
    }
    std::vector<SurfaceRecord> records;
    std::vector<double> reals;
    std::vector<std::uint32_t> corners;
    std::vector<char> text;
    std::vector<SurfaceStrings> strings;
    std::vector<FileName> files;
};

/// A wave of side x side cells, each two triangles; and a ball after every thousandth.
std::vector<Primitive> wave(int side) {
    std::vector<Primitive> all;
    const auto point = [&](int i, int j) {
        return std::array{0.1 * i, -0.1 * j, std::sin(0.3 * i) * std::cos(0.2 * j)};
    };
    for (int i = 0; i < side; ++i) {
        for (int j = 0; j < 2 * side; ++j) {
            const int k = j / 2;
            std::vector<double> reals;
            for (const auto& p : {point(i, k), j % 2 == 0 ? point(i + 1, k) : point(i + 1, k + 1),
                                  j % 2 == 0 ? point(i + 1, k + 1) : point(i, k + 1)})
                reals.insert(reals.end(), p.begin(), p.end());
            all.push_back(make_surface(PrimitiveType::polygon, "wave.1.2", reals));
            if (all.size() % 1000 == 0) all.push_back(samples()[0]);
        }
    }
    return all;
}

void check_same(const SurfaceList& list, const std::vector<Primitive>& expected) {
    REQUIRE(list.size() == expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        CAPTURE(i);
        const Primitive found = to_primitive(list[i]);
        CHECK(found.type == expected[i].type);
        CHECK(found.modifier == expected[i].modifier);
        CHECK(found.name == expected[i].name);
        CHECK(found.strings == expected[i].strings);
        CHECK(found.reals == expected[i].reals);
        CHECK(found.where.file == expected[i].where.file);
        CHECK(found.where.line == expected[i].where.line);
        CHECK(list.type(i) == expected[i].type);
    }
}

}  // namespace

TEST_CASE("surfaces come out of a list as they went in") {
    const SurfaceList list = list_of(samples());
    check_same(list, samples());
    CHECK(list[1].strings[3].empty());
    CHECK(list[1].strings[4] == "3");
    CHECK(list.own_bytes() > 0);
}

TEST_CASE("a polygon of four vertices weighs what its numbers weigh, and some thirty bytes") {
    SurfaceList list;
    const Primitive quad =
        make_surface(PrimitiveType::polygon, "q.100.100", {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
    for (int i = 0; i < 10000; ++i) list.add(quad);
    list.trim();
    CHECK(list.own_bytes() <= std::size_t{10000} * (12 * sizeof(double) + 20 + 10) * 9 / 8 + 100);
}

TEST_CASE("triangles of a surface keep each of its corners about once") {
    const std::vector<Primitive> all = wave(150);  // 45,000 triangles, 22,801 corners
    SurfaceList list = list_of(all);
    list.trim();
    check_same(list, all);
    CHECK(list.shares_corners(1));
    CHECK(list.columns().reals.size() < std::size_t{3} * 22801 * 11 / 10);
    CHECK(list.own_bytes() < all.size() * (sizeof(SurfaceRecord) + 12 + 14 + 10));
    const Stored stored(list);
    const SurfaceList again = stored.list();
    check_same(again, all);
}

TEST_CASE("corners are the same where all their bits are, and may be the same in one triangle") {
    const std::vector<Primitive> all{
        make_surface(PrimitiveType::polygon, "a", {0, 0, 0, 1, 0, 0, 0, 1, 0}),
        make_surface(PrimitiveType::polygon, "b", {-0.0, 0, 0, 1, 0, 0, 0, 1, 0}),
        make_surface(PrimitiveType::polygon, "c", {5, 6, 7, 5, 6, 7, 5, 6, 7}),
        make_surface(PrimitiveType::polygon, "d", {5, 6, 7, 5, 6, 7, 1, 0, 0}),
        make_surface(PrimitiveType::cylinder, "e", {0, 0, 0, 1, 0, 0, 2}),
        make_surface(PrimitiveType::polygon, "f", {1, 0, 0, 9, 9, 9, 8, 8, 8})};
    const SurfaceList list = list_of(all);
    check_same(list, all);
    CHECK(std::signbit(list[1].reals[0]));
    CHECK_FALSE(std::signbit(list[0].reals[0]));
    CHECK_FALSE(list.shares_corners(2));
    CHECK(list.shares_corners(5));
}

TEST_CASE("stored columns give the same list, without memory of its own") {
    const Stored stored(list_of(samples()));
    const SurfaceList list = stored.list();
    check_same(list, samples());
    CHECK(list.own_bytes() <= stored.files.capacity() * sizeof(FileName));
}

TEST_CASE("columns that no list has stored are refused") {
    const Stored good(list_of(samples()));
    const auto refuses = [&](auto change) {
        Stored bad = good;
        change(bad);
        CHECK_THROWS_WITH_AS(static_cast<void>(bad.list()), doctest::Contains("damaged surfaces"),
                             InputError);
    };
    refuses([](Stored& s) { s.records[0].modifier = 0; });
    refuses([](Stored& s) { s.records[0].modifier = -2; });
    refuses([](Stored& s) { s.records[1].name = 1000; });
    refuses([](Stored& s) { s.records[1].first_real = 5000; });
    refuses([](Stored& s) { s.records[1].first_real = 0, s.records[0].first_real = 3; });
    refuses([](Stored& s) { s.records[2].file_and_type = 0xff000000; });
    refuses([](Stored& s) {
        s.records[2].file_and_type = static_cast<std::uint32_t>(PrimitiveType::plastic) << 24U;
    });
    refuses([](Stored& s) { s.records[2].file_and_type |= 0xffff; });
    refuses([](Stored& s) { s.text.back() = 'x'; });
    refuses([](Stored& s) { s.strings[0].surface = 77; });
    refuses([](Stored& s) { s.strings[1].surface = s.strings[0].surface; });
    refuses([](Stored& s) { s.strings[1].text = 0; });
    refuses([](Stored& s) { s.strings[0].count = 4'000'000'000; });
    CHECK_NOTHROW(static_cast<void>(good.list()));
    refuses([](Stored& s) { s.records[4].corners = 0; });  // there are none
    refuses([](Stored& s) { s.corners = {0, 3, 12}, s.records[4].corners = 0; });
    refuses([](Stored& s) { s.corners = {0, 3, 6}, s.records[4].corners = 1; });
    refuses([](Stored& s) { s.corners = {0, 3, 6}, s.records[0].corners = 0; });  // a sphere
}
