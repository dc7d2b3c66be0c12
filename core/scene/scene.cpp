#include "core/scene/scene.h"

#include <algorithm>
#include <span>

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

    std::shared_ptr<const Scene> base;  ///< that this is a change of; null: it is none
    std::vector<LoadedModel> models;
    ModifierTable modifiers;
    SurfaceKeys keys;
    SurfaceTable surfaces;  ///< part i is model i; the last part is the Lambertian surface
    std::vector<std::shared_ptr<const SurfaceShapes>> shapes;                ///< of the parts
    const MadeSurfaces triangles{PrimitiveType::mesh, "M-Tri", kVoidIndex};  ///< of each mesh
    const MadeSurfaces lambertian_sphere{PrimitiveType::sphere, "irradiance", 0};
    std::unique_ptr<Primitive> lambertian;  ///< replaces every opaque material in irradiance modes
    ModifierId lambertian_modifier = kVoid;
    SurfaceId lambertian_surface = kNoSurface;
    std::shared_ptr<const Geometry> geometry;
    std::vector<bool> on_finite;           ///< by modifier: whether surfaces have it that rays hit
    std::vector<SourcePlace> new_sources;  ///< of a changed scene
    SurfaceList source_list;               ///< the same
    SurfaceShapes source_shapes;

    Impl(std::shared_ptr<const Model> model, Resources& resources, const TaskRunner& task_runner)
        : models(std::move(ModelLoader(std::move(model), resources, task_runner).models)),
          modifiers(models) {}
    Impl(std::shared_ptr<const Scene> of, ModelChange change)
        : base(std::move(of)),
          models(changed_models(base->impl_->models, std::move(change.modifiers))),
          modifiers(models),
          keys(base->impl_->keys),
          shapes(base->impl_->shapes),
          geometry(base, base->impl_->geometry.get()) {}

    static std::vector<LoadedModel> changed_models(std::vector<LoadedModel> models,
                                                   std::vector<Primitive> modifiers);
    void share_surfaces(std::span<const PlacedSource> sources, const TaskRunner& task_runner);
    void use_shared_modifiers();
    void check_traits() const;
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

/// Throws InputError where a modifier refers to one that does not come before it.
void check_change(const ModelChange& change) {
    const auto check = [](std::int32_t reference, std::size_t end, const Primitive& primitive) {
        if (reference >= 0 && static_cast<std::size_t>(reference) >= end)
            throw InputError(primitive.where, std::string(to_string(primitive.type)) + " \"" +
                                                  primitive.name +
                                                  "\": a modifier must come before what uses it");
    };
    for (std::size_t i = 0; i < change.modifiers.size(); ++i) {
        const Primitive& primitive = change.modifiers[i];
        check(primitive.modifier, i, primitive);
        for (const std::int32_t reference : primitive.references) check(reference, i, primitive);
    }
    for (const PlacedSource& source : change.sources)
        check(source.source.modifier, change.modifiers.size(), source.source);
}

bool operator!=(const SurfaceTraits& a, const SurfaceTraits& b) {
    return a.has_material != b.has_material || a.transparent != b.transparent ||
           a.shadow != b.shadow;
}

}  // namespace

/// @param models  of the base
std::vector<LoadedModel> Scene::Impl::changed_models(std::vector<LoadedModel> models,
                                                     std::vector<Primitive> modifiers) {
    const std::vector<Primitive>& own = models[0].model->modifiers;
    if (modifiers.size() < own.size())
        modifiers.insert(modifiers.end(),
                         own.begin() + static_cast<std::ptrdiff_t>(modifiers.size()), own.end());
    const LoadedModel& last = models.back();
    models[0].added_base =
        last.modifier_base + static_cast<std::int32_t>(last.contents().modifiers.size());
    models[0].changed = std::make_shared<const std::vector<Primitive>>(std::move(modifiers));
    return models;
}

/// The base's surfaces by their numbers, then the sources.
void Scene::Impl::share_surfaces(std::span<const PlacedSource> sources,
                                 const TaskRunner& task_runner) {
    auto part_shapes = shapes.begin();
    for (const LoadedModel& loaded : models) {
        if (loaded.mesh)
            surfaces.add(triangles.list, triangles.shapes, loaded.modifier_base);
        else
            surfaces.add(loaded.model->surfaces, **part_shapes++, loaded.modifier_base);
    }
    for (const PlacedSource& placed : sources) {
        Primitive source = placed.source;
        source.modifier = index(models[0].global(source.modifier));
        source_list.add(source);
    }
    source_shapes = make_shapes(source_list, task_runner);
    const std::size_t part = surfaces.add(source_list, source_shapes, 0);
    for (std::size_t i = 0; i < sources.size(); ++i)
        new_sources.push_back({sources[i].before, surfaces.part(part).id(i)});
}

