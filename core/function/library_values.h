#pragma once
// Implementation of the built-in functions: the column `value` of library.def as code, used for
// constants, for single rays and for several rays at once (SIMD).
#include <cmath>

#include "core/function/code.h"
#include "core/function/library.h"
#include "core/function/noise.h"
#include "core/function/prism.h"
#include "core/function/program.h"
#include "core/function/ray_functions.h"
#include "core/math/elementary.h"

namespace lightwalk::function {

/// The value of a function of up to three arguments (unused ones are ignored), or of a step of a
/// reduction.
template <LibraryFunction f>
double library_value(double x, double y, double z, EvalState& state);

/// The value of a function of the ray or of the primitive's real arguments.
template <LibraryFunction f>
double ray_value(double x, double y, double z, const Program::Code& code, EvalState& state);

#define FUNCTION(name, arguments, part, lanes, value)                                    \
    template <>                                                                          \
    [[gnu::always_inline]] inline double library_value<LibraryFunction::name>(           \
        [[maybe_unused]] double x, [[maybe_unused]] double y, [[maybe_unused]] double z, \
        [[maybe_unused]] EvalState& state) {                                             \
        return value;                                                                    \
    }
#define REDUCTION(name, value) FUNCTION(name, 2, core, vector, value)
#define RAY_FUNCTION(name, arguments, evaluated, channels, value)                        \
    template <>                                                                          \
    [[gnu::always_inline]] inline double ray_value<LibraryFunction::name>(               \
        [[maybe_unused]] double x, [[maybe_unused]] double y, [[maybe_unused]] double z, \
        [[maybe_unused]] const Program::Code& code, [[maybe_unused]] EvalState& state) { \
        return value;                                                                    \
    }
#include "core/function/library.def"

}  // namespace lightwalk::function
