#pragma once
// A scene with all that a run needs of it in one file, which is mapped rather than read.
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/resources.h"
#include "core/scene/scene.h"
#include "io/files/file_manifest.h"
#include "io/files/file_source.h"
#include "io/scene/freezing_resources.h"
#include "io/scene/frozen_file.h"

namespace lightwalk {

/// Writes a scene that was compiled with `library`, and what it was read from; whole or not at all.
/// Throws InputError.
void write_frozen_scene(const std::string& path, const Scene& scene,
                        const FreezingResources& library, std::span<const ManifestFile> manifest);
/// The same in memory that processes share, of a scene that need not have a search tree. It does
/// not know what it was read from.
[[nodiscard]] std::shared_ptr<const MemoryFile> share_scene(const Scene& scene,
                                                            const FreezingResources& library);
/// The same bytes in memory.
[[nodiscard]] std::string frozen_scene_bytes(const Scene& scene, const FreezingResources& library,
                                             std::span<const ManifestFile> manifest);

/// Whether a file begins as a frozen scene does.
[[nodiscard]] inline bool is_frozen_scene(std::string_view bytes) {
    return bytes.starts_with(kFrozenMark);
}
/// The same of a file that may be none: `files` is asked for its first bytes.
[[nodiscard]] bool is_frozen_scene(const std::string& path, FileSource& files);

/// A frozen scene, as the model and the library that it was compiled with. Models show the file's
/// pages, and keep them. For one thread, as all Resources.
class FrozenScene final : public Resources {
  public:
    /// Throws InputError for a file that is damaged, in so far as a scene relies on it. Parts are
    /// looked at when they are asked for.
    explicit FrozenScene(FrozenFile file);

    [[nodiscard]] std::shared_ptr<const Model> model();
    [[nodiscard]] const std::vector<ManifestFile>& manifest() const { return manifest_; }
    [[nodiscard]] const FrozenFile& file() const { return file_; }

    // What is asked for by a name that was not asked for when the scene was frozen: InputError.
    [[nodiscard]] std::string function_file(const std::string& name) override;
    [[nodiscard]] std::shared_ptr<const DataArray> data(const std::string& name) override;
    [[nodiscard]] std::shared_ptr<const PictureData> picture(const std::string& name) override;
    [[nodiscard]] std::shared_ptr<const Font> font(const std::string& name) override;
    [[nodiscard]] std::vector<std::string> text_lines(const std::string& name) override;
    [[nodiscard]] std::shared_ptr<const Model> octree(const std::string& name) override;
    [[nodiscard]] std::shared_ptr<const MeshModel> mesh(const std::string& name) override;

  private:
    FrozenFile file_;
    std::vector<ManifestFile> manifest_;
    // Answers that are parts: their numbers.
    ResourceAnswers<std::string> functions_;
    ResourceAnswers<std::vector<std::string>> texts_;
    ResourceAnswers<std::uint32_t> tables_, pictures_, fonts_, octrees_, meshes_;
    template <class T>
    using Mapped = std::map<std::uint32_t, std::shared_ptr<const T>>;
    Mapped<DataArray> mapped_tables_;
    Mapped<PictureData> mapped_pictures_;
    Mapped<Font> mapped_fonts_;
    Mapped<Model> mapped_models_;
    Mapped<MeshModel> mapped_meshes_;
};

/// Maps a file. Throws InputError as FrozenScene, and where files that it was made from have
/// changed since, which are named, unless that is allowed.
[[nodiscard]] std::unique_ptr<FrozenScene> open_frozen_scene(const std::string& path,
                                                             bool stale_allowed);

}  // namespace lightwalk
