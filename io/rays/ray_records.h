#pragma once
// Records of traced rays in rtrace's output formats, with the fields that the letters of -o ask
// for.
#include <string>
#include <string_view>

#include "core/scene/scene.h"
#include "core/transport/ray.h"
#include "io/rays/ray_reader.h"

namespace lightwalk {

/// The form of colours in a record.
enum class ColorOutput {
    rgb,        ///< -pRGB: radiance [W/(m² sr)]
    xyz,        ///< -pXYZ: CIE X Y Z, Y in cd/m²
    luminance,  ///< -pY: one number [cd/m²]
    mean,       ///< -pA: one number, the plain mean [W/(m² sr)]
};

/// A finished ray, as input of a record.
struct RayRecord {
    const Ray& ray;
    const Hit& first;     ///< the nearest hit before shading turned anything over
    bool sensor = false;  ///< the ray is an irradiance at a given point (-I) and has hit nothing
};

/// Appends a number of a record in one of the formats; rgbe has none for single numbers.
void append_number(double value, NumberFormat format, std::string& output);

class RayRecords {
  public:
    /// @param letters  the letters of -o; see the manual page rtrace(1):
    ///                 o d v V w W l L c p n N s m M r x R X ~
    /// Throws UsageError for an empty list, unknown letters, letters of ray trees (t, T: see
    /// ray_tree.h), and for formats that cannot hold the fields.
    RayRecords(std::string_view letters, NumberFormat format, ColorOutput color);

    /// Whether some field needs shading; if not, the nearest hit of the ray is enough.
    [[nodiscard]] bool shades() const;
    /// Whether some field distinguishes mirrored from direct light (r R x X).
    [[nodiscard]] bool splits() const {
        return letters_.find_first_of("rRxX") != std::string::npos;
    }
    /// Whether V or W are among the fields, which only have a meaning in ray trees.
    [[nodiscard]] bool asks_for_coefficients() const {
        return letters_.find_first_of("VW") != std::string::npos;
    }
    /// How many numbers a record has; a name counts as one.
    [[nodiscard]] int components() const;

    void append(const RayRecord& traced, const Scene& scene, std::string& output) const;

    /// The last lines of the output's header: NCOMP= (unless records are of several kinds),
    /// PRIMARIES= (XYZ only), BigEndian= and FORMAT= with the empty line that ends the header. When
    /// `bytes_before` bytes precede them, binary data start at a multiple of their size.
    [[nodiscard]] std::string header_end(std::size_t bytes_before, bool one_kind = true) const;

  private:
    void append_field(char letter, const RayRecord& traced, const Scene& scene,
                      std::string& output) const;
    void append_number(double value, std::string& output) const {
        lightwalk::append_number(value, format_, output);
    }
    void append_vector(const Vec3& v, std::string& output) const;
    void append_color(const Rgb& color, std::string& output) const;

    std::string letters_;
    NumberFormat format_;
    ColorOutput color_;
};

}  // namespace lightwalk
