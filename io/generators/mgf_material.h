#pragma once
// Colours and materials of the Materials and Geometry Format, and what they are in the scene
// language. Source: Ward, "The Materials and Geometry Format, version 2.0", LBNL (1996); Radiance's
// manual page mgf2rad(1).
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "core/error.h"
#include "core/math/rgb.h"

namespace lightwalk {

/// Words of a line of MGF; the first is the entity.
using MgfWords = std::span<const std::string>;

/// Number `at` of a line, which must be there. Throws InputError without a place.
[[nodiscard]] double mgf_number(MgfWords words, std::size_t at);

/// The current context of an entity (c, m, v), and those that have names.
template <class T>
class MgfContexts {
  public:
    /// ENTITY: a new one without a name; ENTITY NAME: an earlier one; ENTITY NAME = [TEMPLATE]: a
    /// new one.
    void select(MgfWords words) {
        if (words.size() > 2 && words[2] != "=")
            throw InputError("found \"" + words[2] + "\", expected =");
        if (words.size() == 1) {
            unnamed_ = {};
            name_.clear();
        } else {
            const T value = words.size() == 3 ? T{} : find(words[words.size() == 2 ? 1 : 3]);
            named_[words[1]] = value;
            name_ = words[1];
        }
    }
    [[nodiscard]] const T& find(const std::string& name) const {
        const auto found = named_.find(name);
        if (found == named_.end()) throw InputError("undefined name \"" + name + "\"");
        return found->second;
    }
    [[nodiscard]] T& current() { return name_.empty() ? unnamed_ : named_[name_]; }
    [[nodiscard]] const std::string& name() const { return name_; }

  private:
    std::map<std::string, T> named_;
    T unnamed_{};
    std::string name_;
};

/// A colour of brightness 1.
struct MgfColor {
    Rgb rgb{1, 1, 1};
};

/// Entities cxy, cspec, cct and cmix: what the current colour becomes; false for other entities.
[[nodiscard]] bool read_color_entity(MgfWords words, MgfContexts<MgfColor>& colors);

/// What a part of a material reflects, transmits or emits.
struct MgfPart {
    double amount = 0;  ///< 1, or lm/m²
    Rgb color{1, 1, 1};
    double roughness = 0;
    [[nodiscard]] Rgb value() const { return color * static_cast<float>(amount); }
};
struct MgfMaterial {
    MgfPart diffuse, diffuse_through, specular, specular_through, emitted;
    double index = 1;  ///< of refraction
    bool two_sides = true;
};

/// Entities sides, rd, td, rs, ts, ed and ir; false for others.
[[nodiscard]] bool read_material_entity(MgfWords words, const MgfColor& color,
                                        MgfMaterial& material);

/// The primitives that define it.
[[nodiscard]] std::string material_text(const MgfMaterial& material, const std::string& name);

}  // namespace lightwalk
