#pragma once
// The built-in functions of the language: names, argument counts, and what they need of a ray.
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/function/environment.h"
#include "core/function/program.h"

namespace lightwalk::function {

enum class LibraryFunction : std::uint8_t {
    if_,
    select,
    min,
    max,
    rand,
    floor,
    ceil,
    sqrt,
    exp,
    log,
    log10,
    sin,
    cos,
    tan,
    asin,
    acos,
    atan,
    atan2,
    arg,
    erf,
    erfc,
    noise3,
    noise3x,
    noise3y,
    noise3z,
    fnoise3,
    source_theta,
    source_phi,
    source_corr,
    fprism_val,
};

struct LibraryEntry {
    std::string_view name;
    LibraryFunction function;
    int arguments;  ///< that it may use; 1 for the functions of any number
    bool variadic;
    bool constant;         ///< a call with constant arguments may be replaced by its value
    bool core;             ///< known to the generators, too; the others belong to the renderer
    ChannelMask channels;  ///< what it reads besides its arguments
};

[[nodiscard]] std::span<const LibraryEntry> library_functions();
/// The entry called `name`; nothing when there is none.
[[nodiscard]] const LibraryEntry* find_library_function(std::string_view name,
                                                        FunctionEnvironment::Library library);
[[nodiscard]] const LibraryEntry& library_entry(LibraryFunction function);

/// Value of a function whose arguments are numbers and that needs no ray, before the test for
/// numeric errors. `arguments` has at least as many values as the function uses.
/// Not for if, select, arg and the source and prism functions.
[[nodiscard]] double library_value(LibraryFunction function, const double* arguments,
                                   std::size_t count);

/// trunc(x + 0.5) as the language rounds selectors; the limits of int stand for all beyond, and
/// INT_MIN for NaN.
[[nodiscard]] inline int rounded_index(double x) {
    const double r = x + 0.5;
    if (!(r > -2147483648.0)) return -2147483647 - 1;
    return r < 2147483647.0 ? static_cast<int>(r) : 2147483647;
}

/// Which of `cases` values select(n, ...) chooses, from 1; 0 for their number; -1 for a domain
/// error.
[[nodiscard]] inline int selected_case(double n, int cases) {
    if (!(n >= -0.5)) return -1;
    const int k = rounded_index(n);
    return k > cases ? -1 : k;
}

inline constexpr double kMostHalves = 32;
/// x to the power n / 2, |n| <= kMostHalves, by squaring: relative error below 4e-15 where nothing
/// overflows.
[[nodiscard]] inline double half_power(double x, std::int32_t n) {
    const auto halves = static_cast<std::uint32_t>(n < 0 ? -n : n);
    double result = (halves & 1) != 0 ? std::sqrt(x) : 1, square = x;
    for (std::uint32_t k = halves >> 1; k > 0; k >>= 1, square *= square) {
        if ((k & 1) != 0) result *= square;
    }
    return n < 0 ? 1 / result : result;
}

/// Pseudo-random number in [0, 1) that depends on x alone.
[[nodiscard]] double rand_value(double x);

/// The definitions that a renderer starts with, and those of the generators; text of a function
/// file.
[[nodiscard]] std::string_view initial_definitions(FunctionEnvironment::Library library);

}  // namespace lightwalk::function
