#include "core/cloud/data_cells.h"

#include "core/model/transform_args.h"
#include "core/scene/seen_material.h"

namespace lightwalk {

DataCells::DataCells(const Scene& scene) : scene_(scene) {
    for (std::size_t i = 0; i < scene.modifier_count(); ++i) {
        const SeenMaterial seen = seen_material(scene, ModifierId{static_cast<std::int32_t>(i)});
        if (!seen.material || seen.traits.appearance != Appearance::pane) continue;
        const ModifierRecord& record = scene.modifier(*seen.material);
        const Bsdf* data = record.node ? record.node->bsdf() : nullptr;
        if (data == nullptr) continue;
        panes_.resize(scene.modifier_count());
        panes_[i].data = data;
        // After the file's name; those of panes are numbers (BsdfMaterial::traits).
        for (std::size_t k = 0; k < 3; ++k)
            (void)parse_real(record.primitive->strings[1 + k], panes_[i].up[k]);
    }
}

std::uint32_t DataCells::find(const Hit& hit, const Vec3& direction) const {
    if (panes_.empty()) return 0;
    const Pane& pane = panes_[static_cast<std::size_t>(index(hit.modifier))];
    if (pane.data == nullptr) return 0;
    const BsdfComponent& part = pane.data->transmission(hit.cos_out > 0);
    Vec3 up = pane.up;
    if (hit.instance != kWorld)
        up = scene_.geometry().instance_transform(hit.instance).forward.vector(up);
    const Vec3 across = cross(up, hit.normal);
    if (!part.lobes || !(length_squared(across) > 0)) return 0;
    const Vec3 x = normalize(across), y = cross(hit.normal, x);
    const BsdfLookup e = part.lobes->look_up({-dot(x, direction), -dot(y, direction)});
    return 1 + part.lobes->viewer_cell(e);
}

}  // namespace lightwalk
