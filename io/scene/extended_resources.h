#pragma once
// The library files of a frozen scene to which scene files were added.
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/model/resources.h"
#include "io/scene/frozen_scene.h"

namespace lightwalk {

/// Files that the frozen scene needed are those that it holds; others come from where the added
/// files find them. For one thread.
class ExtendedResources final : public Resources {
  public:
    ExtendedResources(std::unique_ptr<FrozenScene> base, std::unique_ptr<Resources> added);

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
    void prepare(std::span<const NamedFile> files, const TaskRunner& task_runner) override;

  private:
    std::unique_ptr<FrozenScene> base_;
    std::unique_ptr<Resources> added_;
};

}  // namespace lightwalk
