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
    const std::vector<RoundValue> values{{}, {{{some_point(), record}}, record}};
    const std::string bytes = wire::encode(values);
    const auto back = wire::decode<std::vector<RoundValue>>(bytes);
    REQUIRE(back.size() == 2);
    CHECK_FALSE(back[0].record);
    REQUIRE(back[1].new_records.size() == 1);
    CHECK(hash_of(back[1].new_records[0].point) == hash_of(some_point()));
    CHECK(back[1].record.value().value == record.value);
    CHECK(wire::encode(back) == bytes);

    const auto point = wire::decode<AmbientPoint>(wire::encode(some_point()));
    CHECK(wire::encode(point) == wire::encode(some_point()));
}

TEST_CASE("bytes that are no points or values of a round are refused") {
    using Points = std::vector<AmbientPoint>;
    using Values = std::vector<RoundValue>;
    const std::string points = wire::encode(Points{some_point()});
    const std::string values = wire::encode(Values{{{{some_point(), {}}}, AmbientRecord()}});
    for (std::size_t size = 0; size < points.size(); ++size)
        CHECK_THROWS_AS((void)wire::decode<Points>(points.substr(0, size)), InputError);
    CHECK_THROWS_AS((void)wire::decode<Points>(points + 'x'), InputError);
    for (std::size_t size = 0; size < values.size(); ++size)
        CHECK_THROWS_AS((void)wire::decode<Values>(values.substr(0, size)), InputError);
    CHECK_THROWS_AS((void)wire::decode<Values>(std::string(8, '\xff')), InputError);
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
