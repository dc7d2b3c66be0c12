#pragma once
// Implements Resources by files along the library path, decoded once and cached by name.
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/model/resources.h"
#include "io/files/library_path.h"

namespace lightwalk {

struct GltfFile;
struct GltfName;
struct ObjName;
struct PictureFile;

/// For one thread, which builds a scene. Relative names, also those inside an octree that is not
/// frozen, are resolved against `path`'s base directory.
class FileResources final : public Resources {
  public:
    FileResources(LibraryPath path, bool allow_commands, WarningSink& warnings);
    [[nodiscard]] std::string function_file(const std::string& name) override;
    [[nodiscard]] std::shared_ptr<const DataArray> data(const std::string& name) override;
    /// If NAME.pic does not exist NAME.hdr is read, and the other way round. PNG, JPEG, TIFF, TGA
    /// and BMP files are pictures, too (decode_image), and the images that a glTF file holds
    /// (gltf_scene.h).
    [[nodiscard]] std::shared_ptr<const PictureData> picture(const std::string& name) override;
    [[nodiscard]] std::shared_ptr<const SpectralPicture> spectral_picture(
        const std::string& name) override;
    [[nodiscard]] std::shared_ptr<const Bsdf> bsdf(const std::string& name) override;
    [[nodiscard]] std::shared_ptr<const Font> font(const std::string& name) override;
    /// Lines longer than 511 bytes are divided there; the last line end is optional.
    [[nodiscard]] std::vector<std::string> text_lines(const std::string& name) override;
    [[nodiscard]] std::shared_ptr<const Model> octree(const std::string& name) override;
    /// A compiled mesh, or an object file (.obj): all of it, with the materials of its mtllib, or
    /// as FILE#NAME the faces of one material, without any; a glTF file likewise, as FILE#NUMBER.
    [[nodiscard]] std::shared_ptr<const MeshModel> mesh(const std::string& name) override;
    /// Reads files one after the other, a bounded number of bytes at a time, and decodes them in
    /// parallel. Octrees that are not frozen are read when they are asked for.
    void prepare(std::span<const NamedFile> files, const TaskRunner& task_runner) override;
    [[nodiscard]] const LibraryPath& path() const { return path_; }

  private:
    struct Reading;
    [[nodiscard]] std::shared_ptr<const MeshModel> obj_mesh(const ObjName& name);
    [[nodiscard]] std::shared_ptr<const GltfFile> gltf_file(const std::string& path);
    [[nodiscard]] std::shared_ptr<const MeshModel> gltf_mesh(const GltfName& name);
    [[nodiscard]] PictureFile picture_file(const std::string& name);
    /// The bytes of a file; nothing if it does not exist or cannot be read.
    [[nodiscard]] std::optional<Reading> read(const NamedFile& file);
    void decode(std::span<Reading> readings, const TaskRunner& task_runner);

    LibraryPath path_;
    bool allow_commands_;
    WarningSink& warnings_;
    std::map<std::string, std::shared_ptr<const DataArray>> data_;
    std::map<std::string, std::shared_ptr<const PictureData>> pictures_;
    std::map<std::string, std::shared_ptr<const SpectralPicture>> spectral_pictures_;
    std::map<std::string, std::shared_ptr<const Bsdf>> bsdfs_;
    std::map<std::string, std::shared_ptr<const Font>> fonts_;
    std::map<std::string, std::shared_ptr<const Model>> octrees_;
    std::map<std::string, std::shared_ptr<const MeshModel>> meshes_;
    std::string gltf_path_;
    std::shared_ptr<const GltfFile> gltf_;  ///< that of gltf_path_, or null
};

}  // namespace lightwalk
