#pragma once
// Names of the inputs of an evaluation in function files.
#include <array>
#include <string_view>

#include "core/function/program.h"

namespace lightwalk::function {

/// The names, indexed by Channel. NxP and later ones are variables that only some materials set.
inline constexpr std::array<std::string_view, kChannelCount> kChannelNames{
    "",   "Dx", "Dy",  "Dz",  "Nx",  "Ny",    "Nz",  "Px",  "Py",  "Pz",  "T",   "Rdot", "S",
    "Tx", "Ty", "Tz",  "Ix",  "Iy",  "Iz",    "Jx",  "Jy",  "Jz",  "Kx",  "Ky",  "Kz",   "Ts",
    "Lu", "Lv", "NxP", "NyP", "NzP", "RdotP", "CrP", "CgP", "CbP", "DxA", "DyA", "DzA"};

}  // namespace lightwalk::function
