#pragma once
// The Resources of a scene, read from files along the library path and cached by name.
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/model/resources.h"
#include "io/files/library_path.h"

namespace lightwalk {

/// For one thread: a scene is built by one. Relative names, also those inside an octree that is not
/// frozen, are seen from `path`'s base directory.
class FileResources final : public Resources {
  public:
    FileResources(LibraryPath path, bool allow_commands, WarningSink& warnings);
    [[nodiscard]] std::string function_file(const std::string& name) override;
    [[nodiscard]] std::shared_ptr<const DataArray> data(const std::string& name) override;
    /// Where NAME.pic is not there NAME.hdr is taken, and the other way round.
    [[nodiscard]] std::shared_ptr<const PictureData> picture(const std::string& name) override;
    [[nodiscard]] std::shared_ptr<const Font> font(const std::string& name) override;
    /// Lines longer than 511 bytes are broken there; the last line end is optional.
    [[nodiscard]] std::vector<std::string> text_lines(const std::string& name) override;
    [[nodiscard]] std::shared_ptr<const Model> octree(const std::string& name) override;
    [[nodiscard]] std::shared_ptr<const MeshModel> mesh(const std::string& name) override;
    /// Reads one after the other, a bounded number of bytes at a time, and decodes side by side.
    /// Octrees that are not frozen are left for later.
    void prepare(std::span<const NamedFile> files, const TaskRunner& task_runner) override;
    [[nodiscard]] const LibraryPath& path() const { return path_; }

  private:
    struct Reading;
    [[nodiscard]] bool is_known(const NamedFile& file) const;
    /// Nothing where there is none, or it cannot be read.
    [[nodiscard]] std::optional<Reading> read(const NamedFile& file);
    void decode(std::span<Reading> readings, const TaskRunner& task_runner);

    LibraryPath path_;
    bool allow_commands_;
    WarningSink& warnings_;
    std::map<std::string, std::shared_ptr<const DataArray>> data_;
    std::map<std::string, std::shared_ptr<const PictureData>> pictures_;
    std::map<std::string, std::shared_ptr<const Font>> fonts_;
    std::map<std::string, std::shared_ptr<const Model>> octrees_;
    std::map<std::string, std::shared_ptr<const MeshModel>> meshes_;
};

}  // namespace lightwalk
