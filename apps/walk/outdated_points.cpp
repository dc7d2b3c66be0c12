#include "apps/walk/outdated_points.h"

#include <vector>

#include "apps/walk/material_edits.h"
#include "core/geometry/bounds.h"
#include "core/geometry/surface_shapes.h"
#include "core/light/light_sources.h"

namespace lightwalk {
namespace {

/// The ids of those modifiers of a scene that are materials.
std::vector<std::size_t> materials_of(const Scene& scene, const std::vector<bool>& modifiers) {
    std::vector<std::size_t> ids;
    for (std::size_t i = 0; i < scene.modifier_count(); ++i) {
        const PrimitiveType type = scene.modifier(ModifierId{static_cast<std::int32_t>(i)}).type;
        if (modifiers[i] && (is_material(type) || is_mixture(type))) ids.push_back(i);
    }
    return ids;
}

std::vector<std::size_t> below(const std::vector<std::size_t>& indices, std::size_t end) {
    std::vector<std::size_t> some;
    for (const std::size_t index : indices)
        if (index < end) some.push_back(index);
    return some;
}

/// Boxes around surfaces of a model; nothing where it is not known how far their light or shadow
/// goes.
/// @param scene  of the model
bool add_boxes(const Model& model, const std::vector<std::size_t>& surfaces, const Scene& scene,
               std::vector<Bounds>& boxes) {
    if (surfaces.empty()) return true;
    SurfaceList list;
    std::vector<bool> used(scene.modifier_count());
    for (const std::size_t i : surfaces) {
        const SurfacePrimitive surface = model.surfaces[i];
        if (is_placement(surface.type)) return false;
        if (surface.modifier >= 0) used[static_cast<std::size_t>(surface.modifier)] = true;
        list.add(surface);
    }
    if (lights_others(scene, materials_of(scene, used))) return false;
    const SurfaceShapes shapes = make_shapes(list, SerialTaskRunner());
    for (std::size_t i = 0; i < list.size(); ++i) {
        const Bounds box = hit_bounds(shapes.shape(list, i));
        if (!box.empty()) boxes.push_back(box);
    }
    return true;
}

/// Nothing: there are too many to be looked at for each point. Half shadows of large ones are those
/// of some places on them.
std::optional<std::vector<ShadowSource>> shadow_sources(const LightSources& lights) {
    constexpr std::size_t kMost = 256, kMostLarge = 48;
    constexpr double kOut = 0.7;  // of the half axes
    if (lights.sampled().size() > kMost) return std::nullopt;
    std::vector<ShadowSource> sources;
    for (const std::int32_t i : lights.sampled()) {
        const LightSource& light = lights[i];
        sources.push_back({light.center, light.is_distant()});
        if (light.is_distant() || lights.sampled().size() > kMostLarge) continue;
        for (const Vec3& axis : {light.u, light.v})
            for (const double out : {kOut, -kOut})
                sources.push_back({light.center + out * axis, false});
    }
    return sources;
}

}  // namespace

std::optional<ShownMaterials> outdated_points(const Tracer& tracer, const Model& loaded,
                                              const Scene& after, const SceneNews& news,
                                              const Vec3& eye) {
    const Scene& before = tracer.scene();
    const ModelDifference& difference = news.difference;
    if (news.all_differs || !difference.modifiers_in_place || !difference.keys_kept ||
        difference.sources > 0)
        return std::nullopt;
    const std::vector<bool> with =
        modifiers_with(before, below(difference.modifiers, before.own_modifiers().size()));
    const std::vector<bool> with_after =
        modifiers_with(after, below(difference.modifiers, after.own_modifiers().size()));
    if (lights_others(before, materials_of(before, with)) ||
        lights_others(after, materials_of(after, with_after)))
        return std::nullopt;
    std::vector<Bounds> boxes;
    const Model& now = news.scene->model();
    if (!add_boxes(loaded, difference.gone, before, boxes) ||
        !add_boxes(now, difference.come, after, boxes))
        return std::nullopt;
    ShownMaterials outdated(before, with);
    if (boxes.empty()) return outdated;
    const std::optional<std::vector<ShadowSource>> sources = shadow_sources(tracer.lights());
    if (!sources) return std::nullopt;
    outdated.add_places(ChangedPlaces(boxes, eye, *sources));
    return outdated;
}

}  // namespace lightwalk
