#include "core/scene/scene.h"

#include <algorithm>

#include "core/model/transform_args.h"
#include "core/scene/scene_tables.h"

namespace lightwalk {

struct Scene::Impl {
    /// Surfaces that come from no file: with a name, but without shapes.
    struct MadeSurfaces {
        MadeSurfaces(PrimitiveType type, const char* name, std::int32_t modifier) {
            list.add({type, modifier, name, {}, {}, nullptr, 0});
            SurfaceShapes::Columns columns;
            columns.rows.push_back({{}, modifier, type, ShapeKind::none, {}});
            shapes = SurfaceShapes(std::move(columns));
        }
        SurfaceList list;
        SurfaceShapes shapes;
    };

    std::vector<LoadedModel> models;
    ModifierTable modifiers;
    SurfaceTable surfaces;  ///< part i is model i; the last part is the Lambertian surface
    std::vector<std::shared_ptr<const SurfaceShapes>> shapes;                ///< of the parts
    const MadeSurfaces triangles{PrimitiveType::mesh, "M-Tri", kVoidIndex};  ///< of each mesh
    const MadeSurfaces lambertian_sphere{PrimitiveType::sphere, "irradiance", 0};
    std::unique_ptr<Primitive> lambertian;  ///< replaces every opaque material in irradiance modes
    ModifierId lambertian_modifier = kVoid;
    SurfaceId lambertian_surface = kNoSurface;
    std::unique_ptr<Geometry> geometry;

    Impl(std::shared_ptr<const Model> model, Resources& resources, const TaskRunner& task_runner)
        : models(std::move(ModelLoader(std::move(model), resources, task_runner).models)),
          modifiers(models) {}

