#pragma once
// Files of photometric data of the IES (.ies): ANSI/IES LM-63 of 1986, 1991, 1995, 2002 and 2019.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/photometry/photometry.h"

namespace lightwalk {

struct IesFile {
    std::vector<std::string> header;  ///< the lines before TILT=
    /// The parts of the header that say what lamp it is: all lines before 1991, since then what
    /// follows the keywords [LAMP] and [LAMPCAT].
    std::vector<std::string> lamps;
    std::string tilt_file;         ///< named after TILT=; "" when there is none
    std::optional<LampTilt> tilt;  ///< of TILT=INCLUDE
    Photometry photometry;         ///< its factor is that of lamps times that of ballasts
    double watts = 0;
};

/// Decode a file. Numbers are separated by white space or commas, wherever lines end. Throws
/// InputError "NAME:LINE: ...". Sources: ANSI/IES LM-63-19; I. Ashdown, "Parsing the IESNA LM-63
/// photometric data file" (1998).
[[nodiscard]] IesFile decode_ies(std::string_view text, const std::string& name);

/// Decode a file that TILT= names: the lines that else follow TILT=INCLUDE. Throws InputError.
[[nodiscard]] LampTilt decode_tilt(std::string_view text, const std::string& name);

/// The editions that differ in what the sizes of the luminous opening mean.
enum class IesEdition { until_1991, of_1995, since_2002 };

/// The luminous opening of a width, length and height [m], of which negative ones mean round
/// bodies, by rules that each edition changed. A body of no height is flat: it is half a millimetre
/// high; no edge of a box is shorter than a millimetre. Bodies that Radiance has no primitive for
/// become the nearest: ellipses and upright elliptic cylinders round, lying cylinders and
/// ellipsoids boxes. Nothing for sizes that mean nothing.
[[nodiscard]] std::optional<LuminousBody> luminous_body(IesEdition edition, double width,
                                                        double length, double height);

}  // namespace lightwalk
