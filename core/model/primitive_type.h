#pragma once
// The primitive types of the scene language. See "The Radiance 6.x Scene Description Language"
// (Radiance's ray.pdf).
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace lightwalk {

enum class PrimitiveType : std::uint8_t {
#define PRIMITIVE(id, word, kind) id,
#include "core/model/primitive_types.def"
};

/// What a primitive type is for.
enum class PrimitiveKind : std::uint8_t {
    surface,
    light,     ///< a material that emits
    material,  ///< a material that does not emit
    texture,
    pattern,
    mixture,
    spectrum,  ///< a pattern of spectra
    alias,
};

/// The scene file's word for a type ("BRTDfunc"), and back; nothing for an unknown word.
[[nodiscard]] std::string_view to_string(PrimitiveType type);
[[nodiscard]] std::optional<PrimitiveType> primitive_type(std::string_view word);
[[nodiscard]] PrimitiveKind kind_of(PrimitiveType type);
/// Number of types, which are numbered from 0.
[[nodiscard]] std::size_t primitive_type_count();
[[nodiscard]] inline bool is_surface(PrimitiveType type) {
    return kind_of(type) == PrimitiveKind::surface;
}
/// Whether the type is a material that emits light.
[[nodiscard]] inline bool is_light(PrimitiveType type) {
    return kind_of(type) == PrimitiveKind::light;
}
/// Whether the type is a material, emitting or not.
[[nodiscard]] inline bool is_material(PrimitiveType type) {
    return is_light(type) || kind_of(type) == PrimitiveKind::material;
}
[[nodiscard]] inline bool is_mixture(PrimitiveType type) {
    return kind_of(type) == PrimitiveKind::mixture;
}
/// Whether the kind colours what it modifies.
[[nodiscard]] inline bool is_pattern(PrimitiveKind kind) {
    return kind == PrimitiveKind::pattern || kind == PrimitiveKind::spectrum;
}
/// Whether the type is a surface that places another model.
[[nodiscard]] inline bool is_placement(PrimitiveType type) {
    return type == PrimitiveType::instance || type == PrimitiveType::mesh;
}

}  // namespace lightwalk
