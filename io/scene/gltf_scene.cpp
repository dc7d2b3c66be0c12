#include "io/scene/gltf_scene.h"

#include <algorithm>
#include <charconv>
#include <utility>
#include <vector>

#include "io/gltf/gltf_material.h"
#include "io/scene/obj_scene.h"
#include "io/scene/scene_reader.h"

namespace lightwalk {
namespace {

constexpr std::string_view kImagePart = "image";
constexpr std::size_t kMostLights = 64;  ///< triangles of a material that are lights by themselves

/// The number that is all of `text`, less than `count`; nothing for others.
std::optional<std::size_t> part_number(std::string_view text, std::size_t count) {
    std::size_t number = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (code != std::errc() || end != text.data() + text.size() || number >= count)
        return std::nullopt;
    return number;
}

bool emits(const GltfMaterial& material) {
    return std::ranges::max(material.emitted) > 0;
}

/// The materials of a file as scene text, and what they take from images.
class GltfLibrary {
  public:
    /// @param shown  how the scene names the file
    GltfLibrary(const GltfFile& file, std::string path, const std::string& shown, FileSource& files,
                WarningSink& warnings)
        : file_(file),
          path_(std::move(path)),
          shown_(not_searched(shown)),
          files_(files),
          warnings_(warnings) {}

    [[nodiscard]] std::string scene(std::size_t index, const std::string& name, bool is_light) {
        GltfMaterial material = file_.materials[index];
        const auto picture = [&](const std::optional<GltfTexture>& texture, const char* what) {
            return picture_of(material.name, texture, what);
        };
        GltfPictures pictures;
        pictures.base = picture(material.base_texture, "baseColorTexture");
        pictures.emitted = picture(material.emitted_texture, "emissiveTexture");
        if (pictures.base && material.alpha != GltfMaterial::Alpha::opaque) {
            pictures.opacity = pictures.base;
            pictures.opacity->file += kAlphaPart;
        }
        if (material.roughness_texture) take_means(material);
        material.name = name;
        return gltf_material_scene(material, pictures, is_light);
    }

  private:
    /// The file of an image: its own, or a part of this one.
    [[nodiscard]] PictureFile read(std::size_t image) {
        const GltfImage& from = file_.images[image];
        if (from.uri.empty()) return gltf_picture(file_, path_, part_of(image));
        const std::string path = path_from(directory_of(path_), from.uri);
        return {path, files_.read(path)};
    }
    static std::string part_of(std::size_t image) {
        return std::string(kImagePart) + std::to_string(image);
    }

    std::optional<TexturePicture> picture_of(const std::string& material,
                                             const std::optional<GltfTexture>& texture,
                                             const char* what) {
        if (!texture) return std::nullopt;
        try {
            const std::string& uri = file_.images[texture->image].uri;
            const PictureFile file = read(texture->image);
            return TexturePicture{uri.empty() ? shown_ + kObjPart + part_of(texture->image)
                                              : not_searched(path_from(directory_of(shown_), uri)),
                                  image_aspect(file.bytes, file.path), texture->wrap_u,
                                  texture->wrap_v};
        } catch (const InputError& error) {
            warnings_.warn("material \"" + material + "\": " + what +
                           " is left out: " + error.what());
            return std::nullopt;
        }
    }

    /// Radiance's materials are as rough everywhere: the means of the texture.
    void take_means(GltfMaterial& material) {
        try {
            PictureFile file = read(material.roughness_texture->image);
            file.channels = ImageChannels::numbers;
            const PictureData data = decode_any_picture(file);
            double roughness = 0, metallic = 0;
            for (const Rgb& texel : data.values) {
                roughness += static_cast<double>(texel.g);
                metallic += static_cast<double>(texel.b);
            }
            const auto count = static_cast<double>(data.values.size());
            material.roughness *= std::clamp(roughness / count, 0.0, 1.0);
            material.metallic *= std::clamp(metallic / count, 0.0, 1.0);
        } catch (const InputError& error) {
            warnings_.warn("material \"" + material.name +
                           "\": metallicRoughnessTexture is left out: " + error.what());
        }
    }

