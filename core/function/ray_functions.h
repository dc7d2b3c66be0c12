#pragma once
// Built-in functions of the ray and of the primitive's real arguments. `where` is the primitive's
// place, for errors.
#include <span>

#include "core/error.h"
#include "core/function/program.h"

namespace lightwalk::function {

/// The n-th real argument (n is rounded); for n < 1 the number of arguments.
/// @throws InputError when there are fewer than n
[[nodiscard]] double real_argument(std::span<const double> reals, double n,
                                   const SourceLocation& where);

/// Angle between the ray and -z [degrees], 0 to 180.
[[nodiscard]] double source_theta(const ChannelValues& channels);

/// Azimuth of the ray's origin [degrees], folded by `symmetry` (after rounding): 360, 180 or 90.
/// @throws InputError for another symmetry
[[nodiscard]] double source_phi(const ChannelValues& channels, double symmetry,
                                const SourceLocation& where);

/// Luminaire correction: v times the first real argument, over the projected area of the emitting
/// shape `kind`: 0 none, 1 flat, 2 box, 3 box nearby, 4 cylinder, whose size [m] the others give.
/// @throws InputError for another kind, or missing arguments
[[nodiscard]] double source_corr(const ChannelValues& channels, std::span<const double> reals,
                                 double v, double kind, const SourceLocation& where);

}  // namespace lightwalk::function
