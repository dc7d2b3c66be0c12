#include "core/virtual_source/virtual_sources.h"

#include <algorithm>
#include <cmath>

#include "core/virtual_source/beam.h"

namespace lightwalk {
namespace {

bool redirects_light(PrimitiveType type) {
    return type == PrimitiveType::mirror || type == PrimitiveType::prism1 ||
           type == PrimitiveType::prism2;
}

/// The mirror or prism that a surface of this modifier is made of, directly or as the alternate of
/// an illum.
std::optional<ModifierId> redirecting_material(const Scene& scene, ModifierId modifier) {
    auto id = scene.material_of(modifier);
    if (id && scene.modifier(*id).type == PrimitiveType::illum) {
        const std::vector<ModifierId>& alternate = scene.modifier(*id).references;
        if (alternate.empty() || alternate[0] == kVoid) return std::nullopt;
        id = scene.material_of(alternate[0]);
    }
    if (!id || !redirects_light(scene.modifier(*id).type)) return std::nullopt;
    return id;
}

}  // namespace

VirtualSourceBuilder::VirtualSourceBuilder(LightSources& lights, const LightTransport& tracer,
                                           WarningSink& warnings)
    : lights_(lights), tracer_(tracer), context_(tracer, warnings) {
    if (tracer.options().redirections > 0 && !lights.all().empty())
        collect_redirecting_surfaces(warnings);
}

void VirtualSourceBuilder::collect_redirecting_surfaces(WarningSink& warnings) {
    const Scene& scene = tracer_.scene();
    ModifierId without =
        kVoid;  // a modifier that redirects nothing: millions of consecutive surfaces may have it
    for (std::size_t i = 0; i < scene.own_surfaces(); ++i) {
        const SurfaceId id{static_cast<std::int32_t>(i)};
        const Surface surface = scene.surface(id);
        if (surface.modifier() == without) continue;
        const auto material = redirecting_material(scene, surface.modifier());
        if (!material) without = surface.modifier();
        if (!material || !surface.has_shape()) continue;
        const Shape shape = surface.shape();
        const auto plane = plane_of(shape);
        const auto disk = redirecting_disk(shape);
        if (!plane || !disk) {
            warnings.warn(to_prefix(surface.where()) + std::string(to_string(surface.type())) +
                          " \"" + std::string(surface.name()) +
                          "\": only flat surfaces relay light to others");
            continue;
        }
        if (disk->radius * disk->radius <= kEpsilon) continue;
        RedirectingSurface found{id, *plane, *disk, nullptr, 1};
        const ModifierRecord& record = scene.modifier(*material);
        if (record.type != PrimitiveType::mirror) {
            found.prism = dynamic_cast<const RedirectingModifier*>(record.node.get());
            if (!found.prism) continue;
            found.branches = found.prism->branches();
        }
        redirecting_surfaces_.push_back(found);
    }
}

void VirtualSourceBuilder::build() {
    if (redirecting_surfaces_.empty()) return;
    const int depth = std::min(tracer_.options().redirections, kMaxRedirections);
    for (auto i = static_cast<std::int32_t>(lights_.all().size()); i-- > 0;) {
        if (!lights_[i].unusable) add_virtual_sources(i, depth);
    }
}

void VirtualSourceBuilder::add_virtual_sources(std::int32_t parent, int depth) {
    for (const RedirectingSurface& next : redirecting_surfaces_) {
        if (next.surface == lights_[parent].object) continue;
        for (int branch = 0; branch < next.branches; ++branch)
            try_virtual_source(parent, next, branch, depth);
    }
}

void VirtualSourceBuilder::try_virtual_source(std::int32_t parent_index,
                                              const RedirectingSurface& next, int branch,
                                              int depth) {
    const LightSource parent = lights_[parent_index];
    if (!lights_disk(parent, next)) return;
    const auto projected_by = projection(parent, next, branch);
    if (!projected_by) return;
    LightSource made = project(parent, *projected_by);
    const VirtualSpot redirected = virtual_spot(parent, made, *projected_by, next.disk);
    if (!redirected.possible) return;
    made.spot = redirected.spot;
    made.object = next.surface;
    made.follow = true;
    made.parent = parent_index;
    made.branch = branch;
    made.beam = virtual_source_beam(made, tracer_.scene().surface(next.surface).shape());
    if (tracer_.options().virtual_source_pretest > 0) {
        const Pretest outcome = pretest(parent_index, next, redirected.disk);
        if (outcome == Pretest::discard) return;
        made.follow = outcome == Pretest::follow;
    }
    const std::size_t count = lights_.all().size();
    if (count >= kMaxVirtualSources) {
        throw InputError("mirrors and prisms make more than " + std::to_string(kMaxVirtualSources) +
                         " virtual light sources; lower the number of relays (-dr)");
    }
    lights_.add(made);
    if (depth > 1) add_virtual_sources(static_cast<std::int32_t>(count), depth - 1);
}

/// Whether a source lights the disk of a redirecting surface. The light of a virtual source exists
/// only beyond its own redirecting surface.
bool VirtualSourceBuilder::lights_disk(const LightSource& source,
                                       const RedirectingSurface& next) const {
    if (!source.is_virtual()) return true;
    const auto plane = plane_of(tracer_.scene().surface(source.object).shape());
    if (!plane) return true;
    const double source_height =
        source.is_distant() ? dot(plane->normal, source.center) : plane->height(source.center);
    const double disk_height = plane->height(next.disk.center);
    if ((source_height > 0) != (disk_height > 0)) return true;
    const double cosine = dot(plane->normal, next.plane.normal);
    const double reach_squared = next.disk.radius * next.disk.radius * (1 - cosine * cosine);
    return disk_height * disk_height < reach_squared;
}

std::optional<Projection> VirtualSourceBuilder::projection(const LightSource& source,
                                                           const RedirectingSurface& next,
                                                           int branch) {
    if (!next.prism) {
        if (!is_before_mirror(source, next.plane)) return std::nullopt;
        return Projection::mirror(next.plane);
    }
    const Vec3 origin = source.is_distant() ? next.disk.center + source.center : source.center;
    Ray test =
        tracer_.primary(origin, next.disk.center - origin, 0, RandomStream(tracer_.options().seed));
    test.hit = tracer_.scene().geometry().intersect_surface(next.surface,
                                                            {test.origin, test.direction, kHuge});
    if (!test.hit.exists()) return std::nullopt;
    const auto bent = next.prism->redirect(branch, test, context_);
    if (!bent || bent->coefficient <= kEpsilon) return std::nullopt;
    return Projection::bend(next.plane, test.direction, bent->direction);
}

}  // namespace lightwalk
