#include "io/language/number_text.h"

#include <doctest/doctest.h>

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>

#include "core/error.h"

namespace lightwalk {
namespace {

std::string printed(double value, std::chars_format format, int digits) {
    std::array<char, 400> text{};
    return {text.data(),
            std::to_chars(text.data(), text.data() + text.size(), value, format, digits).ptr};
}

std::string written(double value, int digits = 12) {
    std::string text;
    append_real(value, digits, text);
    return text;
}

/// Whether the number is either left alone or read to the last bit as std::from_chars reads it.
bool reads_exactly(const std::string& text) {
    double value = 0;
    double expected = 0;
    const std::size_t size = parse_simple_real(text, value);
    if (size == 0) return true;
    const char* const begin = text.data() + (text[0] == '+' ? 1 : 0);
    const auto result = std::from_chars(begin, text.data() + text.size(), expected);
    return result.ec == std::errc() && result.ptr == text.data() + size &&
           std::bit_cast<std::uint64_t>(value) == std::bit_cast<std::uint64_t>(expected);
}

/// How many characters of `text` are a plain number.
std::size_t plain(const std::string& text) {
    double value = 0;
    return parse_simple_real(text, value);
}

/// Doubles of every kind that coordinates can be: any bits, few digits, near powers of ten, ties.
double some_real(std::mt19937_64& random, int kind) {
    const std::uint64_t bits = random();
    const double scale = std::pow(10, static_cast<double>(random() % 18));
    switch (kind % 5) {
        case 0:
            return std::bit_cast<double>((bits & 0x800fffffffffffff) | (1000 + (bits >> 52) % 64)
                                                                           << 52);
        case 1:
            return std::round(static_cast<double>(bits >> 30) / 1e3) / scale;
        case 2:
            return scale / 1e6 * (1 + (static_cast<double>(bits % 2001) - 1000) * 1e-15);
        case 3:
            return (static_cast<double>(bits % 2000000000000) + 0.5) / scale;
        default:
            return static_cast<double>(bits >> 20) / std::pow(2, static_cast<double>(bits % 50));
    }
}

}  // namespace

TEST_CASE("a plain number has the bits that std::from_chars gives it, whatever its digits") {
    std::mt19937_64 random(1);
    std::size_t wrong = 0;
    for (int i = 0; i < 200000; ++i) {
        const double value = some_real(random, i);
        for (const int digits : {3, 6, 12, 15, 17}) {
            for (const auto format : {std::chars_format::general, std::chars_format::scientific})
                wrong += reads_exactly(printed(value, format, digits)) ? 0 : 1;
        }
    }
    CHECK(wrong == 0);
    for (const char* hard : {"9007199254740992",
                             "9007199254740993",
                             "9007199254740991e22",
                             "1e22",
                             "1e23",
                             "-0",
                             "-0.0",
                             "0e22",
                             "8.5e-22",
                             "1e-22",
                             "1e-23",
                             "123456789012345678901",
                             ".1",
                             "5.",
                             "0000000000000000001",
                             "00000000000000000001",
                             "+7",
                             "-.5e-3",
                             "1E+05",
                             "4503599627370497.5",
                             "18446744073709551616",
                             "1e0000022",
                             "0.0000000000000000000001"}) {
        CAPTURE(hard);
        CHECK(reads_exactly(hard));
    }
}

TEST_CASE("plain numbers are taken where they begin, all others are left alone") {
    CHECK(plain("12.5 7") == 4);
    CHECK(plain("1e5,") == 3);
    CHECK(plain("-3") == 2);
    CHECK(plain("4.") == 2);
    for (const char* other : {"", "-", "+", ".", "-.", "+-1", "e5", "x", "1e", "1e+", "1e400",
                              "9007199254740993", "12345678901234567890", "nan", "inf", " 1"}) {
        CAPTURE(other);
        double value = 42;
        CHECK(parse_simple_real(other, value) == 0);
        CHECK(value == 42);
    }
}

TEST_CASE("a number is written as printf writes it, ties and carries included") {
    std::mt19937_64 random(2);
    std::size_t wrong = 0;
    for (int i = 0; i < 500000; ++i) {
        const double value = some_real(random, i);
        wrong += written(value) == printed(value, std::chars_format::general, 12) ? 0 : 1;
    }
    CHECK(wrong == 0);
    for (const double value :
         {0.0, -0.0, 1e-4, 9.9999999999999e-5, 99999999999.96, 99999999999.9, 1e11, 999999999999.5,
          0.5, 1.0 / 3, -2.0 / 3, 123456.7890625, 1e300, 5e-324, 100000000000.5, 9999999999.995,
          std::numeric_limits<double>::max()}) {
        CAPTURE(value);
        CHECK(written(value) == printed(value, std::chars_format::general, 12));
        CHECK(written(value, 6) == printed(value, std::chars_format::general, 6));
    }
    CHECK_THROWS_AS(static_cast<void>(written(std::nan(""))), InputError);
    CHECK_THROWS_AS(static_cast<void>(written(-HUGE_VAL)), InputError);
}

}  // namespace lightwalk
