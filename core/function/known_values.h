#pragma once
// Values of recursive functions that are computed once.
#include "core/function/code.h"

namespace lightwalk::function {

/// Computes the values of the functions that call functions, have one parameter and depend on
/// nothing else, for the arguments 0, 1, 2, ... as far as these meet no error and little work is
/// enough. Sums by recursion over the rows of a sky (Radiance's reinhart.cal) take a step for each
/// row otherwise, for each ray.
void remember_values(Program::Code& code);

}  // namespace lightwalk::function