void Scene::Impl::use_shared_modifiers() {
    on_finite = base->impl_->on_finite;
    for (std::size_t i = 0; i < on_finite.size(); ++i)
        if (on_finite[i]) modifiers.use(ModifierId{static_cast<std::int32_t>(i)});
    for (std::size_t i = 0; i < source_list.size(); ++i) {
        const std::int32_t modifier = source_list.modifier(i);
        if (modifier >= 0) modifiers.use(ModifierId{modifier});
    }
}

/// Throws GeometryChange where surfaces are others for the search than in the base.
void Scene::Impl::check_traits() const {
    for (std::size_t i = 0; i < on_finite.size(); ++i) {
        const ModifierId id{static_cast<std::int32_t>(i)};
        if (!on_finite[i] || !(modifiers.traits(id) != base->impl_->modifiers.traits(id))) continue;
        const ModifierRecord& record = modifiers[id];
        throw GeometryChange(record.primitive->where,
                             std::string(to_string(record.type)) + " \"" + record.name +
                                 "\": it lets light through in another way than before");
    }
}

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
    on_finite.assign(modifiers.size(), false);
    const auto use = [this](ModifierId id) {
        modifiers.use(id);
        if (id != kVoid) on_finite[static_cast<std::size_t>(index(id))] = true;
    };
    for (std::size_t m = 0; m < surfaces.part_count(); ++m) {
        const SurfacePart& part = surfaces.part(m);
        ModifierId last =
            kVoid;  // most of millions of surfaces have the modifier of the preceding one
        for (std::size_t i = 0; i < part.list->size(); ++i) {
            if (part.modifier(i) == last) continue;
            if (part.shapes->row(i).type == PrimitiveType::source)
                modifiers.use(part.modifier(i));
            else
                use(last = part.modifier(i));
        }
    }
    for (const LoadedModel& loaded : models) {
        if (!loaded.mesh) continue;
        for (const MeshModel::Triangle& triangle : loaded.mesh->triangles) {
            if (triangle.material >= 0) use(ModifierId{loaded.modifier_base + triangle.material});
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
    TransformMemo transforms;
    const ModifierBuild build{*lambertian,
                              kVoid,
                              kVoid,
                              resources,
                              functions,
                              transforms,
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
    geometry = std::make_shared<const Geometry>(std::move(input), std::string(), task_runner);
}

Scene::Scene(std::shared_ptr<const Model> model, FindModifierFactory modifier_factory,
             Resources& resources, WarningSink& warnings, const TaskRunner& task_runner,
             SceneExtent extent, const Ablation& ablation, SurfaceKeys keys)
    : impl_(std::make_unique<Impl>(std::move(model), resources, task_runner)) {
    impl_->keys = std::move(keys);
    impl_->collect_surfaces(warnings, task_runner);
    impl_->use_modifiers();
    impl_->modifiers.compile(modifier_factory, resources, warnings, task_runner);
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

Scene::Scene(std::shared_ptr<const Scene> base, ModelChange change,
             FindModifierFactory modifier_factory, Resources& resources, WarningSink& warnings,
             const TaskRunner& task_runner) {
    if (base->impl_->base) base = base->impl_->base;
    check_change(change);
    const std::vector<PlacedSource> sources = std::move(change.sources);
    impl_ = std::make_unique<Impl>(std::move(base), std::move(change));
    impl_->share_surfaces(sources, task_runner);
    impl_->use_shared_modifiers();
    impl_->modifiers.adopt(impl_->base->impl_->modifiers);
    impl_->modifiers.compile(modifier_factory, resources, warnings, task_runner);
    impl_->add_lambertian(modifier_factory, resources, warnings);
    impl_->surfaces.set_traits(impl_->modifiers.all_traits());
    impl_->check_traits();
}

Scene::~Scene() = default;

const Geometry& Scene::geometry() const {
    return *impl_->geometry;
}
const SurfaceTable& Scene::surfaces() const {
    return impl_->surfaces;
}
std::uint32_t Scene::surface_key(SurfaceId id) const {
    return impl_->keys(index(id));
}
std::size_t Scene::own_surfaces() const {
    return impl_->models[0].model->surfaces.size();
}
const std::vector<SourcePlace>* Scene::changed_sources() const {
    return impl_->base ? &impl_->new_sources : nullptr;
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
const std::vector<Primitive>& Scene::own_modifiers() const {
    return impl_->models[0].modifiers();
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
