#pragma once
// Indices of discomfort glare beside DGP, from the same sources.
#include "core/glare/glare.h"

namespace lightwalk {

struct GlareIndices {
    double dgi = 0;    ///< daylight glare index
    double ugr = 0;    ///< unified glare rating
    double vcp = 100;  ///< visual comfort probability: who is not disturbed [%]
    double cgi = 0;    ///< CIE glare index
    /// Veiling luminance of the sources: 10 E / theta², E at the eye, theta from the line of sight
    /// in degrees [cd/m²].
    double veiling_luminance = 0;
    /// What evalglare 3.06 prints as Lveil: 5 E / theta, E of a source's mean luminance at its
    /// place. Its output tells so, to all digits; no publication is known to have this formula.
    double evalglare_veil = 0;
};

/// @param report   of a picture
/// @param forward  the line of sight, unit
/// Without sources, or in front of nothing but sources, what cannot be told is 0 (vcp: 100).
/// Sources: Hopkinson, "Glare from daylighting in buildings", Applied Ergonomics 3 (1972), with
/// solid angles over the square of the position index (DGI); CIE 117 (UGR); Guth, "Discomfort glare
/// and angle of view" and IES RQQ 2 (VCP); Einhorn, Lighting Research & Technology 11 (1979) (CGI);
/// Holladay & Stiles (veiling luminance).
[[nodiscard]] GlareIndices glare_indices(const GlareReport& report, const Vec3& forward);

}  // namespace lightwalk
