#include "io/gltf/gltf_material.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/math/rgb.h"
#include "core/math/xyz.h"

namespace lightwalk {
namespace {

constexpr double kSmooth = 0.05;       ///< a lobe's width below which a pane is clear
constexpr double kMostlyClear = 0.9;   ///< transmission from which nothing else is left
constexpr double kLeastLit = 0.02;     ///< sum of a texel's channels that emits
constexpr double kLampRadius = 0.005;  ///< of lights without extent [m]
constexpr double kSunAngle = 0.533;    ///< [degrees]
constexpr double kLumens = kEfficacy;  ///< in a watt

class GltfMaterialWriter {
  public:
    GltfMaterialWriter(const GltfMaterial& material, const GltfPictures& pictures, bool is_light)
        : m_(material), pictures_(pictures), is_light_(is_light) {}

    std::string write() {
        const bool emits = std::ranges::max(m_.emitted) > 0;
        const bool fades =
            m_.alpha != GltfMaterial::Alpha::opaque && (m_.opacity < 1 || pictures_.opacity);
        const std::string whole = fades ? m_.name + "_opaque" : m_.name;
        if (emits && !m_.emitted_texture) {
            write_emission(is_light_ ? "light" : "glow", "void", whole);
        } else if (emits && pictures_.emitted) {
            const std::string dark = m_.name + "_dark", lit = m_.name + "_lit";
            write_surface(dark);
            text_.add_map(lit + "_map", *pictures_.emitted);
            write_emission("glow", lit + "_map", lit);
            text_.add_mix(whole, lit, dark, "lit", kMaterialLibrary, *pictures_.emitted,
                          {kLeastLit});
        } else {
            write_surface(whole);
        }
        if (fades) write_alpha(whole);
        return text_.release();
    }

  private:
    void write_emission(const char* type, const std::string& modifier, const std::string& name) {
        std::vector<double> reals;
        for (const double c : m_.emitted) reals.push_back(c / kLumens);
        if (type == std::string_view("glow")) reals.push_back(0);
        text_.add(modifier, type, name, {}, reals);
    }

    void write_surface(const std::string& name) {
        std::string modifier = "void";
        if (pictures_.base) text_.add_map(modifier = m_.name + "_map", *pictures_.base);
        const double width = m_.roughness * m_.roughness;
        const double f0 = (m_.ior - 1) / (m_.ior + 1) * (m_.ior - 1) / (m_.ior + 1);
        if (m_.transmission > 0 && m_.metallic < 0.5)
            write_transparent(modifier, name, width, f0);
        else
            write_opaque(modifier, name, width, f0);
    }

    void write_transparent(const std::string& modifier, const std::string& name, double width,
                           double f0) {
        const bool clear = width < kSmooth && m_.transmission >= kMostlyClear;
        const auto& base = m_.base;
        if (clear && m_.thickness > 0) {
            const auto left = [&](std::size_t c) {  // after a metre
                const double distance = m_.attenuation_distance;
                return distance > 0 ? std::pow(m_.attenuation[c], 1 / distance) : 1;
            };
            text_.add(modifier, "dielectric", name, {}, {left(0), left(1), left(2), m_.ior, 0});
        } else if (clear) {
            const auto left = [&](std::size_t c) {
                return transmissivity((1 - f0) * (1 - f0) * base[c]);
            };
            text_.add(modifier, "glass", name, {},
                      {left(0), left(1), left(2), std::max(m_.ior, 1.0)});
        } else {
            text_.add(modifier, "trans", name, {},
                      {base[0], base[1], base[2], f0, width, m_.transmission, 1});
        }
    }

    void write_opaque(const std::string& modifier, const std::string& name, double width,
                      double f0) {
        const auto& base = m_.base;
        if (m_.metallic >= 0.5 && !m_.unlit) {
            text_.add(modifier, "metal", name, {}, {base[0], base[1], base[2], m_.metallic, width});
            return;
        }
        const auto bright = static_cast<double>(
            brightness({static_cast<float>(base[0]), static_cast<float>(base[1]),
                        static_cast<float>(base[2])}));
        const double metallic = m_.unlit ? 0 : m_.metallic;
        const double specular = m_.unlit ? 0 : f0 + metallic * (bright - f0);
        const double diffuse =
            m_.unlit ? 1 : std::min(1.0, (1 - metallic) * (1 - f0) / (1 - specular));
        text_.add(modifier, "plastic", name, {},
                  {base[0] * diffuse, base[1] * diffuse, base[2] * diffuse, specular, width});
    }

    void write_alpha(const std::string& whole) {
        if (!pictures_.opacity) {
            const bool masked = m_.alpha == GltfMaterial::Alpha::mask;
            text_.add_veil(m_.name, whole, !masked ? m_.opacity : m_.opacity < m_.cutoff ? 0 : 1);
        } else if (m_.alpha == GltfMaterial::Alpha::mask) {
            const double least = m_.opacity > 0 ? m_.cutoff / m_.opacity : 2;
            text_.add_mix(m_.name, whole, "void", "cutout", kMaterialLibrary, *pictures_.opacity,
                          {least});
        } else {
            text_.add_fading(m_.name, whole, *pictures_.opacity, m_.opacity);
        }
    }

    const GltfMaterial& m_;
    const GltfPictures& pictures_;
    bool is_light_;
    MaterialText text_;
};

}  // namespace

std::string gltf_material_scene(const GltfMaterial& material, const GltfPictures& pictures,
                                bool is_light) {
    return GltfMaterialWriter(material, pictures, is_light).write();
}

std::string gltf_light_scene(const GltfLight& light, const std::string& name) {
    const bool distant = light.kind == GltfLight::Kind::directional;
    const Vec3& p = light.position;
    const Vec3& d = light.direction;
    const double half = kSunAngle / 2 * kPi / 180;
    // The projected area of the ball, or the projected solid angle of the source.
    const double extent =
        distant ? kPi * std::sin(half) * std::sin(half) : kPi * kLampRadius * kLampRadius;
    std::vector<double> reals;
    for (const double c : light.intensity) reals.push_back(c / kLumens / extent);
    const bool spot = light.kind == GltfLight::Kind::spot;
    if (spot) reals.insert(reals.end(), {2 * light.angle * 180 / kPi, d.x, d.y, d.z});
    MaterialText text;
    text.add("void", spot ? "spotlight" : "light", name, {}, reals);
    if (distant)
        text.add(name, "source", name, {}, {-d.x, -d.y, -d.z, kSunAngle});
    else
        text.add(name, "sphere", name, {}, {p.x, p.y, p.z, kLampRadius});
    return text.release();
}

}  // namespace lightwalk
