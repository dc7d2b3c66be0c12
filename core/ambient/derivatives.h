#pragma once
// Gradients and validity radii of an ambient value, from the samples that it is the sum of.
#include <array>
#include <cstdint>

#include "core/ambient/hemisphere.h"

namespace lightwalk {

struct RadiusLimits {
    double accuracy = 0.1;       ///< -aa
    double least = 0, most = 0;  ///< [m]
    double weight = 1;           ///< evaluation weight: radii grow by its inverse root
};

/// Everything relative to the value; along the axes u and normal x u.
struct AmbientDerivatives {
    Vec3 u;                               ///< short axis
    std::array<double, 2> radius{};       ///< short, long; per unit of -aa [m]
    std::array<double, 2> translation{};  ///< [1/m]
    std::array<double, 2> rotation{};     ///< [1/rad]
    std::uint32_t corral = 0;             ///< see AmbientRecord
};

/// Derive gradients and radii from a complete hemisphere with at least seven divisions. The
/// samples' triangles are the scene that is seen: how their form factors change gives gradient and
/// Hessian. Source: Schwarzhaupt, Jensen & Jarosz, "Practical Hessian-Based Error Control for
/// Irradiance Caching", SIGGRAPH Asia 2012; the rotation gradient: Ward & Heckbert, EGWR 1992.
[[nodiscard]] AmbientDerivatives derive(const Hemisphere& hemisphere, const RadiusLimits& limits);

/// The rotation gradient alone, in the sampling frame (u, v).
[[nodiscard]] std::array<double, 2> rotation_gradient(const Hemisphere& hemisphere);

}  // namespace lightwalk
