#include "io/scene/file_resources.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "core/bsdf/bsdf.h"
#include "io/bsdf/bsdf_file.h"
#include "io/formats/decode.h"
#include "io/picture/spectral_picture.h"
#include "io/scene/binary_models.h"
#include "io/scene/gltf_scene.h"
#include "io/scene/named_files.h"
#include "io/scene/obj_scene.h"
#include "io/scene/picture_file.h"
#include "io/scene/scene_reader.h"
#include "io/wavefront/obj_mesh.h"

namespace lightwalk {
namespace {

constexpr std::size_t kLongestTextLine = 511;
constexpr std::size_t kBytesTogether = std::size_t{64} << 20;  ///< bytes read ahead of decoding

/// The cached value of `name`, or what `load` makes of it.
template <class T, class Load>
std::shared_ptr<const T> cached(std::map<std::string, std::shared_ptr<const T>>& cache,
                                const std::string& name, const Load& load) {
    const auto found = cache.find(name);
    if (found != cache.end()) return found->second;
    std::shared_ptr<const T> value = load();
    cache.emplace(name, value);
    return value;
}

}  // namespace

FileResources::FileResources(LibraryPath path, bool allow_commands, WarningSink& warnings)
    : path_(std::move(path)), allow_commands_(allow_commands), warnings_(warnings) {}

std::string FileResources::function_file(const std::string& name) {
    return path_.files().read(path_.locate(name, "function file"));
}

std::shared_ptr<const DataArray> FileResources::data(const std::string& name) {
    return cached(data_, name, [&] {
        const std::string path = path_.locate(name, "data file");
        return std::make_shared<const DataArray>(decode_data(path_.files().read(path), path));
    });
}

std::shared_ptr<const PictureData> FileResources::picture(const std::string& name) {
    return cached(pictures_, name, [&] {
        return std::make_shared<const PictureData>(decode_any_picture(picture_file(name)));
    });
}

std::shared_ptr<const SpectralPicture> FileResources::spectral_picture(const std::string& name) {
    return cached(spectral_pictures_, name, [&] {
        const std::string path = path_.locate(name, "spectral picture");
        return std::make_shared<const SpectralPicture>(
            decode_spectral_picture(path_.files().read(path), path));
    });
}

std::shared_ptr<const Bsdf> FileResources::bsdf(const std::string& name) {
    return cached(bsdfs_, name, [&] {
        const std::string path = path_.locate(name, "BSDF file");
        auto data = std::make_shared<BsdfData>(decode_bsdf(path_.files().read(path), path));
        if (data->name.empty()) data->name = name;
        return std::make_shared<const Bsdf>(std::move(data));
    });
}

std::shared_ptr<const Font> FileResources::font(const std::string& name) {
    return cached(fonts_, name, [&] {
        const std::string path = path_.locate(name, "font file");
        return std::make_shared<const Font>(decode_font(path_.files().read(path), path));
    });
}

std::vector<std::string> FileResources::text_lines(const std::string& name) {
    const std::string text = path_.files().read(path_.locate(name, "text file"));
    std::vector<std::string> lines;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::size_t length = std::min(end - begin, kLongestTextLine);
        lines.push_back(text.substr(begin, length));
        begin += length;
        if (begin == end) ++begin;
    }
    return lines;
}

std::shared_ptr<const Model> FileResources::octree(const std::string& name) {
    return cached(octrees_, name, [&] {
        const std::string path = path_.locate(name, "octree file");
        const SceneReadOptions options{path_, allow_commands_, path_.base()};
        return read_octree(path_.files().read(path), path, options, warnings_);
    });
}

std::shared_ptr<const MeshModel> FileResources::mesh(const std::string& name) {
    return cached(meshes_, name, [&] {
        if (const std::optional<ObjName> object = obj_name(name)) return obj_mesh(*object);
        if (const std::optional<GltfName> model = gltf_name(name)) return gltf_mesh(*model);
        const std::string path = path_.locate(name, "mesh file");
        return std::make_shared<const MeshModel>(decode_mesh(path_.files().read(path), path));
    });
}

