#pragma once
// Photometric data files of EULUMDAT (.ldt).
#include <optional>
#include <string>
#include <string_view>

#include "io/photometry/lamp_table.h"
#include "io/photometry/photometry.h"

namespace lightwalk {

struct EulumdatFile {
    Photometry photometry;  ///< its factor makes candelas of candelas per 1000 lumens
    double flux = 0;        ///< of the lamps of the first set [lm]
    /// The black body of the lamps' colour temperature; nothing where none is given.
    std::optional<Lamp> lamp;
};

/// Decode a file: a value a line, decimals after a point or a comma. Planes that symmetry (Isym)
/// leaves out are those that the coordinates of luminaire_scene fold into the others. C0 is along
/// x; the length of the luminous area is along C90, as the format has it. Throws InputError
/// "NAME:LINE: ...". Source: A. W. Stockmar, "EULUMDAT/2 - Extended Version of a Well Established
/// Luminaire Data Format", CIBSE National Lighting Conference (1998).
[[nodiscard]] EulumdatFile decode_eulumdat(std::string_view text, const std::string& name);

/// The chromaticity of a black body from 1667 to 25000 K; nothing for others. Source: Kim et al.,
/// "Design of advanced color temperature control system for HDTV applications", J. Korean Physical
/// Society 41 (2002), pp. 865-871.
[[nodiscard]] std::optional<Lamp> black_body(double kelvin);

}  // namespace lightwalk
