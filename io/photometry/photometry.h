#pragma once
// What a luminaire's file says of its light: the distribution of its intensity, and the size of
// what emits it.
#include <optional>
#include <string>
#include <vector>

namespace lightwalk {

/// How a goniometer turns the luminaire: the axis that its planes meet in. Types C, B and A of
/// CIE 121 and of IES LM-75; the numbers are those of IES LM-63.
enum class PhotometryType { c = 1, b = 2, a = 3 };

/// The body whose surface emits, about the origin. z is up, x is the photometric horizontal at 0
/// degrees.
struct LuminousBody {
    enum class Form { box, cylinder, sphere };
    Form form = Form::sphere;
    double x = 0, y = 0, z = 0;  ///< sizes [m], more than 0; of a cylinder x and y, of a sphere all
                                 ///< are the diameter
};

/// The factor of a lamp's flux when it is tilted.
struct LampTilt {
    int geometry = 1;                     ///< of lamp and luminaire, from 1 to 3
    std::vector<double> angles, factors;  ///< [degrees], ascending; as many factors
};

/// The distribution of intensity.
struct Photometry {
    PhotometryType type = PhotometryType::c;
    std::vector<double> vertical;     ///< angles [degrees], ascending; of type C from the nadir
    std::vector<double> horizontal;   ///< angles [degrees], ascending; at least 1
    std::vector<double> intensities;  ///< [horizontal * vertical.size() + vertical] [cd]
    double factor = 1;                ///< of all intensities
    LuminousBody body;
};

}  // namespace lightwalk
