#include "core/ambient/ambient_bytes.h"

#include <doctest/doctest.h>

#include <limits>
#include <string>

namespace lightwalk {
namespace {

using namespace std::string_literals;

AmbientRecord record() {
    AmbientRecord r;
    r.position = {1, -2.5f, 1e-3f};
    r.normal = 0x12345678;
    r.axis = 0x9abcdef0;
    r.radius = {0.25f, 0.5f};
    r.translation = {-3, 0.1f};
    r.rotation = {0, 2};
    r.value = {1.001953125f, 0.5f + 1 / 256.0f, 1 / 256.0f};  // the middle of quantisation steps
    r.weight = 0.5f;
    r.corral = 0x80000001;
    r.level = 1;
    return r;
}

/// `r` with one field changed by `change`.
template <class Change>
std::string problem_after(const Change& change) {
    AmbientRecord r = record();
    change(r);
    return ambient_record_problem(r).value_or("");
}

TEST_CASE("an ambient record takes 67 bytes, each field in its place") {
    const std::string bytes = encode_ambient_record(record());
    REQUIRE(bytes.size() == kAmbientRecordSize);
    CHECK(bytes[0] == 1);
    CHECK(bytes.substr(1, 5) == "\x3f\xff\xff\xff\x00"s);   // weight 0.5
    CHECK(bytes.substr(6, 5) == "\x3f\xff\xff\xff\x01"s);   // x = 1
    CHECK(bytes.substr(21, 4) == "\x12\x34\x56\x78"s);      // n
    CHECK(bytes.substr(25, 4) == "\x9a\xbc\xde\xf0"s);      // u
    CHECK(bytes.substr(29, 5) == "\x3f\xff\xff\xff\xff"s);  // short radius
    CHECK(bytes.substr(59, 4) == "\x80\x00\x00\x01"s);      // corral
    CHECK(bytes.substr(63, 4) == "\x80\x40\x00\x81"s);      // value
}

TEST_CASE("what a record's bytes give encodes to the same bytes, and differs by rounding only") {
    const std::string bytes = encode_ambient_record(record());
    const AmbientRecord back = decode_ambient_record(bytes + "more");
    CHECK(encode_ambient_record(back) == bytes);
    CHECK(back.level == 1);
    CHECK(back.normal == record().normal);
    CHECK(back.axis == record().axis);
    CHECK(back.corral == record().corral);
    CHECK(back.weight == 0.5f);
    CHECK(back.position == record().position);
    CHECK(back.radius == record().radius);
    CHECK(back.translation == record().translation);
    CHECK(back.rotation == record().rotation);
    for (std::size_t k = 0; k < 3; ++k)  // half a step of the brightest channel's eight bits
        CHECK(std::abs(back.value[k] - record().value[k]) <= 1 / 256.0f);
}

TEST_CASE("records that no cache can use are told from those it can") {
    CHECK(problem_after([](AmbientRecord&) {}).empty());
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    CHECK(problem_after([](AmbientRecord& r) { r.position[2] = 2e10f; }) ==
          "a position out of range");
    CHECK(problem_after([](AmbientRecord& r) { r.position[0] = nan; }) ==
          "a position out of range");
    CHECK(problem_after([](AmbientRecord& r) { r.normal = 0; }) == "a direction that is none");
    CHECK(problem_after([](AmbientRecord& r) { r.axis = 0; }) == "a direction that is none");
    CHECK(problem_after([](AmbientRecord& r) { r.weight = 0; }) == "a weight out of range");
    CHECK(problem_after([](AmbientRecord& r) { r.weight = 1.5f; }) == "a weight out of range");
    CHECK(problem_after([](AmbientRecord& r) { r.radius[0] = 0; }) == "a radius out of range");
    CHECK(problem_after([](AmbientRecord& r) { r.radius[0] = 1; }) == "radii in the wrong order");
    CHECK(problem_after([](AmbientRecord& r) { r.rotation[1] = nan; }) ==
          "a gradient out of range");
    CHECK(problem_after([](AmbientRecord& r) { r.value.g = -1; }) == "a value out of range");
}

}  // namespace
}  // namespace lightwalk
