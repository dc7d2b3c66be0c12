#pragma once
// The built-in functions of the language; the table of them is library.def.
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "core/function/environment.h"
#include "core/function/program.h"

namespace lightwalk::function {

/// The built-in functions: the rows of library.def, in their order.
enum class LibraryFunction : std::uint8_t {
#define ANY_FUNCTION(name) name,
#include "core/function/library.def"
};

enum class LibraryKind : std::uint8_t { special_form, reduction, function, ray_function };
enum class LibraryPart : std::uint8_t { core, renderer };
enum class LaneSupport : std::uint8_t { none, in_turn, vector };

/// A row of library.def, where the columns are described.
struct LibraryEntry {
    std::string_view name;
    LibraryFunction function;
    LibraryKind kind;
    int arguments;
    int evaluated;  ///< for a reduction: all arguments
    LibraryPart part;
    LaneSupport lanes;
    ChannelMask channels;

    /// Whether a call with constant arguments may be replaced by its value.
    [[nodiscard]] bool constant() const { return kind != LibraryKind::ray_function; }
};

[[nodiscard]] std::span<const LibraryEntry> library_functions();
/// The function called `name`; nothing when there is none.
[[nodiscard]] const LibraryEntry* find_library_function(std::string_view name,
                                                        FunctionEnvironment::Library library);
[[nodiscard]] const LibraryEntry& library_entry(LibraryFunction function);

/// The value of a call with numeric arguments, before the check for numeric errors. Nothing for
/// functions that control evaluation (if, select, ...) and for functions of the ray.
/// @param arguments  at least as many as the function uses
[[nodiscard]] std::optional<double> constant_value(LibraryFunction function,
                                                   std::span<const double> arguments);

/// trunc(x + 0.5) as the language rounds selectors, clamped to the range of int; INT_MIN for NaN.
[[nodiscard]] inline int rounded_index(double x) {
    const double r = x + 0.5;
    if (!(r > -2147483648.0)) return -2147483647 - 1;
    return r < 2147483647.0 ? static_cast<int>(r) : 2147483647;
}

/// Which of `cases` values select(n, ...) chooses, counted from 1; 0: it returns the number of
/// cases; -1: domain error.
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

/// Texts of function files: the initial definitions of renderers, and those of generators.
[[nodiscard]] std::string_view initial_definitions(FunctionEnvironment::Library library);

}  // namespace lightwalk::function
