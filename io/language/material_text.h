#pragma once
// Scene text of materials that other formats describe.
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/language/primitive_text.h"

namespace lightwalk {

/// What is beyond the edges of a picture.
enum class TextureWrap { repeat, mirror, clamp };

/// A picture as a pattern: how the scene calls its file, its width by height, and how it goes on
/// along u and v.
struct TexturePicture {
    std::string file;
    double aspect = 1;
    TextureWrap wrap_u = TextureWrap::repeat, wrap_v = TextureWrap::repeat;
};

/// The library file of the functions that mixtures take.
inline constexpr const char* kMaterialLibrary = "gltf.cal";

/// Writes the primitives of a material.
class MaterialText {
  public:
    void add(std::string_view modifier, std::string_view type, const std::string& name,
             const std::vector<std::string>& strings, const std::vector<double>& reals) {
        append_primitive(modifier, type, name, strings, reals, kFullDigits, out_);
    }
    /// A `colorpict` that multiplies by a picture at a mesh's coordinates.
    void add_map(const std::string& name, const TexturePicture& picture);
    /// A `mixpict` of two materials by a function of a picture's values and of `reals`.
    void add_mix(const std::string& name, const std::string& fore, const std::string& back,
                 const std::string& function, const std::string& library,
                 const TexturePicture& picture, const std::vector<double>& reals);
    /// A `mixpict` of a material and what lies behind it, by a picture of opacities times
    /// `opacity`.
    void add_fading(const std::string& name, const std::string& material,
                    const TexturePicture& picture, double opacity) {
        add_mix(name, material, "void", "faded", kMaterialLibrary, picture, {opacity});
    }
    /// A `mixfunc` of a material and what lies behind it.
    void add_veil(const std::string& name, const std::string& material, double opacity);

    [[nodiscard]] std::string release() { return std::move(out_); }

  private:
    std::string out_;
};

/// The transmissivity of a pane whose transmittance at right angles is t. Source: "The Radiance 6.x
/// Scene Description Language" (ray.pdf), glass.
[[nodiscard]] double transmissivity(double t);

}  // namespace lightwalk
