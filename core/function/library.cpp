#include "core/function/library.h"

#include <cmath>

#include "core/function/library_values.h"

namespace lightwalk::function {
namespace {

constexpr ChannelMask mask(std::initializer_list<Channel> channels) {
    ChannelMask bits = 0;
    for (const Channel c : channels) bits |= channel_bit(c);
    return bits;
}
constexpr ChannelMask kZDirection = channel_bit(Channel::Dz);
constexpr ChannelMask kXyDirection = mask({Channel::Dx, Channel::Dy});
constexpr ChannelMask kDirection = kXyDirection | kZDirection;
constexpr ChannelMask kCorrection =
    kDirection | mask({Channel::Px, Channel::Py, Channel::Pz, Channel::Rdot, Channel::Ts});
constexpr ChannelMask kPrism = kDirection | mask({Channel::DxA, Channel::DyA, Channel::DzA});

constexpr LibraryEntry kLibrary[] = {
#define ENTRY(name, spelling, kind, arguments, evaluated, part, lanes, channels) \
    {spelling,  LibraryFunction::name, LibraryKind::kind,  arguments,            \
     evaluated, LibraryPart::part,     LaneSupport::lanes, channels},
#define SPECIAL_FORM(name, spelling, arguments) \
    ENTRY(name, spelling, special_form, arguments, arguments, core, none, 0)
#define REDUCTION(name, value) ENTRY(name, #name, reduction, 1, 1, core, vector, 0)
#define FUNCTION(name, arguments, part, lanes, value) \
    ENTRY(name, #name, function, arguments, arguments, part, lanes, 0)
#define RAY_FUNCTION(name, arguments, evaluated, channels, value) \
    ENTRY(name, #name, ray_function, arguments, evaluated, renderer, none, channels)
#include "core/function/library.def"
#undef ENTRY
};

/// The first argument with the last, and so on down to the second.
template <LibraryFunction f>
double reduce(std::span<const double> x, EvalState& state) {
    double result = x[0];
    for (std::size_t i = x.size(); --i > 0;) result = library_value<f>(result, x[i], 0, state);
    return result;
}

}  // namespace

std::span<const LibraryEntry> library_functions() {
    return kLibrary;
}

const LibraryEntry* find_library_function(std::string_view name,
                                          FunctionEnvironment::Library library) {
    for (const LibraryEntry& entry : kLibrary) {
        if (entry.name != name) continue;
        const bool known =
            entry.part == LibraryPart::core || library == FunctionEnvironment::Library::renderer;
        return known ? &entry : nullptr;
    }
    return nullptr;
}

const LibraryEntry& library_entry(LibraryFunction function) {
    return kLibrary[static_cast<std::size_t>(function)];
}

std::optional<double> constant_value(LibraryFunction function, std::span<const double> arguments) {
    EvalState state;
    const auto at = [&](std::size_t i) { return i < arguments.size() ? arguments[i] : 0.0; };
    switch (function) {
#define REDUCTION(name, value)  \
    case LibraryFunction::name: \
        return reduce<LibraryFunction::name>(arguments, state);
#define FUNCTION(name, arguments, part, lanes, value) \
    case LibraryFunction::name:                       \
        return library_value<LibraryFunction::name>(at(0), at(1), at(2), state);
#include "core/function/library.def"
        default:
            return std::nullopt;
    }
}

double rand_value(double x) {
    double y = x * (1 / (1 + x * x) + 2.71828182845904);
    y = y + (.785398163397447 - std::floor(y));
    y = 1e5 / y;
    return y - std::floor(y);
}

}  // namespace lightwalk::function
