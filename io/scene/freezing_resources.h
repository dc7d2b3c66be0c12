#pragma once
// Records the library files that a scene asks for while it is compiled: what a frozen scene has to
// hold.
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/model/resources.h"

namespace lightwalk {

/// The answer to a question: a value, or the message that the file is missing.
template <class T>
struct ResourceAnswer {
    std::optional<T> found;
    std::string missing;
};
template <class T>
using ResourceAnswers = std::map<std::string, ResourceAnswer<T>>;  ///< by the name asked for

/// A decorator of Resources that records all answers. Missing files are recorded as well; other
/// errors are not. For one thread.
class FreezingResources final : public Resources {
  public:
    /// @param source  must outlive it
    explicit FreezingResources(Resources& source) : source_(source) {}

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
    void prepare(std::span<const NamedFile> files, const TaskRunner& task_runner) override {
        source_.prepare(files, task_runner);
    }

    struct Answers {
        ResourceAnswers<std::string> functions;
        ResourceAnswers<std::shared_ptr<const DataArray>> tables;
        ResourceAnswers<std::shared_ptr<const PictureData>> pictures;
        ResourceAnswers<std::shared_ptr<const SpectralPicture>> spectral_pictures;
        ResourceAnswers<std::shared_ptr<const Bsdf>> bsdfs;
        ResourceAnswers<std::shared_ptr<const Font>> fonts;
        ResourceAnswers<std::vector<std::string>> texts;
        ResourceAnswers<std::shared_ptr<const Model>> octrees;
        ResourceAnswers<std::shared_ptr<const MeshModel>> meshes;
    };
    [[nodiscard]] const Answers& answers() const { return answers_; }

  private:
    Resources& source_;
    Answers answers_;
};

}  // namespace lightwalk
