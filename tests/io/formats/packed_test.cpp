#include "io/formats/packed.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "core/error.h"

using namespace lightwalk;

namespace {

PackedReader reader_of(const std::string& bytes) {
    return {std::as_bytes(std::span<const char>(bytes)), "a.lwz", "the list"};
}

std::string sample() {
    PackedWriter writer;
    writer.number(-7);
    writer.boolean(true);
    writer.text(std::string("a\0b", 3));
    writer.list(std::vector<double>{1.5, -0.0});
    writer.texts(std::vector<std::string>{"", "x"});
    return writer.bytes();
}

/// Whether it is the sample; throws InputError where it is cut short.
bool is_sample(const std::string& bytes) {
    PackedReader reader = reader_of(bytes);
    const bool same = reader.number<int>() == -7 && reader.boolean() &&
                      reader.text() == std::string("a\0b", 3) &&
                      reader.list<double>() == std::vector<double>{1.5, -0.0} &&
                      reader.texts() == std::vector<std::string>{"", "x"};
    reader.end();
    return same;
}

}  // namespace

TEST_CASE("packed: what is written is read again") {
    CHECK(is_sample(sample()));
}

TEST_CASE("packed: bytes cut short anywhere, or followed by more, are refused") {
    const std::string whole = sample();
    for (std::size_t size = 0; size < whole.size(); ++size)
        CHECK_THROWS_WITH_AS((void)is_sample(whole.substr(0, size)), "a.lwz: damaged: the list",
                             InputError);
    CHECK_THROWS_AS((void)is_sample(whole + 'x'), InputError);
}

TEST_CASE("packed: a count is bounded by the bytes that are left, a bool is 0 or 1") {
    PackedWriter writer;
    writer.count(std::size_t{1} << 62);
    writer.number(std::uint64_t{0});
    CHECK_THROWS_AS((void)reader_of(writer.bytes()).text(), InputError);
    CHECK_THROWS_AS((void)reader_of(writer.bytes()).list<double>(), InputError);
    CHECK_THROWS_AS((void)reader_of(writer.bytes()).texts(), InputError);
    const std::string two = "\2";
    CHECK_THROWS_AS((void)reader_of(two).boolean(), InputError);
}
