#include "core/scene/scene.h"

#include <algorithm>

#include "core/model/transform_args.h"
#include "core/scene/scene_tables.h"

namespace lightwalk {

struct Scene::Impl {
    std::vector<LoadedModel> models;
    ModifierTable modifiers;
    std::vector<Surface> surfaces;
    std::size_t own_surfaces = 0;
    std::unique_ptr<Primitive>
        lambertian;  ///< what irradiance modes put in place of every opaque material
    ModifierId lambertian_modifier = kVoid;
    SurfaceId lambertian_surface = kNoSurface;
    std::unique_ptr<Geometry> geometry;

    Impl(std::shared_ptr<const Model> model, Resources& resources)
        : models(std::move(ModelLoader(std::move(model), resources).models)), modifiers(models) {}

    void collect_surfaces(WarningSink& warnings);
    void use_modifiers();
    void add_lambertian(FindModifierFactory modifier_factory, Resources& resources,
                        WarningSink& warnings);
    [[nodiscard]] ModelGeometry model_geometry(const LoadedModel& loaded) const;
    void build_geometry();
};

namespace {

Surface make_surface(const Primitive& primitive, std::int32_t modifier_base,
                     WarningSink& warnings) {
    Surface surface;
    surface.type = primitive.type;
    surface.modifier =
        primitive.modifier < 0 ? kVoid : ModifierId{modifier_base + primitive.modifier};
    surface.name = primitive.name;
    surface.where = primitive.where;
    if (primitive.type == PrimitiveType::instance || primitive.type == PrimitiveType::mesh)
        return surface;
    ValidatedShape shape = make_shape(primitive);
    if (!shape.warning.empty()) {
        warnings.warn(to_prefix(primitive.where) + std::string(to_string(primitive.type)) + " \"" +
                      primitive.name + "\": " + shape.warning);
    }
    surface.type = shape.type;
    surface.shape = std::move(shape.shape);
    return surface;
}

Transform placement_transform(const Primitive& primitive) {
    const auto words = std::span(primitive.strings).subspan(1);
    const ParsedTransform parsed = parse_transform(words);
    if (parsed.words != words.size()) {
        throw InputError(primitive.where, std::string(to_string(primitive.type)) + " \"" +
                                              primitive.name + "\": bad transform at \"" +
                                              words[parsed.words] + "\"");
    }
    return parsed.transform;
}

}  // namespace

void Scene::Impl::collect_surfaces(WarningSink& warnings) {
    std::size_t count = 1;  // add_lambertian's
    for (const LoadedModel& loaded : models)
        count += loaded.mesh ? 1
                             : static_cast<std::size_t>(std::count_if(
                                   loaded.model->primitives.begin(), loaded.model->primitives.end(),
                                   [](const Primitive& p) { return is_surface(p.type); }));
    surfaces.reserve(count);
    for (const LoadedModel& loaded : models) {
        if (loaded.mesh) {
            Surface triangles;
            triangles.type = PrimitiveType::mesh;
            triangles.name = "M-Tri";
            surfaces.push_back(std::move(triangles));
            continue;
        }
        for (const Primitive& primitive : loaded.model->primitives) {
            if (is_surface(primitive.type)) {
                surfaces.push_back(make_surface(primitive, loaded.modifier_base, warnings));
            }
        }
        if (&loaded == models.data()) own_surfaces = surfaces.size();
    }
}

void Scene::Impl::use_modifiers() {
    for (const Surface& surface : surfaces) modifiers.use(surface.modifier);
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
    Surface surface;
    surface.type = PrimitiveType::sphere;  // not flat, and not in the geometry
    surface.modifier = lambertian_modifier;
    surface.traits = modifiers.traits(lambertian_modifier);
    surface.name = lambertian->name;
    surfaces.push_back(std::move(surface));
    lambertian_surface = SurfaceId{static_cast<std::int32_t>(surfaces.size()) - 1};
}

ModelGeometry Scene::Impl::model_geometry(const LoadedModel& loaded) const {
    ModelGeometry geometry_of;
    if (loaded.mesh) {
        MeshPart part;
        part.mesh = loaded.mesh.get();
        part.surface = SurfaceId{loaded.surface_base};
        for (std::size_t i = 0; i < loaded.mesh->materials.primitives.size(); ++i) {
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
    std::int32_t next = loaded.surface_base;
    std::size_t placement = 0;
    for (const Primitive& primitive : loaded.model->primitives) {
        if (!is_surface(primitive.type)) continue;
        const SurfaceId id{next++};
        const Surface& surface = surfaces[static_cast<std::size_t>(index(id))];
        if (primitive.type == PrimitiveType::instance || primitive.type == PrimitiveType::mesh) {
            geometry_of.placements.push_back({loaded.children[placement++],
                                              placement_transform(primitive), id,
                                              surface.modifier != kVoid});
        } else if (!std::holds_alternative<std::monostate>(surface.shape) &&
                   !std::holds_alternative<SourceShape>(surface.shape)) {
            geometry_of.surfaces.push_back(id);
        }
    }
    return geometry_of;
}

void Scene::Impl::build_geometry() {
    GeometryInput input;
    input.surfaces = surfaces;
    for (const LoadedModel& loaded : models) input.models.push_back(model_geometry(loaded));
    geometry = std::make_unique<Geometry>(std::move(input));
}

Scene::Scene(std::shared_ptr<const Model> model, FindModifierFactory modifier_factory,
             Resources& resources, WarningSink& warnings)
    : impl_(std::make_unique<Impl>(std::move(model), resources)) {
    impl_->collect_surfaces(warnings);
    impl_->use_modifiers();
    impl_->modifiers.compile(impl_->models, modifier_factory, resources, warnings);
    impl_->add_lambertian(modifier_factory, resources, warnings);
    for (Surface& surface : impl_->surfaces)
        surface.traits = impl_->modifiers.traits(surface.modifier);
    impl_->build_geometry();
}

ProblemList Scene::unsupported(std::shared_ptr<const Model> model,
                               FindModifierFactory modifier_factory, Resources& resources,
                               WarningSink& warnings) {
    Impl scene(std::move(model), resources);
    scene.collect_surfaces(warnings);
    scene.use_modifiers();
    return scene.modifiers.unsupported(modifier_factory);
}

Scene::~Scene() = default;

const Geometry& Scene::geometry() const {
    return *impl_->geometry;
}
std::span<const Surface> Scene::surfaces() const {
    return impl_->surfaces;
}
std::size_t Scene::own_surfaces() const {
    return impl_->own_surfaces;
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

SceneCube Scene::cube() const {
    if (const std::optional<ModelCube>& cube = model().cube)
        return {{cube->x, cube->y, cube->z}, cube->size};
    const Bounds bounds = impl_->geometry->bounds();
    if (bounds.empty()) return {};
    constexpr double kMargin = 1e-5;  // [m], on each side
    const Vec3 size = bounds.upper - bounds.lower;
    const double edge = std::max({size.x, size.y, size.z}) + 2 * kMargin;
    const Vec3 middle = (bounds.lower + bounds.upper) * 0.5;
    return {middle - Vec3{edge, edge, edge} * 0.5, edge};
}

}  // namespace lightwalk
