#include "io/scene/extended_resources.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace lightwalk {
namespace {

/// What the frozen scene says, or of a file that it did not need what `added` says.
template <class Ask>
auto first_of(Resources& base, Resources& added, const Ask& ask) {
    try {
        return ask(base);
    } catch (const NotFrozen&) {
        return ask(added);
    }
}

}  // namespace

ExtendedResources::ExtendedResources(std::unique_ptr<FrozenScene> base,
                                     std::unique_ptr<Resources> added)
    : base_(std::move(base)), added_(std::move(added)) {}

std::string ExtendedResources::function_file(const std::string& name) {
    return first_of(*base_, *added_, [&](Resources& files) { return files.function_file(name); });
}

std::shared_ptr<const DataArray> ExtendedResources::data(const std::string& name) {
    return first_of(*base_, *added_, [&](Resources& files) { return files.data(name); });
}

std::shared_ptr<const PictureData> ExtendedResources::picture(const std::string& name) {
    return first_of(*base_, *added_, [&](Resources& files) { return files.picture(name); });
}

std::shared_ptr<const SpectralPicture> ExtendedResources::spectral_picture(
    const std::string& name) {
    return first_of(*base_, *added_,
                    [&](Resources& files) { return files.spectral_picture(name); });
}

std::shared_ptr<const Bsdf> ExtendedResources::bsdf(const std::string& name) {
    return first_of(*base_, *added_, [&](Resources& files) { return files.bsdf(name); });
}

std::shared_ptr<const Font> ExtendedResources::font(const std::string& name) {
    return first_of(*base_, *added_, [&](Resources& files) { return files.font(name); });
}

std::vector<std::string> ExtendedResources::text_lines(const std::string& name) {
    return first_of(*base_, *added_, [&](Resources& files) { return files.text_lines(name); });
}

std::shared_ptr<const Model> ExtendedResources::octree(const std::string& name) {
    return first_of(*base_, *added_, [&](Resources& files) { return files.octree(name); });
}

std::shared_ptr<const MeshModel> ExtendedResources::mesh(const std::string& name) {
    return first_of(*base_, *added_, [&](Resources& files) { return files.mesh(name); });
}

void ExtendedResources::prepare(std::span<const NamedFile> files, const TaskRunner& task_runner) {
    std::vector<NamedFile> unknown;
    std::ranges::copy_if(files, std::back_inserter(unknown),
                         [&](const NamedFile& file) { return !base_->knows(file); });
    added_->prepare(unknown, task_runner);
}

}  // namespace lightwalk
