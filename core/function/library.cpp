#include "core/function/library.h"

#include <array>
#include <cmath>

#include "core/function/noise.h"

namespace lightwalk::function {
namespace {

using F = LibraryFunction;

constexpr ChannelMask mask(std::initializer_list<Channel> channels) {
    ChannelMask bits = 0;
    for (const Channel c : channels) bits |= channel_bit(c);
    return bits;
}
constexpr ChannelMask kDirection = mask({Channel::Dx, Channel::Dy, Channel::Dz});
constexpr ChannelMask kCorrection =
    kDirection | mask({Channel::Px, Channel::Py, Channel::Pz, Channel::Rdot, Channel::Ts});
constexpr ChannelMask kPrism = kDirection | mask({Channel::DxA, Channel::DyA, Channel::DzA});

// In the order of LibraryFunction. Source: Radiance's icalc manual page and "Function Files" notes.
constexpr std::array<LibraryEntry, 30> kLibrary{{
    {"if", F::if_, 3, false, true, true, 0},
    {"select", F::select, 1, true, true, true, 0},
    {"min", F::min, 1, true, true, true, 0},
    {"max", F::max, 1, true, true, true, 0},
    {"rand", F::rand, 1, false, true, true, 0},
    {"floor", F::floor, 1, false, true, true, 0},
    {"ceil", F::ceil, 1, false, true, true, 0},
    {"sqrt", F::sqrt, 1, false, true, true, 0},
    {"exp", F::exp, 1, false, true, true, 0},
    {"log", F::log, 1, false, true, true, 0},
    {"log10", F::log10, 1, false, true, true, 0},
    {"sin", F::sin, 1, false, true, true, 0},
    {"cos", F::cos, 1, false, true, true, 0},
    {"tan", F::tan, 1, false, true, true, 0},
    {"asin", F::asin, 1, false, true, true, 0},
    {"acos", F::acos, 1, false, true, true, 0},
    {"atan", F::atan, 1, false, true, true, 0},
    {"atan2", F::atan2, 2, false, true, true, 0},
    {"arg", F::arg, 1, false, false, false, 0},
    {"erf", F::erf, 1, false, true, false, 0},
    {"erfc", F::erfc, 1, false, true, false, 0},
    {"noise3", F::noise3, 3, false, true, false, 0},
    {"noise3x", F::noise3x, 3, false, true, false, 0},
    {"noise3y", F::noise3y, 3, false, true, false, 0},
    {"noise3z", F::noise3z, 3, false, true, false, 0},
    {"fnoise3", F::fnoise3, 3, false, true, false, 0},
    {"source_theta", F::source_theta, 1, false, false, false, channel_bit(Channel::Dz)},
    {"source_phi", F::source_phi, 1, false, false, false, mask({Channel::Dx, Channel::Dy})},
    {"source_corr", F::source_corr, 2, false, false, false, kCorrection},
    {"fprism_val", F::fprism_val, 3, false, false, false, kPrism},
}};

double smallest(const double* x, std::size_t n) {
    double m = x[0];
    for (std::size_t i = n; --i > 0;) {
        if (x[i] < m) m = x[i];
    }
    return m;
}

double largest(const double* x, std::size_t n) {
    double m = x[0];
    for (std::size_t i = n; --i > 0;) {
        if (x[i] > m) m = x[i];
    }
    return m;
}

double noise_slope(int axis, const double* x) {
    NoiseMemory memory;
    return noise3_difference(axis, x[0], x[1], x[2], memory);
}

}  // namespace

std::span<const LibraryEntry> library_functions() {
    return kLibrary;
}

const LibraryEntry* find_library_function(std::string_view name,
                                          FunctionEnvironment::Library library) {
    for (const LibraryEntry& entry : kLibrary) {
        if (entry.name != name) continue;
        return entry.core || library == FunctionEnvironment::Library::renderer ? &entry : nullptr;
    }
    return nullptr;
}

const LibraryEntry& library_entry(LibraryFunction function) {
    return kLibrary[static_cast<std::size_t>(function)];
}

double library_value(LibraryFunction function, const double* x, std::size_t count) {
    switch (function) {
        case F::min:
            return smallest(x, count);
        case F::max:
            return largest(x, count);
        case F::rand:
            return rand_value(x[0]);
        case F::floor:
            return std::floor(x[0]);
        case F::ceil:
            return std::ceil(x[0]);
        case F::sqrt:
            return std::sqrt(x[0]);
        case F::exp:
            return std::exp(x[0]);
        case F::log:
            return std::log(x[0]);
        case F::log10:
            return std::log10(x[0]);
        case F::sin:
            return std::sin(x[0]);
        case F::cos:
            return std::cos(x[0]);
        case F::tan:
            return std::tan(x[0]);
        case F::asin:
            return std::asin(x[0]);
        case F::acos:
            return std::acos(x[0]);
        case F::atan:
            return std::atan(x[0]);
        case F::atan2:
            return std::atan2(x[0], x[1]);
        case F::erf:
            return std::erf(x[0]);
        case F::erfc:
            return std::erfc(x[0]);
        case F::noise3:
            return lightwalk::noise3(x[0], x[1], x[2]);
        case F::noise3x:
            return noise_slope(0, x);
        case F::noise3y:
            return noise_slope(1, x);
        case F::noise3z:
            return noise_slope(2, x);
        case F::fnoise3:
            return lightwalk::fnoise3(x[0], x[1], x[2]);
        default:
            return 0;
    }
}

double rand_value(double x) {
    double y = x * (1 / (1 + x * x) + 2.71828182845904);
    y = y + (.785398163397447 - std::floor(y));
    y = 1e5 / y;
    return y - std::floor(y);
}

}  // namespace lightwalk::function
