#include <algorithm>
#include <set>
#include <utility>

#include "core/scene/scene_tables.h"

namespace lightwalk {
namespace {

constexpr std::size_t kMaxNesting = 64;  ///< instances inside instances

}  // namespace

ModelLoader::ModelLoader(std::shared_ptr<const Model> scene, Resources& resources,
                         const TaskRunner& task_runner)
    : resources_(resources), task_runner_(task_runner) {
    LoadedModel root;
    root.model = std::move(scene);
    models.push_back(std::move(root));
    load_children(0, 0);
    std::int32_t modifiers = 0;
    for (LoadedModel& m : models) {
        m.modifier_base = modifiers;
        modifiers += static_cast<std::int32_t>(m.contents().modifiers.size());
    }
}

std::uint32_t ModelLoader::load(const SurfacePrimitive& placement, std::size_t depth) {
    const std::string type(to_string(placement.type)), name(placement.name);
    if (placement.strings.empty()) {
        throw InputError(placement.where(), type + " \"" + name +
                                                "\": bad number of arguments: "
                                                "the name of a file is missing");
    }
    const std::string file(placement.strings[0]), key = type + " " + file;
    if (std::find(open_.begin(), open_.end(), key) != open_.end()) {
        throw InputError(placement.where(), key + ": contains itself");
    }
    if (depth > kMaxNesting)
        throw InputError(placement.where(), key + ": instances nested too deeply");
    if (const auto known = loaded_.find(key); known != loaded_.end()) return known->second;

    LoadedModel loaded;
    try {
        if (placement.type == PrimitiveType::mesh) {
            loaded.mesh = resources_.mesh(file);
        } else {
            loaded.model = resources_.octree(file);
        }
    } catch (const InputError& error) {
        throw InputError(placement.where(), type + " \"" + name + "\": " + error.what());
    }
    const auto id = static_cast<std::uint32_t>(models.size());
    models.push_back(std::move(loaded));
    loaded_.emplace(key, id);
    open_.push_back(key);
    load_children(id, depth);
    open_.pop_back();
    return id;
}

void ModelLoader::load_children(std::uint32_t model, std::size_t depth) {
    if (models[model].mesh) return;
    const std::shared_ptr<const Model> contents = models[model].model;  // `models` grows below
    const SurfaceList& surfaces = contents->surfaces;
    prepare_children(surfaces);
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        if (!is_placement(surfaces.type(i))) continue;
        const std::uint32_t child = load(surfaces[i], depth + 1);
        models[model].children.push_back(child);
    }
}

void ModelLoader::prepare_children(const SurfaceList& surfaces) {
    std::vector<NamedFile> files;
    std::set<std::string> seen;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        if (!is_placement(surfaces.type(i))) continue;
        const SurfacePrimitive placement = surfaces[i];
        if (placement.strings.empty()) continue;
        std::string name(placement.strings[0]);
        std::string key = std::string(to_string(placement.type)) + " " + name;
        if (loaded_.contains(key) || !seen.insert(std::move(key)).second) continue;
        files.push_back({placement.type == PrimitiveType::mesh ? NamedFile::Kind::mesh
                                                               : NamedFile::Kind::octree,
                         std::move(name)});
    }
    resources_.prepare(files, task_runner_);
}

}  // namespace lightwalk
