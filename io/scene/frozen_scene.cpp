#include "io/scene/frozen_scene.h"

#include <algorithm>
#include <cassert>
#include <filesystem>
#include <utility>

#include "core/bsdf/bsdf.h"
#include "core/error.h"
#include "io/formats/packed.h"
#include "io/scene/frozen_bsdf.h"
#include "io/scene/frozen_model.h"
#include "io/scene/frozen_resources.h"
#include "io/scene/named_files.h"

namespace lightwalk {
namespace {

constexpr std::uint32_t kRootModel = 0;
constexpr std::size_t kChangesTold = 5;

// Answers: for each kind their number; then name, whether it was found, and the message that it
// was not, or text, or lines. Those that are parts have their numbers in order, from 0; models from
// 1, as the scene is number 0.

void pack_answer(PackedWriter& writer, const std::string& text) {
    writer.text(text);
}
void pack_answer(PackedWriter& writer, const std::vector<std::string>& lines) {
    writer.texts(lines);
}
template <class T>
void pack_answer(PackedWriter&, const std::shared_ptr<const T>&) {}  // a part

template <class T>
void pack_answers(PackedWriter& writer, const ResourceAnswers<T>& answers) {
    writer.count(answers.size());
    for (const auto& [name, answer] : answers) {
        writer.text(name);
        writer.boolean(answer.found.has_value());
        if (answer.found)
            pack_answer(writer, *answer.found);
        else
            writer.text(answer.missing);
    }
}

/// Reads one after the other; `next` is the number of the next part.
struct AnswerReader {
    PackedReader& reader;
    std::uint32_t next = 0;

    void read(std::string& text) { text = reader.text(); }
    void read(std::vector<std::string>& lines) { lines = reader.texts(); }
    void read(std::uint32_t& part) { part = next++; }

