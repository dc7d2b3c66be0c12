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
    /// Of the scene itself, where it is a changed one: modifiers in place of the model's, and
    /// behind these others, whose ids begin at `added_base`.
    std::shared_ptr<const std::vector<Primitive>> changed;
    std::int32_t added_base = 0;

    [[nodiscard]] const Model& contents() const { return mesh ? mesh->materials : *model; }
    [[nodiscard]] const std::vector<Primitive>& modifiers() const {
        return changed ? *changed : contents().modifiers;
    }
    /// The id of one of its modifiers, or kVoid.
    [[nodiscard]] ModifierId global(std::int32_t local) const {
        if (local < 0) return kVoid;
        const auto own = static_cast<std::int32_t>(contents().modifiers.size());
        return ModifierId{local < own ? modifier_base + local : added_base + local - own};
    }
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
    /// Take over what is compiled in the table of the scene that this one is a change of, as far
    /// as it is the same here.
    void adopt(const ModifierTable& base);
    /// Compile the modifier, its chain and everything it names, earlier definitions first.
    void use(ModifierId id);
    /// Compile what `use` marked and is not compiled yet; throws InputError for a bad modifier.
    void compile(FindModifierFactory modifier_factory, Resources& resources, WarningSink& warnings,
                 const TaskRunner& task_runner);

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
    void add(const LoadedModel& loaded, std::size_t first, std::size_t last);
    void compile(ModifierId id, FindModifierFactory modifier_factory, Resources& resources,
                 TransformMemo& transforms, WarningSink& warnings);
    [[nodiscard]] MaterialTraits material_traits(ModifierId material) const;

    std::vector<ModifierRecord> records_;
    std::vector<bool> used_;
    FunctionEnvironment functions_;
    bool has_antimatter_ = false;
};

}  // namespace lightwalk
