#pragma once
// The tables of a scene while it is built: models in use, modifiers and surfaces of all of them.
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/function/environment.h"
#include "core/geometry/geometry.h"
#include "core/model/resources.h"
#include "core/scene/modifier.h"

namespace lightwalk {

/// One model in use: the scene itself, an octree, or a mesh. Its modifier i has the global id
/// modifier_base + i.
struct LoadedModel {
    std::shared_ptr<const Model> model;     ///< the scene or an octree
    std::shared_ptr<const MeshModel> mesh;  ///< or a mesh, whose materials are its model
    std::int32_t modifier_base = 0;
    std::vector<std::uint32_t> children;  ///< model of each instance or mesh primitive, in order
    [[nodiscard]] const Model& contents() const { return mesh ? mesh->materials : *model; }
};

/// Loads every model that the scene places, each once; rejects circular and too deeply nested
/// instances.
class ModelLoader {
  public:
    ModelLoader(std::shared_ptr<const Model> scene, Resources& resources,
                const TaskRunner& task_runner);
    std::vector<LoadedModel> models;  ///< models[0] is the scene

  private:
    std::uint32_t load(const SurfacePrimitive& placement, std::size_t depth);
    void load_children(std::uint32_t model, std::size_t depth);
    /// Request the decoding of the files that a model places and that are not loaded yet.
    void prepare_children(const SurfaceList& surfaces);
    Resources& resources_;
    const TaskRunner& task_runner_;
    std::map<std::string, std::uint32_t> loaded_;  ///< "instance NAME" / "mesh NAME"
    std::vector<std::string> open_;                ///< being loaded, outermost first
};

/// All modifiers of all models, by global id; compiled on demand.
class ModifierTable {
  public:
    explicit ModifierTable(const std::vector<LoadedModel>& models);
    /// Compile the modifier, its chain and everything it names, earlier definitions first.
    void use(ModifierId id);
    /// Compile what `use` marked; throws InputError for a bad modifier.
    void compile(const std::vector<LoadedModel>& models, FindModifierFactory modifier_factory,
                 Resources& resources, WarningSink& warnings, const TaskRunner& task_runner);

    [[nodiscard]] const ModifierRecord& operator[](ModifierId id) const {
        return records_[static_cast<std::size_t>(index(id))];
    }
    [[nodiscard]] std::size_t size() const { return records_.size(); }
    [[nodiscard]] std::optional<ModifierId> material_of(ModifierId first) const;
    [[nodiscard]] bool is_transparent(ModifierId first) const;
    [[nodiscard]] SurfaceTraits traits(ModifierId first) const;
    /// The surface traits of each modifier that is in use.
    [[nodiscard]] ModifierTraits all_traits() const;
    [[nodiscard]] bool has_antimatter() const { return has_antimatter_; }
    /// Add a modifier that comes from no file; returns its id.
    ModifierId add(ModifierRecord record);

  private:
    /// The pictures that modifiers in use name, each once.
    [[nodiscard]] std::vector<NamedFile> pictures() const;
    [[nodiscard]] MaterialTraits material_traits(ModifierId material) const;

    std::vector<ModifierRecord> records_;
    std::vector<bool> used_;
    FunctionEnvironment functions_;
    bool has_antimatter_ = false;
};

}  // namespace lightwalk
