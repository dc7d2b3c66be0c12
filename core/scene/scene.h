#pragma once
// The immutable scene: surfaces, compiled modifiers, ray casting. Built once, then read by every
// thread.
#include <memory>
#include <optional>
#include <vector>

#include "core/geometry/geometry.h"
#include "core/math/task_runner.h"
#include "core/model/model_change.h"
#include "core/model/resources.h"
#include "core/model/surface_keys.h"
#include "core/scene/modifier.h"

namespace lightwalk {

/// The scene's bounding cube, as Radiance's octree has it.
struct SceneCube {
    Vec3 origin;
    double size = 0;  ///< edge [m]; 0 when nothing is finite
};

/// Memory of a scene by kind [bytes]. Modifiers are few, and not counted.
struct SceneMemory {
    std::size_t surfaces = 0;  ///< as they were read: numbers, names, places
    std::size_t shapes = 0;
    std::size_t meshes = 0;
    SearchMemory search;
    std::size_t mapped = 0;  ///< parts of a mapped file, which processes share
    std::size_t surface_count = 0, triangle_count = 0;
};

/// Which parts of a scene are built.
enum class SceneExtent {
    whole,
    without_search,  ///< no search tree, so that no ray can be cast: for a scene that is only
                     ///< written to a file
};

/// A change of modifiers that is one of the geometry, too: what is opaque or clear to shadow rays,
/// and which of coincident surfaces is seen, is decided by the search for hits. The changed scene
/// has to be built as a whole (changed_model).
class GeometryChange : public InputError {
  public:
    using InputError::InputError;
};

/// Where a source of a changed scene stands, see PlacedSource.
struct SourcePlace {
    std::size_t before = 0;
    SurfaceId id = kNoSurface;
};

class Scene {
  public:
    /// Resolve, compile and freeze. Only modifiers that some surface uses are compiled; errors in
    /// others are never reported. `modifier_factory` must know plastic. Throws InputError for bad
    /// surfaces, bad used modifiers, missing octrees and meshes, circular instances. A file that a
    /// modifier names and that does not exist is a warning here, and an InputError when a ray needs
    /// it. `model` and what `resources` hands out are kept alive by the scene. `task_runner` runs
    /// independent parts of the work. `keys`: of the surfaces, where a walk has known them before.
    Scene(std::shared_ptr<const Model> model, FindModifierFactory modifier_factory,
          Resources& resources, WarningSink& warnings,
          const TaskRunner& task_runner = SerialTaskRunner(),
          SceneExtent extent = SceneExtent::whole, const Ablation& ablation = {},
          SurfaceKeys keys = {});
    /// The same surfaces under other modifiers and sources: shapes, search tree, meshes, octrees
    /// and whatever of the modifiers is as before are those of `base`, and only the rest is
    /// compiled. Rays find to the bit what they find in Scene(changed_model(...), ...).
    /// Ids of the base's modifiers and surfaces mean the same here; its sources have others.
    /// Throws InputError for bad modifiers, GeometryChange for what the base's geometry excludes.
    /// @param base    may itself be such a scene. It is kept alive
    /// @param change  of model()
    Scene(std::shared_ptr<const Scene> base, ModelChange change,
          FindModifierFactory modifier_factory, Resources& resources, WarningSink& warnings,
          const TaskRunner& task_runner = SerialTaskRunner());
    ~Scene();
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    [[nodiscard]] const Geometry& geometry() const;
    [[nodiscard]] const SurfaceTable& surfaces()
        const;  ///< all models; the scene's own come first, in order
    [[nodiscard]] std::size_t own_surfaces() const;  ///< how many of them are the scene's own
    /// Of a changed scene: the sources at infinity that take the place of its own surfaces of
    /// that type; null: these are as they were read.
    [[nodiscard]] const std::vector<SourcePlace>* changed_sources() const;
    [[nodiscard]] Surface surface(SurfaceId id) const { return surfaces()[id]; }
    /// By which the points of walks know it.
    [[nodiscard]] std::uint32_t surface_key(SurfaceId id) const;
    [[nodiscard]] const ModifierRecord& modifier(ModifierId id) const;  ///< id != kVoid
    [[nodiscard]] std::size_t modifier_count() const;
    /// As it was read: of a changed scene the base's.
    [[nodiscard]] const Model& model() const;
    /// The scene's own modifiers, by their indices in the model; of a changed scene as they are
    /// now.
    [[nodiscard]] const std::vector<Primitive>& own_modifiers() const;
    [[nodiscard]] SceneCube cube() const;
    [[nodiscard]] SceneMemory memory() const;
    /// The shapes of the surfaces of one of the scene's models, the scene's own or a placed one;
    /// null for any other model.
    [[nodiscard]] std::shared_ptr<const SurfaceShapes> shapes_of(const Model& model) const;

    /// The material at the end of a modifier's chain: first material or mixture met; nothing when
    /// there is none.
    [[nodiscard]] std::optional<ModifierId> material_of(ModifierId first) const;
    /// Whether that material is nominally transparent (MaterialTraits).
    [[nodiscard]] bool is_transparent(ModifierId first) const;
    /// Whether any antimatter is in use: surfaces can then be cut away.
    [[nodiscard]] bool has_antimatter() const;
    /// White diffuse plastic of reflectance π, which irradiance modes put in place of opaque
    /// materials (its radiance is then the irradiance), and a surface of it that no ray can hit.
    [[nodiscard]] ModifierId lambertian() const;
    [[nodiscard]] SurfaceId lambertian_surface() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace lightwalk