    const GltfFile& file_;
    std::string path_, shown_;
    FileSource& files_;
    WarningSink& warnings_;
};

void write_polygons(const MeshModel& mesh, const std::string& modifier, const std::string& name,
                    std::string& text) {
    for (const MeshModel::Triangle& triangle : mesh.triangles) {
        std::vector<double> reals;
        for (const std::uint32_t corner : triangle.v) {
            const MeshModel::Vertex& v = mesh.positions[corner];
            reals.insert(reals.end(), {v.x, v.y, v.z});
        }
        append_primitive(modifier, "polygon", name, {}, reals, kFullDigits, text);
    }
}

}  // namespace

std::optional<GltfName> gltf_name(const std::string& name) {
    const auto is_gltf = [](std::string_view file) {
        return has_ending(file, ".glb") || has_ending(file, ".gltf");
    };
    if (is_gltf(name)) return GltfName{name, std::nullopt};
    for (std::size_t at = name.find(kObjPart); at != std::string::npos;
         at = name.find(kObjPart, at + 1)) {
        if (is_gltf(std::string_view(name).substr(0, at)))
            return GltfName{name.substr(0, at), name.substr(at + 1)};
    }
    return std::nullopt;
}

GltfFile read_gltf(const std::string& path, FileSource& files) {
    return decode_gltf(files.read(path), path, [&](const std::string& beside) {
        const std::string found = path_from(directory_of(path), beside);
        if (!files.readable(found)) throw InputError({found, 0}, "cannot open");
        return files.read(found);
    });
}

std::string gltf_scene(const std::string& name, const std::string& path, FileSource& files,
                       const FunctionRef<bool(const std::string&)>* is_defined,
                       WarningSink& warnings) {
    const GltfFile file = read_gltf(path, files);
    for (const std::string& what : file.left_out) warnings.warn(path + ": " + what);
    GltfLibrary library(file, path, name, files, warnings);
    std::string text = "# glTF\n";
    for (std::size_t i = 0; i < file.parts.size(); ++i) {
        const MeshModel& mesh = *file.parts[i];
        if (mesh.triangles.empty()) continue;
        const bool has_material = i < file.materials.size();
        const std::string given = has_material ? file.materials[i].name : std::string(kNoMaterial);
        std::string modifier = given;
        bool is_light = false;
        if (is_defined == nullptr || !(*is_defined)(given)) {
            modifier = name + kObjPart + given;
            if (has_material) {
                is_light = emits(file.materials[i]) && !file.materials[i].emitted_texture &&
                           mesh.triangles.size() <= kMostLights;
                text += library.scene(i, modifier, is_light);
            } else {
                text += no_material_scene(modifier);
            }
        }
        const std::string shape = name + kObjPart + std::to_string(i);
        if (is_light)
            write_polygons(mesh, modifier, shape, text);
        else
            append_primitive(modifier, "mesh", shape, {not_searched(shape)}, {}, kFullDigits, text);
    }
    for (std::size_t i = 0; i < file.lights.size(); ++i)
        text += gltf_light_scene(file.lights[i], name + kObjPart + "light" + std::to_string(i));
    return text;
}

std::shared_ptr<const MeshModel> gltf_part(const GltfFile& file, const std::string& path,
                                           const std::string& part) {
    if (const auto number = part_number(part, file.parts.size())) return file.parts[*number];
    throw InputError({path, 0}, "has no part \"" + part + "\", expected the number of a material");
}

PictureFile gltf_picture(const GltfFile& file, const std::string& path, const std::string& part) {
    PictureFile picture{path + kObjPart + part, {}};
    std::string_view text = part;
    if (text.ends_with(kAlphaPart)) {
        picture.channels = ImageChannels::alpha;
        text.remove_suffix(kAlphaPart.size());
    }
    std::optional<std::size_t> number;
    if (text.starts_with(kImagePart))
        number = part_number(text.substr(kImagePart.size()), file.images.size());
    if (!number || file.images[*number].bytes.empty())
        throw InputError({path, 0}, "holds no picture \"" + part + "\"");
    picture.bytes = file.images[*number].bytes;
    return picture;
}

MeshModel gltf_whole(const GltfFile& file, const std::string& path, const std::string& shown,
                     const LibraryPath& library, WarningSink& warnings) {
    GltfLibrary materials(file, path, shown, library.files(), warnings);
    MeshModel whole;
    std::string text = "# materials\n";
    std::vector<std::string> names(file.parts.size());
    for (std::size_t i = 0; i < file.materials.size(); ++i) {
        if (file.parts[i]->triangles.empty()) continue;
        names[i] = file.materials[i].name;
        text += materials.scene(i, names[i], false);
    }
    if (text.find("void") != std::string::npos) {
        whole.materials.modifiers =
            parse_scene(text, path, {library, false, library.base(), {}}, warnings)->modifiers;
    }
    const std::vector<Primitive>& modifiers = whole.materials.modifiers;
    bool any_normals = false, any_uvs = false;
    for (const auto& part : file.parts) {
        any_normals = any_normals || !part->normals.empty();
        any_uvs = any_uvs || !part->us.empty();
    }
    for (std::size_t i = 0; i < file.parts.size(); ++i) {
        const MeshModel& part = *file.parts[i];
        const auto first = static_cast<std::uint32_t>(whole.positions.size());
        const auto material =
            std::ranges::find(modifiers.rbegin(), modifiers.rend(), names[i], &Primitive::name);
        for (std::size_t v = 0; v < part.positions.size(); ++v) {
            whole.positions.push_back(part.positions[v]);
            if (any_normals)
                whole.normals.push_back(part.normals.empty() ? MeshModel::Vertex{0, 0, 1}
                                                             : part.normals[v]);
            if (any_uvs) {
                whole.us.push_back(part.us.empty() ? 0 : part.us[v]);
                whole.vs.push_back(part.vs.empty() ? 0 : part.vs[v]);
            }
        }
        for (MeshModel::Triangle triangle : part.triangles) {
            for (std::uint32_t& corner : triangle.v) corner += first;
            triangle.material = names[i].empty() || material == modifiers.rend()
                                    ? kVoidIndex
                                    : static_cast<std::int32_t>(modifiers.rend() - material) - 1;
            whole.triangles.push_back(triangle);
        }
    }
    return whole;
}

}  // namespace lightwalk
