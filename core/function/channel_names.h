#pragma once
// How function files call the inputs of an evaluation.
#include <array>
#include <string_view>

#include "core/function/program.h"

namespace lightwalk::function {

/// By Channel. From NxP on they are variables that only some materials set.
inline constexpr std::array<std::string_view, kChannelCount> kChannelNames{
    "",   "Dx", "Dy",  "Dz",  "Nx",  "Ny",    "Nz",  "Px",  "Py",  "Pz",  "T",   "Rdot", "S",
    "Tx", "Ty", "Tz",  "Ix",  "Iy",  "Iz",    "Jx",  "Jy",  "Jz",  "Kx",  "Ky",  "Kz",   "Ts",
    "Lu", "Lv", "NxP", "NyP", "NzP", "RdotP", "CrP", "CgP", "CbP", "DxA", "DyA", "DzA"};

}  // namespace lightwalk::function
