#pragma once
// fprism_val: light through a prismatic panel, for the language's prism functions.
#include <span>

#include "core/function/program.h"

namespace lightwalk::function {

/// Of the rays that leave a prismatic panel hit along (Dx, Dy, Dz), brightest first, the n-th on
/// side d: component v of its direction (0, 1, 2) or its share of the energy (3).
/// @param reals  a, b, -, d: the prism's sides and depth; index; threshold of energy; metal face
///               (1, 2; 4 is none); its reflectance; angles [rad] within which rays are merged, and
///               within which they count as the one that is aimed at (DxA, DyA, DzA)
/// @param cache  the rays, traced by the first call
/// @return       NaN for another v, or when a real argument is missing or out of range
[[nodiscard]] double fprism_val(const ChannelValues& channels, std::span<const double> reals,
                                double v, double d, double n, EvalState::PrismRays& cache);

}  // namespace lightwalk::function
