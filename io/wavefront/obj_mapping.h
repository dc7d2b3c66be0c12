#pragma once
// Mapping files of obj2rad -m: which faces of an object file have which material.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/wavefront/obj_file.h"

namespace lightwalk {

/// A rule: the material of the faces that meet all of its conditions.
struct ObjRule {
    enum class Qualifier { material, map, group, object, face };
    struct Condition {
        Qualifier qualifier{};
        std::string value;  ///< unless it is a range of numbers
        std::int64_t low = 0, high = -1;
    };
    std::string material;
    std::vector<Condition> conditions;
};

/// Decode a file: MATERIAL (QUALIFIER VALUE) ... ; where a value is "text", a number or
/// [low:high]. Qualifiers are Material, Map, Group, Object and Face. Throws InputError "NAME:LINE:
/// ...". Source: Radiance's manual page obj2rad(1).
[[nodiscard]] std::vector<ObjRule> decode_obj_mapping(std::string_view text,
                                                      const std::string& name);

/// The material of a face by the last rule whose conditions it meets; nothing where it meets those
/// of no rule, or of one of `void`: it is left out. Conditions on a Map are never met, which is how
/// Radiance 6.1a's obj2rad behaves.
/// @param number  of the face in its file, from 1
[[nodiscard]] std::optional<std::string> mapped_material(const std::vector<ObjRule>& rules,
                                                         const ObjFile& file,
                                                         const ObjFile::Face& face,
                                                         std::size_t number);

/// The values of a file's qualifiers, as obj2rad -n lists them.
[[nodiscard]] std::string obj_qualifiers(const ObjFile& file, const std::string& name);

}  // namespace lightwalk
