#include "io/scene/freezing_resources.h"

#include "core/error.h"

namespace lightwalk {
namespace {

/// The remembered answer, or what `ask` says now.
template <class T, class Ask>
T remembered(ResourceAnswers<T>& answers, const std::string& name, const Ask& ask) {
    auto known = answers.find(name);
    if (known == answers.end()) {
        ResourceAnswer<T> answer;
        try {
            answer.found = ask();
        } catch (const MissingFile& missing) {
            answer.missing = missing.what();
        }
        known = answers.emplace(name, std::move(answer)).first;
    }
    if (!known->second.found) throw MissingFile(known->second.missing);
    return *known->second.found;
}

}  // namespace

std::string FreezingResources::function_file(const std::string& name) {
    return remembered(answers_.functions, name, [&] { return source_.function_file(name); });
}

std::shared_ptr<const DataArray> FreezingResources::data(const std::string& name) {
    return remembered(answers_.tables, name, [&] { return source_.data(name); });
}

std::shared_ptr<const PictureData> FreezingResources::picture(const std::string& name) {
    return remembered(answers_.pictures, name, [&] { return source_.picture(name); });
}

std::shared_ptr<const SpectralPicture> FreezingResources::spectral_picture(
    const std::string& name) {
    return remembered(answers_.spectral_pictures, name,
                      [&] { return source_.spectral_picture(name); });
}

std::shared_ptr<const Bsdf> FreezingResources::bsdf(const std::string& name) {
    return remembered(answers_.bsdfs, name, [&] { return source_.bsdf(name); });
}

std::shared_ptr<const Font> FreezingResources::font(const std::string& name) {
    return remembered(answers_.fonts, name, [&] { return source_.font(name); });
}

std::vector<std::string> FreezingResources::text_lines(const std::string& name) {
    return remembered(answers_.texts, name, [&] { return source_.text_lines(name); });
}

std::shared_ptr<const Model> FreezingResources::octree(const std::string& name) {
    return remembered(answers_.octrees, name, [&] { return source_.octree(name); });
}

std::shared_ptr<const MeshModel> FreezingResources::mesh(const std::string& name) {
    return remembered(answers_.meshes, name, [&] { return source_.mesh(name); });
}

}  // namespace lightwalk