    void collect_surfaces(WarningSink& warnings, const TaskRunner& task_runner);
    void use_modifiers();
    void add_lambertian(FindModifierFactory modifier_factory, Resources& resources,
                        WarningSink& warnings);
    [[nodiscard]] ModelGeometry model_geometry(std::size_t model,
                                               const TaskRunner& task_runner) const;
    void build_geometry(const TaskRunner& task_runner, const Ablation& ablation);
};

namespace {

Transform placement_transform(const SurfacePrimitive& primitive) {
    std::vector<std::string_view> words;
    words.reserve(primitive.strings.size());
    const char* text = primitive.strings.data();
    for (std::size_t i = 0; i < primitive.strings.size(); ++i) {
        const std::string_view word = text;
        if (i > 0) words.push_back(word);  // the first is the file
        text += word.size() + 1;
    }
    const ParsedTransform parsed = parse_transform(words);
    if (parsed.words != words.size()) {
        throw InputError(primitive.where(), std::string(to_string(primitive.type)) + " \"" +
                                                std::string(primitive.name) +
                                                "\": bad transform at \"" +
                                                std::string(words[parsed.words]) + "\"");
    }
    return parsed.transform;
}

/// Whether an octree's cube is still that of the scene: surfaces added to it may lie outside.
bool is_whole(const ModelCube& cube, const Bounds& bounds) {
    if (cube.holds_all || bounds.empty()) return true;
    const Vec3 &a = bounds.lower, &b = bounds.upper;
    return a.x >= cube.x && a.y >= cube.y && a.z >= cube.z && b.x <= cube.x + cube.size &&
           b.y <= cube.y + cube.size && b.z <= cube.z + cube.size;
}

}  // namespace

void Scene::Impl::collect_surfaces(WarningSink& warnings, const TaskRunner& task_runner) {
    for (const LoadedModel& loaded : models) {
        if (loaded.mesh) {
            surfaces.add(triangles.list, triangles.shapes, loaded.modifier_base);
            continue;
        }
        const Model& model = *loaded.model;
        shapes.push_back(model.shapes ? model.shapes
                                      : std::make_shared<const SurfaceShapes>(
                                            make_shapes(model.surfaces, task_runner)));
        for (const std::string& warning : shapes.back()->columns().warnings) warnings.warn(warning);
        surfaces.add(model.surfaces, *shapes.back(), loaded.modifier_base);
    }
}

void Scene::Impl::use_modifiers() {
    for (std::size_t m = 0; m < surfaces.part_count(); ++m) {
        const SurfacePart& part = surfaces.part(m);
        ModifierId last =
            kVoid;  // most of millions of surfaces have the modifier of the preceding one
        for (std::size_t i = 0; i < part.list->size(); ++i) {
            if (part.modifier(i) != last) modifiers.use(last = part.modifier(i));
        }
    }
    for (const LoadedModel& loaded : models) {
        if (!loaded.mesh) continue;
        for (const MeshModel::Triangle& triangle : loaded.mesh->triangles) {
            if (triangle.material >= 0)
                modifiers.use(ModifierId{loaded.modifier_base + triangle.material});
        }
    }
}

void Scene::Impl::add_lambertian(FindModifierFactory modifier_factory, Resources& resources,
                                 WarningSink& warnings) {
    lambertian = std::make_unique<Primitive>();
    lambertian->type = PrimitiveType::plastic;
    lambertian->name = "irradiance";
    lambertian->reals = {kPi, kPi, kPi, 0, 0};
    FunctionEnvironment functions;
    const ModifierBuild build{*lambertian,
                              kVoid,
                              kVoid,
                              resources,
                              functions,
                              warnings,
                              [](std::size_t) { return kVoid; },
                              [](std::size_t) { return true; },
                              [](ModifierId) { return false; }};
    ModifierRecord record;
    record.type = lambertian->type;
    record.name = lambertian->name;
    record.primitive = lambertian.get();
    record.node = modifier_factory(lambertian->type)(build);
    lambertian_modifier = modifiers.add(std::move(record));
    const std::size_t part =
        surfaces.add(lambertian_sphere.list, lambertian_sphere.shapes, index(lambertian_modifier));
    lambertian_surface = surfaces.part(part).id(0);  // not flat, and not in the geometry
}

ModelGeometry Scene::Impl::model_geometry(std::size_t model, const TaskRunner& task_runner) const {
    const LoadedModel& loaded = models[model];
    const SurfacePart& own = surfaces.part(model);
    ModelGeometry geometry_of;
    geometry_of.part = model;
    if (loaded.mesh) {
        MeshPart part;
        part.mesh = loaded.mesh.get();
        part.surface = own.id(0);
        for (std::size_t i = 0; i < loaded.mesh->materials.modifiers.size(); ++i) {
            part.materials.push_back(
                ModifierId{loaded.modifier_base + static_cast<std::int32_t>(i)});
            part.traits.push_back(modifiers.traits(part.materials.back()));
        }
        geometry_of.meshes.push_back(std::move(part));
        return geometry_of;
    }
    if (const std::optional<ModelCube>& cube = loaded.model->cube) {
        const Vec3 corner{cube->x, cube->y, cube->z};
        geometry_of.cube = Bounds{corner, corner + Vec3{cube->size, cube->size, cube->size}};
    }
    const SurfaceList& list = *own.list;
    std::vector<std::size_t> placed;
    for (std::size_t i = 0; i < list.size(); ++i) {
        if (!is_placement(list.type(i))) continue;
        geometry_of.placements.push_back(
            {loaded.children[placed.size()], {}, own.id(i), own.modifier(i) != kVoid});
        placed.push_back(i);
    }
    // Number of placements parsed in one task: a tree has tens of thousands.
    constexpr std::size_t kTogether = 512;
    const auto place = [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < std::min(last, placed.size()); ++i)
            geometry_of.placements[i].transform = placement_transform(list[placed[i]]);
    };
    try {
        task_runner.run((placed.size() + kTogether - 1) / kTogether,
                        [&](std::size_t part) { place(part * kTogether, (part + 1) * kTogether); });
    } catch (const InputError&) {
        place(0, placed.size());  // which throws for the first that is wrong
        throw;
    }
    return geometry_of;
}

void Scene::Impl::build_geometry(const TaskRunner& task_runner, const Ablation& ablation) {
    GeometryInput input;
    input.surfaces = &surfaces;
    input.ablation = ablation;
    for (std::size_t i = 0; i < models.size(); ++i)
        input.models.push_back(model_geometry(i, task_runner));
    geometry = std::make_unique<Geometry>(std::move(input), std::string(), task_runner);
}