/// The file is decoded once for all of its parts.
std::shared_ptr<const MeshModel> FileResources::obj_mesh(const ObjName& name) {
    const std::string path = path_.locate(name.file, "object file");
    const ObjFile file = decode_obj(path_.files().read(path), path);
    if (!name.material) {
        // The scene names pictures as it names this file, unless the library path leads to it.
        const bool here = path == path_from(path_.base(), name.file);
        Model materials =
            obj_materials(file, path, directory_of(here ? name.file : path), path_, warnings_);
        return std::make_shared<const MeshModel>(
            mesh_of_obj(file, std::nullopt, std::move(materials)));
    }
    for (const std::string& material : materials_of(file)) {
        if (material != *name.material)
            meshes_.emplace(name.file + kObjPart + material,
                            std::make_shared<const MeshModel>(mesh_of_obj(file, material, {})));
    }
    return std::make_shared<const MeshModel>(mesh_of_obj(file, name.material, {}));
}

/// The file that was asked for last is kept: its parts and images are asked for one after the
/// other.
std::shared_ptr<const GltfFile> FileResources::gltf_file(const std::string& path) {
    if (!gltf_ || gltf_path_ != path) {
        gltf_ = std::make_shared<const GltfFile>(read_gltf(path, path_.files()));
        gltf_path_ = path;
    }
    return gltf_;
}

std::shared_ptr<const MeshModel> FileResources::gltf_mesh(const GltfName& name) {
    const std::string path = path_.locate(name.file, "glTF file");
    const std::shared_ptr<const GltfFile> file = gltf_file(path);
    if (name.part) return gltf_part(*file, path, *name.part);
    // As an object file's, the pictures of its materials are named as this file is.
    const bool here = path == path_from(path_.base(), name.file);
    return std::make_shared<const MeshModel>(
        gltf_whole(*file, path, here ? name.file : path, path_, warnings_));
}

PictureFile FileResources::picture_file(const std::string& name) {
    const std::optional<GltfName> model = gltf_name(name);
    if (!model || !model->part || path_.find(name)) return read_picture_file(path_, name);
    const std::string path = path_.locate(model->file, "glTF file");
    return gltf_picture(*gltf_file(path), path, *model->part);
}

/// A file's bytes, and what they turn out to be.
struct FileResources::Reading {
    NamedFile file;
    PictureFile bytes;  ///< whatever it is
    std::shared_ptr<const Model> octree;
    std::shared_ptr<const MeshModel> mesh;
    std::shared_ptr<const PictureData> picture;

    /// Leaves all empty where something is wrong: whoever asks for the file will hear of it.
    void decode() {
        try {
            switch (file.kind) {
                case NamedFile::Kind::octree:
                    octree = decode_octree(bytes.bytes, bytes.path).model;
                    break;
                case NamedFile::Kind::mesh:
                    mesh = std::make_shared<const MeshModel>(decode_mesh(bytes.bytes, bytes.path));
                    break;
                case NamedFile::Kind::picture:
                    picture = std::make_shared<const PictureData>(decode_any_picture(bytes));
            }
        } catch (const InputError&) {
        }
        bytes = {};
    }
};

std::optional<FileResources::Reading> FileResources::read(const NamedFile& file) {
    if (file.kind == NamedFile::Kind::mesh && (obj_name(file.name) || gltf_name(file.name)))
        return std::nullopt;
    try {
        if (file.kind == NamedFile::Kind::picture)
            return Reading{file, picture_file(file.name), {}, {}, {}};
        const std::string path = path_.locate(file.name, "file");
        return Reading{file, {path, path_.files().read(path)}, {}, {}, {}};
    } catch (const InputError&) {
        return std::nullopt;
    }
}

void FileResources::decode(std::span<Reading> readings, const TaskRunner& task_runner) {
    task_runner.run(readings.size(), [&](std::size_t i) { readings[i].decode(); });
    for (Reading& reading : readings) {
        const std::string& name = reading.file.name;
        if (reading.octree) octrees_.emplace(name, std::move(reading.octree));
        if (reading.mesh) meshes_.emplace(name, std::move(reading.mesh));
        if (reading.picture) pictures_.emplace(name, std::move(reading.picture));
    }
}

void FileResources::prepare(std::span<const NamedFile> files, const TaskRunner& task_runner) {
    if (files.size() < 2) return;  // nothing to do side by side
    std::vector<Reading> readings;
    std::size_t bytes = 0;
    for (const NamedFile& file : files) {
        if (is_among(file, octrees_, meshes_, pictures_)) continue;
        if (std::optional<Reading> next = read(file)) {
            bytes += next->bytes.bytes.size();
            readings.push_back(*std::move(next));
        }
        if (bytes < kBytesTogether) continue;
        decode(readings, task_runner);
        readings.clear();
        bytes = 0;
    }
    decode(readings, task_runner);
}

}  // namespace lightwalk
