#pragma once
// A luminaire as scene text: the light that its body gives, and the data files it refers to.
#include <string>
#include <string_view>

#include "core/math/rgb.h"
#include "io/photometry/photometry.h"

namespace lightwalk {

struct LuminaireStyle {
    std::string name;               ///< that names in the scene begin with
    std::string data_name;          ///< of the file of intensities, as the scene calls it
    std::string modifier = "void";  ///< of the distribution
    Rgb color{1, 1, 1};
    double unit = 1;     ///< lengths of the scene in a metre
    bool illum = false;  ///< an illum instead of a light
};

/// The primitives of a luminaire at the origin: pattern, light and surfaces. A distribution that
/// does not go beyond 90 degrees is that of a body that shines downward (or upward) only: it is
/// flat. Numbers have six digits, as ies2rad writes them. Source: Radiance's manual page
/// ies2rad(1); library file source.cal.
[[nodiscard]] std::string luminaire_scene(const Photometry& photometry,
                                          const LuminaireStyle& style);

/// The data file of its intensities, in watts per steradian and channel.
[[nodiscard]] std::string luminaire_data(const Photometry& photometry);

/// The pattern that weakens a tilted lamp, and its data file.
[[nodiscard]] std::string tilt_scene(const LampTilt& tilt, const std::string& name,
                                     const std::string& data_name);
[[nodiscard]] std::string tilt_data(const LampTilt& tilt);

}  // namespace lightwalk