Scene::Scene(std::shared_ptr<const Model> model, FindModifierFactory modifier_factory,
             Resources& resources, WarningSink& warnings, const TaskRunner& task_runner,
             SceneExtent extent, const Ablation& ablation)
    : impl_(std::make_unique<Impl>(std::move(model), resources, task_runner)) {
    impl_->collect_surfaces(warnings, task_runner);
    impl_->use_modifiers();
    impl_->modifiers.compile(impl_->models, modifier_factory, resources, warnings, task_runner);
    impl_->add_lambertian(modifier_factory, resources, warnings);
    impl_->surfaces.set_traits(impl_->modifiers.all_traits());
    if (extent != SceneExtent::whole) return;
    impl_->build_geometry(task_runner, ablation);
    const std::optional<ModelCube>& cube = this->model().cube;
    if (cube && !is_whole(*cube, geometry().bounds()))
        warnings.warn(
            "the octree's cube does not hold what was added to it: the cube of all surfaces is "
            "taken, as of scene files");
}

Scene::~Scene() = default;

const Geometry& Scene::geometry() const {
    return *impl_->geometry;
}
const SurfaceTable& Scene::surfaces() const {
    return impl_->surfaces;
}
std::size_t Scene::own_surfaces() const {
    return impl_->models[0].model->surfaces.size();
}
const ModifierRecord& Scene::modifier(ModifierId id) const {
    return impl_->modifiers[id];
}
std::size_t Scene::modifier_count() const {
    return impl_->modifiers.size();
}
const Model& Scene::model() const {
    return *impl_->models[0].model;
}
std::shared_ptr<const SurfaceShapes> Scene::shapes_of(const Model& model) const {
    std::size_t part = 0;  // meshes have none
    for (const LoadedModel& loaded : impl_->models) {
        if (loaded.mesh) continue;
        if (loaded.model.get() == &model) return impl_->shapes[part];
        ++part;
    }
    return nullptr;
}
std::optional<ModifierId> Scene::material_of(ModifierId first) const {
    return impl_->modifiers.material_of(first);
}
bool Scene::is_transparent(ModifierId first) const {
    return impl_->modifiers.is_transparent(first);
}
bool Scene::has_antimatter() const {
    return impl_->modifiers.has_antimatter();
}
ModifierId Scene::lambertian() const {
    return impl_->lambertian_modifier;
}
SurfaceId Scene::lambertian_surface() const {
    return impl_->lambertian_surface;
}

SceneMemory Scene::memory() const {
    SceneMemory memory;
    memory.search = impl_->geometry->memory();
    for (std::size_t i = 0; i < impl_->models.size(); ++i) {
        const SurfacePart& part = impl_->surfaces.part(i);
        memory.surfaces += part.list->own_bytes();
        memory.shapes += part.shapes->own_bytes();
        memory.mapped += part.list->mapped_bytes() + part.shapes->mapped_bytes();
        if (const MeshModel* mesh = impl_->models[i].mesh.get()) {
            memory.meshes += mesh->own_bytes();
            memory.triangle_count += mesh->triangles.size();
        } else {
            memory.surface_count += part.list->size();
        }
    }
    return memory;
}

SceneCube Scene::cube() const {
    const Bounds bounds = impl_->geometry->bounds();
    const std::optional<ModelCube>& octree = model().cube;
    if (octree && is_whole(*octree, bounds))
        return {{octree->x, octree->y, octree->z}, octree->size};
    if (bounds.empty()) return {};
    constexpr double kMargin = 1e-5;  // [m], on each side
    const Vec3 size = bounds.upper - bounds.lower;
    const double edge = std::max({size.x, size.y, size.z}) + 2 * kMargin;
    const Vec3 middle = (bounds.lower + bounds.upper) * 0.5;
    return {middle - Vec3{edge, edge, edge} * 0.5, edge};
}

}  // namespace lightwalk
