#pragma once
// fprism_val: light through a prismatic panel, for the language's prism functions.
#include <span>
#include <vector>

#include "core/function/program.h"

namespace lightwalk::function {

/// Trace the rays that leave a prismatic panel hit along (Dx, Dy, Dz), brightest first: for each
/// its direction and its share of the energy, four numbers. Nothing when Dx is 0.
/// @param reals  a, b, -, d: the prism's sides and depth; index; threshold of energy; metal face
///               (1, 2; 4 is none); its reflectance; angles [rad] within which rays are merged, and
///               within which they count as the one that is aimed at (DxA, DyA, DzA)
/// @return       false when a real argument is missing or out of range
[[nodiscard]] bool trace_prism(const ChannelValues& channels, std::span<const double> reals,
                               std::vector<double>& rays);

/// Component v (0, 1, 2: direction; 3: energy) of the n-th ray on side d.
/// @return NaN for another v
[[nodiscard]] double prism_value(const ChannelValues& channels, std::span<const double> rays,
                                 double v, double d, double n);

}  // namespace lightwalk::function
