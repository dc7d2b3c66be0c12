#include "parallel/round_bytes.h"

#include <doctest/doctest.h>

#include "core/error.h"

using namespace lightwalk;

namespace {

AmbientPoint some_point() {
    AmbientPoint point;
    point.query = {{1, 2, 3}, {0, 0, 1}, {0, 0.6, 0.8}, 2, 0.25};
    point.medium.extinction = {0.1f, 0.2f, 0.3f};
    point.distance = 4;
    point.path_length = 5;
    point.limit = 60;
    point.ray_level = 1;
    point.target = 7;
    point.history = kAmbientSame | kPrimary;
    point.far_side = true;
    return point;
}

}  // namespace

TEST_CASE("points and values of a round come back from their bytes as they were") {
    AmbientRecord record;
    record.position = {1, 2, 3};
    record.value = {4, 5, 6};
    record.level = 2;
    const std::vector<RoundValue> values{{}, {{{some_point(), record}}, {record}}};
    const std::string bytes = encode_values(values);
    const std::vector<RoundValue> back = decode_values(bytes);
    REQUIRE(back.size() == 2);
    CHECK(back[0].record.empty());
    REQUIRE(back[1].new_records.size() == 1);
    CHECK(hash_of(back[1].new_records[0].point) == hash_of(some_point()));
    CHECK(back[1].record.at(0).value == record.value);
    CHECK(encode_values(back) == bytes);

    std::vector<AmbientPoint> points;
    decode_points(encode_points({some_point()}), points);
    decode_points(encode_points({some_point()}), points);  // appends
    REQUIRE(points.size() == 2);
    CHECK(encode_points({points[1]}) == encode_points({some_point()}));
}

TEST_CASE("bytes that are no points or values of a round are refused") {
    const std::string points = encode_points({some_point()}),
                      values = encode_values({{{{some_point(), {}}}, {AmbientRecord()}}});
    std::vector<AmbientPoint> taken;
    for (std::size_t size = 0; size < points.size(); ++size)
        CHECK_THROWS_AS(decode_points(points.substr(0, size), taken), InputError);
    CHECK_THROWS_AS(decode_points(points + 'x', taken), InputError);
    for (std::size_t size = 0; size < values.size(); ++size)
        CHECK_THROWS_AS((void)decode_values(values.substr(0, size)), InputError);
    CHECK_THROWS_AS((void)decode_values(std::string(8, '\xff')), InputError);
}

TEST_CASE("a point's hash depends on all that it holds") {
    const std::uint64_t hash = hash_of(some_point());
    CHECK(hash == hash_of(some_point()));
    AmbientPoint other = some_point();
    other.path_length = 6;
    CHECK(hash_of(other) != hash);
    other = some_point();
    other.far_side = false;
    CHECK(hash_of(other) != hash);
    other = some_point();
    other.query.position.z = 3.0000001;
    CHECK(hash_of(other) != hash);
}
