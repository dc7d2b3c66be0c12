#include "io/scene/obj_scene.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "io/language/primitive_text.h"
#include "io/scene/picture_file.h"
#include "io/scene/scene_reader.h"
#include "io/wavefront/mtl_file.h"

namespace lightwalk {
namespace {

/// The materials of an object file's libraries, as scene text.
class ObjLibrary {
  public:
    /// @param shown  the directory by which the scene names files beside the object file
    ObjLibrary(const ObjFile& file, const std::string& path, std::string shown, FileSource& files,
               WarningSink& warnings)
        : directory_(directory_of(path)),
          shown_(std::move(shown)),
          files_(files),
          warnings_(warnings) {
        for (const std::string& name : file.libraries) {
            const std::string library = path_from(directory_, name);
            if (!files_.readable(library)) {
                warnings_.warn(path + ": cannot open mtllib " + library);
                continue;
            }
            for (MtlMaterial& material : decode_mtl(files_.read(library), library))
                materials_.insert_or_assign(material.name, std::move(material));
        }
    }

    [[nodiscard]] bool has(const std::string& name) const { return materials_.contains(name); }

    /// The material, which the scene calls `shown`.
    [[nodiscard]] std::string scene(const std::string& name, const std::string& shown) {
        MtlMaterial material = materials_.at(name);
        MtlPictures pictures{picture(material.map_kd, "map_Kd", name),
                             picture(material.map_d, "map_d", name)};
        if (pictures.opacity) pictures.opacity->file += kAlphaPart;
        if (material.bumpy && !std::exchange(told_of_bumps_, true))
            warnings_.warn("material \"" + name +
                           "\": its map of heights or normals is left out, and so are others'");
        material.name = shown;
        return mtl_scene(material, pictures);
    }

  private:
    /// @param map  the statement that names it, for the warning where it is no picture
    std::optional<TexturePicture> picture(std::string file, const char* map,
                                          const std::string& material) {
        if (file.empty()) return std::nullopt;
        // Many come from where paths are written with backslashes.
        if (!files_.readable(path_from(directory_, file))) std::ranges::replace(file, '\\', '/');
        try {
            return texture_beside(file, directory_, shown_, files_);
        } catch (const InputError& error) {
            warnings_.warn("material \"" + material + "\": " + map +
                           " is left out: " + error.what());
            return std::nullopt;
        }
    }

    std::string directory_, shown_;
    FileSource& files_;
    WarningSink& warnings_;
    std::map<std::string, MtlMaterial> materials_;
    bool told_of_bumps_ = false;
};

/// The first face of each material.
std::vector<const ObjFile::Face*> first_faces(const ObjFile& file) {
    std::vector<const ObjFile::Face*> faces;
    std::set<std::uint64_t> known;  // of pairs of names
    std::set<std::string_view> names;
    for (const ObjFile::Face& face : file.faces) {
        const std::uint64_t pair = std::uint64_t{face.material} << 32 | face.group;
        if (!known.insert(pair).second) continue;
        if (names.insert(file.material_of(face)).second) faces.push_back(&face);
    }
    return faces;
}

}  // namespace

std::string no_material_scene(const std::string& name) {
    std::string text;
    append_primitive("void", "plastic", name, {}, {.5, .5, .5, 0, 0}, kFullDigits, text);
    return text;
}

bool has_ending(std::string_view name, std::string_view ending) {
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
    return name.size() >= ending.size() &&
           std::ranges::equal(name.substr(name.size() - ending.size()), ending, {}, lower);
}

std::optional<ObjName> obj_name(const std::string& name) {
    if (has_ending(name, ".obj")) return ObjName{name, std::nullopt};
    for (std::size_t at = name.find(kObjPart); at != std::string::npos;
         at = name.find(kObjPart, at + 1)) {
        if (has_ending(std::string_view(name).substr(0, at), ".obj"))
            return ObjName{name.substr(0, at), name.substr(at + 1)};
    }
    return std::nullopt;
}

std::vector<std::string> materials_of(const ObjFile& file) {
    std::vector<std::string> names;
    for (const ObjFile::Face* face : first_faces(file)) names.push_back(file.material_of(*face));
    return names;
}

std::string obj_scene(const std::string& name, const std::string& path, FileSource& files,
                      const FunctionRef<bool(const std::string&)>* is_defined,
                      WarningSink& warnings) {
    const ObjFile file = decode_obj(files.read(path), path);
    ObjLibrary library(file, path, directory_of(name), files, warnings);
    std::string text;
    const auto has = [&](const std::string& material) {
        return is_defined != nullptr && (*is_defined)(material);
    };
    bool white = false;
    for (const ObjFile::Face* face : first_faces(file)) {
        const std::string& material = file.material_of(*face);
        PrimitiveText mesh;
        mesh.modifier = material;
        if (!material.empty() && has(material)) {
            // the scene's own
        } else if (library.has(material)) {
            mesh.modifier = name + kObjPart + material;  // other files have others of this name
            text += library.scene(material, mesh.modifier);
        } else if (face->material != ObjFile::kNone) {
            if (is_defined != nullptr)
                throw InputError(
                    {path, face->line},
                    "undefined material \"" + material +
                        "\": neither a scene file before it nor its mtllib defines it");
        } else if (has(std::string(kNoMaterial))) {
            mesh.modifier = kNoMaterial;
        } else {
            mesh.modifier = name + kObjPart + std::string(kNoMaterial);
            if (!std::exchange(white, true)) text += no_material_scene(mesh.modifier);
        }
        mesh.type_word = "mesh";
        mesh.name = name + kObjPart + material;
        mesh.strings = {not_searched(name) + kObjPart + material};
        write_primitive(mesh, kFullDigits, text);
    }
    return text;
}

Model obj_materials(const ObjFile& file, const std::string& path, const std::string& shown,
                    const LibraryPath& library, WarningSink& warnings) {
    ObjLibrary materials(file, path, shown, library.files(), warnings);
    std::string text = "# materials\n";
    for (const std::string& name : materials_of(file)) {
        if (!name.empty() && materials.has(name)) text += materials.scene(name, name);
    }
    Model model;
    if (text.find("void") == std::string::npos) return model;
    model.modifiers =
        parse_scene(text, path, {library, false, library.base(), {}}, warnings)->modifiers;
    return model;
}

}  // namespace lightwalk
