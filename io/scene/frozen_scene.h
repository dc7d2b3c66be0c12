#pragma once
// Frozen scenes: a scene with everything that a run needs of it, in one memory-mapped file.
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/model/resources.h"
#include "core/scene/scene.h"
#include "io/files/file_manifest.h"
#include "io/files/file_source.h"
#include "io/scene/freezing_resources.h"
#include "io/scene/frozen_file.h"

namespace lightwalk {

/// Write a scene that was compiled with `library`, and the manifest of the files that it was read
/// from, atomically. Throws InputError.
void write_frozen_scene(const std::string& path, const Scene& scene,
                        const FreezingResources& library, std::span<const ManifestFile> manifest);
/// A frozen scene in memory that processes can share. The scene need not have a search tree; the
/// manifest is empty.
[[nodiscard]] std::shared_ptr<const MemoryFile> share_scene(const Scene& scene,
                                                            const FreezingResources& library);
/// The bytes of a frozen scene.
[[nodiscard]] std::string frozen_scene_bytes(const Scene& scene, const FreezingResources& library,
                                             std::span<const ManifestFile> manifest);

/// Whether bytes begin with the mark of a frozen scene.
[[nodiscard]] inline bool is_frozen_scene(std::string_view bytes) {
    return bytes.starts_with(kFrozenMark);
}
/// Whether a file exists and begins with the mark of a frozen scene; `files` is asked for its first
/// bytes.
[[nodiscard]] bool is_frozen_scene(const std::string& path, FileSource& files);

/// A file that was not needed when a scene was frozen.
class NotFrozen : public InputError {
  public:
    using InputError::InputError;
};

/// An open frozen scene: the model, and the library files that it was compiled with. Models refer
/// to the mapped pages, and keep them alive. For one thread, as all Resources.
class FrozenScene final : public Resources {
  public:
    /// Throws InputError for a damaged file, as far as a scene relies on the damaged parts. Parts
    /// are validated when they are first asked for.
    explicit FrozenScene(FrozenFile file);

    [[nodiscard]] std::shared_ptr<const Model> model();
    [[nodiscard]] const std::vector<ManifestFile>& manifest() const { return manifest_; }
    [[nodiscard]] const FrozenFile& file() const { return file_; }

    /// Whether such a file was asked for when the scene was frozen.
    [[nodiscard]] bool knows(const NamedFile& file) const;
    // Names that were not asked for when the scene was frozen are a NotFrozen error.
    [[nodiscard]] std::string function_file(const std::string& name) override;
    [[nodiscard]] std::shared_ptr<const DataArray> data(const std::string& name) override;
    [[nodiscard]] std::shared_ptr<const PictureData> picture(const std::string& name) override;
    [[nodiscard]] std::shared_ptr<const SpectralPicture> spectral_picture(
        const std::string& name) override;
    [[nodiscard]] std::shared_ptr<const Bsdf> bsdf(const std::string& name) override;
    [[nodiscard]] std::shared_ptr<const Font> font(const std::string& name) override;
    [[nodiscard]] std::vector<std::string> text_lines(const std::string& name) override;
    [[nodiscard]] std::shared_ptr<const Model> octree(const std::string& name) override;
    [[nodiscard]] std::shared_ptr<const MeshModel> mesh(const std::string& name) override;

  private:
    FrozenFile file_;
    std::vector<ManifestFile> manifest_;
    // Answers that are parts of the file are stored as the number of the part.
    ResourceAnswers<std::string> functions_;
    ResourceAnswers<std::vector<std::string>> texts_;
    ResourceAnswers<std::uint32_t> tables_, pictures_, spectral_pictures_, bsdfs_, fonts_, octrees_,
        meshes_;
    template <class T>
    using Mapped = std::map<std::uint32_t, std::shared_ptr<const T>>;
    Mapped<DataArray> mapped_tables_;
    Mapped<PictureData> mapped_pictures_;
    Mapped<SpectralPicture> mapped_spectral_pictures_;
    Mapped<Bsdf> mapped_bsdfs_;
    Mapped<Font> mapped_fonts_;
    Mapped<Model> mapped_models_;
    Mapped<MeshModel> mapped_meshes_;
};

/// Open a frozen scene. Throws InputError as FrozenScene() does, and, unless `stale_allowed`, when
/// files that it was made from have changed since; the message names them.
[[nodiscard]] std::unique_ptr<FrozenScene> open_frozen_scene(const std::string& path,
                                                             bool stale_allowed);

}  // namespace lightwalk
