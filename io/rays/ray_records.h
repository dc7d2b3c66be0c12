#pragma once
// Records of traced rays as rtrace prints them: the letters of -o.
#include <string>
#include <string_view>

#include "core/scene/scene.h"
#include "core/transport/ray.h"
#include "io/rays/ray_reader.h"

namespace lightwalk {

/// What stands for a colour in a record.
enum class ColorOutput {
    rgb,        ///< -pRGB: radiance [W/(m² sr)]
    xyz,        ///< -pXYZ: CIE X Y Z, Y in cd/m²
    luminance,  ///< -pY: one number [cd/m²]
    mean,       ///< -pA: one number, the plain mean [W/(m² sr)]
};

/// A finished ray as a record sees it.
struct RayRecord {
    const Ray& ray;
    const Hit& first;     ///< the nearest hit before shading turned anything over
    bool sensor = false;  ///< irradiance at a given point (-I): nothing was hit
};

class RayRecords {
  public:
    /// @param letters  of -o; see the manual page rtrace(1): o d v V w W l L c p n N s m M r x R X
    /// ~ Throws UsageError for an empty list, unknown letters, ray trees (t, T: see ray_tree.h),
    /// and for formats that cannot hold the fields.
    RayRecords(std::string_view letters, NumberFormat format, ColorOutput color);

    /// Whether some field needs radiance; if not, a single ray cast answers everything.
    [[nodiscard]] bool shades() const;
    /// Whether mirrored and direct parts are told apart (r R x X).
    [[nodiscard]] bool splits() const {
        return letters_.find_first_of("rRxX") != std::string::npos;
    }
    /// Whether V or W are asked for, which only mean something in ray trees.
    [[nodiscard]] bool asks_for_coefficients() const {
        return letters_.find_first_of("VW") != std::string::npos;
    }
    /// Numbers in a record, a name counting as one.
    [[nodiscard]] int components() const;

    void append(const RayRecord& traced, const Scene& scene, std::string& output) const;

    /// The lines NCOMP= (unless records are of several kinds), PRIMARIES= (XYZ only), BigEndian=
    /// and FORMAT= with the empty line that ends the header. Binary data start at a multiple of
    /// their size when `bytes_before` precede these lines.
    [[nodiscard]] std::string header_end(std::size_t bytes_before, bool one_kind = true) const;

  private:
    void append_field(char letter, const RayRecord& traced, const Scene& scene,
                      std::string& output) const;
    void append_number(double value, std::string& output) const;
    void append_vector(const Vec3& v, std::string& output) const;
    void append_color(const Rgb& color, std::string& output) const;

    std::string letters_;
    NumberFormat format_;
    ColorOutput color_;
};

}  // namespace lightwalk