    template <class T>
    ResourceAnswers<T> answers() {
        ResourceAnswers<T> all;
        constexpr std::size_t kLeastAnswer = 8 + 1;  // [bytes]
        for (std::size_t left = reader.count(kLeastAnswer); left > 0; --left) {
            std::string name = reader.text();
            ResourceAnswer<T> answer;
            if (reader.boolean())
                read(answer.found.emplace());
            else
                answer.missing = reader.text();
            if (!all.emplace(std::move(name), std::move(answer)).second) reader.fail();
        }
        return all;
    }
};

/// Calls freeze(value, number) for all that were found.
template <class T, class Freeze>
void freeze_found(const ResourceAnswers<std::shared_ptr<const T>>& answers, std::uint32_t first,
                  const Freeze& freeze) {
    for (const auto& [name, answer] : answers) {
        if (answer.found) freeze(**answer.found, first++);
    }
}

void freeze_answers(const FreezingResources::Answers& answers, FrozenParts& parts) {
    PackedWriter writer;
    pack_answers(writer, answers.functions);
    pack_answers(writer, answers.texts);
    pack_answers(writer, answers.tables);
    pack_answers(writer, answers.pictures);
    pack_answers(writer, answers.spectral_pictures);
    pack_answers(writer, answers.bsdfs);
    pack_answers(writer, answers.fonts);
    pack_answers(writer, answers.octrees);
    pack_answers(writer, answers.meshes);
    parts.add(FrozenKind::answers, 0, writer.bytes());
    freeze_found(answers.tables, 0, [&](const DataArray& data, std::uint32_t number) {
        freeze_data(data, number, parts);
    });
    freeze_found(answers.pictures, 0, [&](const PictureData& picture, std::uint32_t number) {
        freeze_picture(picture, number, parts);
    });
    freeze_found(answers.spectral_pictures, 0,
                 [&](const SpectralPicture& picture, std::uint32_t number) {
                     freeze_spectral_picture(picture, number, parts);
                 });
    freeze_found(answers.bsdfs, 0, [&](const Bsdf& bsdf, std::uint32_t number) {
        freeze_bsdf(bsdf.data(), number, parts);
    });
    freeze_found(answers.fonts, 0,
                 [&](const Font& font, std::uint32_t number) { freeze_font(font, number, parts); });
}

void freeze_manifest(std::span<const ManifestFile> manifest, FrozenParts& parts) {
    PackedWriter writer;
    writer.count(manifest.size());
    for (const ManifestFile& file : manifest) {
        writer.text(file.path);
        writer.boolean(file.exists);
        writer.number(file.size);
        writer.number(file.written);
        writer.number(file.digest);
    }
    parts.add(FrozenKind::manifest, 0, writer.bytes());
}

/// Checks that the manifest names each file once, as a recorder does, so that none is read
/// repeatedly.
bool is_in_order(std::span<const ManifestFile> manifest) {
    const auto proper = [](const ManifestFile& file) {
        return file.path.starts_with('/') &&
               std::filesystem::path(file.path).lexically_normal() == file.path;
    };
    const auto ordered = [](const ManifestFile& a, const ManifestFile& b) {
        return a.path >= b.path;
    };
    return std::ranges::all_of(manifest, proper) &&
           std::ranges::adjacent_find(manifest, ordered) == manifest.end();
}

std::vector<ManifestFile> map_manifest(const FrozenFile& file) {
    constexpr std::size_t kLeastEntry = 8 + 1 + 3 * 8;  // [bytes]
    PackedReader reader(part_of(file, FrozenKind::manifest), file.name(), "the list of its files");
    std::vector<ManifestFile> manifest(reader.count(kLeastEntry));
    for (ManifestFile& entry : manifest) {
        entry.path = reader.text();
        entry.exists = reader.boolean();
        entry.size = reader.number<std::uint64_t>();
        entry.written = reader.number<std::int64_t>();
        entry.digest = reader.number<std::uint64_t>();
    }
    reader.end();
    if (!is_in_order(manifest)) reader.fail();
    return manifest;
}

FrozenParts freeze_scene(const Scene& scene, const FreezingResources& library,
                         std::span<const ManifestFile> manifest) {
    FrozenParts parts;
    freeze_manifest(manifest, parts);
    freeze_answers(library.answers(), parts);
    const auto freeze = [&](const Model& model, std::uint32_t number) {
        const auto shapes = scene.shapes_of(model);
        assert(shapes);  // the scene has asked for it
        freeze_model(model, *shapes, number, parts);
    };
    freeze(scene.model(), kRootModel);
    freeze_found(library.answers().octrees, kRootModel + 1, freeze);
    freeze_found(library.answers().meshes, 0, [&](const MeshModel& mesh, std::uint32_t number) {
        freeze_mesh(mesh, number, parts);
    });
    return parts;
}

/// The recorded answer; throws MissingFile if the file was missing when the scene was frozen.
template <class T>
const T& frozen_answer(const FrozenFile& file, const ResourceAnswers<T>& answers,
                       const std::string& name) {
    const auto known = answers.find(name);
    if (known == answers.end()) {
        throw NotFrozen({file.name(), 0},
                        "holds no \"" + name + "\", which was not needed when it was frozen");
    }
    if (!known->second.found) throw MissingFile(known->second.missing);
    return *known->second.found;
}

/// The thing of this number, mapped once.
template <class T, class Map>
std::shared_ptr<const T> mapped_once(std::map<std::uint32_t, std::shared_ptr<const T>>& known,
                                     std::uint32_t number, const Map& map) {
    std::shared_ptr<const T>& thing = known[number];
    if (!thing) thing = map();
    return thing;
}

/// "a.rad has changed, b.cal is missing and 3 more".
std::string told(const std::vector<std::string>& changes) {
    std::string text;
    for (std::size_t i = 0; i < changes.size() && i < kChangesTold; ++i)
        text += (i > 0 ? ", " : "") + changes[i];
    if (changes.size() > kChangesTold)
        text += ", and " + std::to_string(changes.size() - kChangesTold) + " more";
    return text;
}

}  // namespace

void write_frozen_scene(const std::string& path, const Scene& scene,
                        const FreezingResources& library, std::span<const ManifestFile> manifest) {
    write_frozen_file(path, freeze_scene(scene, library, manifest).parts());
}

std::shared_ptr<const MemoryFile> share_scene(const Scene& scene,
                                              const FreezingResources& library) {
    return frozen_memory_file(freeze_scene(scene, library, {}).parts());
}

std::string frozen_scene_bytes(const Scene& scene, const FreezingResources& library,
                               std::span<const ManifestFile> manifest) {
    return frozen_file_bytes(freeze_scene(scene, library, manifest).parts());
}

bool is_frozen_scene(const std::string& path, FileSource& files) {
    if (path == "-" || path.starts_with('!') || !files.readable(path)) return false;
    const auto begin = files.answer(FileSource::Question::beginning, path, kFrozenMark.size());
    return begin && is_frozen_scene(*begin);
}

FrozenScene::FrozenScene(FrozenFile file) : file_(std::move(file)) {
    manifest_ = map_manifest(file_);
    PackedReader reader(part_of(file_, FrozenKind::answers), file_.name(), "its library");
    functions_ = AnswerReader{reader}.answers<std::string>();
    texts_ = AnswerReader{reader}.answers<std::vector<std::string>>();
    tables_ = AnswerReader{reader}.answers<std::uint32_t>();
    pictures_ = AnswerReader{reader}.answers<std::uint32_t>();
    spectral_pictures_ = AnswerReader{reader}.answers<std::uint32_t>();
    bsdfs_ = AnswerReader{reader}.answers<std::uint32_t>();
    fonts_ = AnswerReader{reader}.answers<std::uint32_t>();
    octrees_ = AnswerReader{reader, kRootModel + 1}.answers<std::uint32_t>();
    meshes_ = AnswerReader{reader}.answers<std::uint32_t>();
    reader.end();
}

std::shared_ptr<const Model> FrozenScene::model() {
    return mapped_once(mapped_models_, kRootModel, [&] { return map_model(file_, kRootModel); });
}

bool FrozenScene::knows(const NamedFile& file) const {
    return is_among(file, octrees_, meshes_, pictures_);
}

std::string FrozenScene::function_file(const std::string& name) {
    return frozen_answer(file_, functions_, name);
}

std::shared_ptr<const DataArray> FrozenScene::data(const std::string& name) {
    const std::uint32_t number = frozen_answer(file_, tables_, name);
    return mapped_once(mapped_tables_, number, [&] { return map_data(file_, number); });
}

std::shared_ptr<const PictureData> FrozenScene::picture(const std::string& name) {
    const std::uint32_t number = frozen_answer(file_, pictures_, name);
    return mapped_once(mapped_pictures_, number, [&] { return map_picture(file_, number); });
}

std::shared_ptr<const SpectralPicture> FrozenScene::spectral_picture(const std::string& name) {
    const std::uint32_t number = frozen_answer(file_, spectral_pictures_, name);
    return mapped_once(mapped_spectral_pictures_, number,
                       [&] { return map_spectral_picture(file_, number); });
}

std::shared_ptr<const Bsdf> FrozenScene::bsdf(const std::string& name) {
    const std::uint32_t number = frozen_answer(file_, bsdfs_, name);
    return mapped_once(mapped_bsdfs_, number,
                       [&] { return std::make_shared<const Bsdf>(map_bsdf(file_, number)); });
}

std::shared_ptr<const Font> FrozenScene::font(const std::string& name) {
    const std::uint32_t number = frozen_answer(file_, fonts_, name);
    return mapped_once(mapped_fonts_, number, [&] { return map_font(file_, number); });
}

std::vector<std::string> FrozenScene::text_lines(const std::string& name) {
    return frozen_answer(file_, texts_, name);
}

std::shared_ptr<const Model> FrozenScene::octree(const std::string& name) {
    const std::uint32_t number = frozen_answer(file_, octrees_, name);
    return mapped_once(mapped_models_, number, [&] { return map_model(file_, number); });
}

std::shared_ptr<const MeshModel> FrozenScene::mesh(const std::string& name) {
    const std::uint32_t number = frozen_answer(file_, meshes_, name);
    return mapped_once(mapped_meshes_, number, [&] { return map_mesh(file_, number); });
}

std::unique_ptr<FrozenScene> open_frozen_scene(const std::string& path, bool stale_allowed) {
    auto scene =
        std::make_unique<FrozenScene>(FrozenFile(std::make_shared<const MappedFile>(path)));
    if (stale_allowed) return scene;
    const std::vector<std::string> changes = changes_since(scene->manifest());
    if (!changes.empty()) {
        throw InputError({path, 0},
                         "stale: " + told(changes) + "; freeze it again, or use --stale");
    }
    return scene;
}

}  // namespace lightwalk
