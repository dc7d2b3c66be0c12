#include "core/light/source_setup.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "core/light/spot.h"
#include "core/texture/function_binding.h"

namespace lightwalk {
namespace {

constexpr double kSlimTriangle = 0.08;  ///< least squared distance of centre and edge over the area
constexpr double kSlimCylinder = 0.2;   ///< largest radius over length

/// The surface and material that a source is made from, and how to complain about them.
struct Emitter {
    Surface surface;
    const ModifierRecord& material;

    [[nodiscard]] std::string described(const std::string& problem) const {
        return std::string(to_string(surface.type())) + " \"" + std::string(surface.name()) +
               "\": " + problem;
    }
    [[noreturn]] void fail(const std::string& problem) const {
        throw InputError(surface.where(), described(problem));
    }
    void warn(WarningSink& warnings, const std::string& problem) const {
        warnings.warn(to_prefix(surface.where()) + described(problem));
    }
    [[nodiscard]] const std::vector<double>& reals() const { return material.primitive->reals; }
};

Vec3 vertex_average(const PolygonShape& polygon) {
    Vec3 sum;
    for (const Vec3 p : polygon.vertices) sum += p;
    return sum / static_cast<double>(polygon.vertices.size());
}

/// Axes of a square of the given area about the normal.
void set_square(LightSource& source, const Vec3& normal, double area) {
    source.u = perpendicular(normal) * (0.5 * std::sqrt(area));
    source.v = cross(normal, source.u);
}

/// A triangle is sampled in the square that touches the edge nearest to its centre.
void set_triangle(LightSource& source, const PolygonShape& polygon, const Emitter& emitter,
                  WarningSink& warnings) {
    Vec3 nearest_edge;
    double nearest_squared = 0;
    for (const std::size_t i : {std::size_t{2}, std::size_t{0}, std::size_t{1}}) {
        const Vec3 edge = normalize(polygon.vertices[(i + 1) % 3] - polygon.vertices[i]);
        const Vec3 to_center = source.center - polygon.vertices[i];
        const double along = dot(to_center, edge);
        const double squared = length_squared(to_center) - along * along;
        if (i == 2 || squared < nearest_squared) {
            nearest_squared = squared;
            nearest_edge = edge;
        }
    }
    source.u = nearest_edge * std::sqrt(std::max(0.0, nearest_squared));
    source.v = cross(source.normal, source.u);
    if (nearest_squared < kSlimTriangle * area_of(polygon))
        emitter.warn(warnings, "source aspect too small");
}

void set_shape(LightSource& source, const PolygonShape& polygon, const Emitter& emitter,
               WarningSink& warnings) {
    const double area = area_of(polygon);
    if (area <= 0) emitter.fail("zero area");
    source.center = vertex_average(polygon);
    source.normal = polygon.normal;
    source.size = static_cast<float>(area);
    if (!intersect(polygon, source.center + source.normal, -source.normal, 2, nullptr)) {
        emitter.fail("cannot hit source center");
    }
    double farthest = 0;
    for (const Vec3 p : polygon.vertices)
        farthest = std::max(farthest, length_squared(p - source.center));
    source.radius = static_cast<float>(std::sqrt(farthest));
    if (polygon.vertices.size() == 4) {
        source.u = (polygon.vertices[1] - polygon.vertices[0]) * 0.5;
        source.v = (polygon.vertices[3] - polygon.vertices[0]) * 0.5;
    } else if (polygon.vertices.size() == 3) {
        set_triangle(source, polygon, emitter, warnings);
    } else {
        set_square(source, source.normal, area);
    }
}

void set_shape(LightSource& source, const RingShape& ring, const Emitter& emitter, WarningSink&) {
    if (ring.r0 > 0)
        emitter.fail("cannot hit source center: a ring that emits light must not have a hole");
    if (ring.r1 <= 0) emitter.fail("zero size");
    source.center = ring.center;
    source.normal = ring.normal;
    source.radius = static_cast<float>(ring.r1);
    const double area = kPi * ring.r1 * ring.r1;
    source.size = static_cast<float>(area);
    set_square(source, ring.normal, area);
}

void set_shape(LightSource& source, const SphereShape& sphere, const Emitter& emitter,
               WarningSink&) {
    if (sphere.radius <= 0) emitter.fail("zero size");
    source.center = sphere.center;
    source.u = {kSphereBox * sphere.radius, 0, 0};
    source.v = {0, kSphereBox * sphere.radius, 0};
    source.w = {0, 0, kSphereBox * sphere.radius};
    source.radius = static_cast<float>(sphere.radius);
    source.size = static_cast<float>(kPi * sphere.radius * sphere.radius);
}

void set_shape(LightSource& source, const ConeShape& cylinder, const Emitter& emitter,
               WarningSink& warnings) {
    const double radius = cylinder.r0;
    if (radius <= 0 || cylinder.length <= 0) emitter.fail("zero size");
    source.center = (cylinder.p0 + cylinder.p1) * 0.5;
    source.u = (cylinder.p1 - cylinder.p0) * 0.5;
    source.w = perpendicular(cylinder.axis) * (kCylinderBox * radius);
    source.v = cross(source.w, cylinder.axis);
    source.radius = static_cast<float>(0.5 * cylinder.length);
    source.size = static_cast<float>(2 * radius * cylinder.length);
    if (radius > kSlimCylinder * cylinder.length) emitter.warn(warnings, "source aspect too small");
}

void set_shape(LightSource& source, const SourceShape& at_infinity, const Emitter& emitter,
               WarningSink&) {
    const auto solid_angle = static_cast<double>(at_infinity.solid_angle);
    if (length_squared(at_infinity.direction) <= 0) emitter.fail("zero direction");
    if (solid_angle <= cone_solid_angle(std::cos(kEpsilon))) emitter.fail("zero size");
    source.center = at_infinity.direction;
    source.size = at_infinity.solid_angle;
    source.radius = static_cast<float>(std::sqrt(solid_angle / kPi));
    set_square(source, source.center, solid_angle);
}

void set_shape(LightSource&, const std::monostate&, const Emitter& emitter, WarningSink&) {
    // Other degenerate surfaces never get here.
    emitter.fail(emitter.surface.type() == PrimitiveType::polygon ? "zero area" : "zero direction");
}

void set_spot(LightSource& source, const Emitter& emitter, WarningSink& warnings) {
    const SpotShape spot = spot_cone(*emitter.material.primitive);
    source.spot = spot;
    if (source.is_distant()) emitter.warn(warnings, "distant light source is a spotlight");
    if (source.is_flat() && !spot_faces(spot, source.normal)) {
        emitter.warn(warnings, "invalid spotlight direction: it shines away from the front");
        source.unusable = true;
    }
}

/// Light, illum, glow or spotlight at the end of a modifier's chain, when its colour is not black.
std::optional<ModifierId> emitting_material(const Scene& scene, ModifierId modifier) {
    if (modifier == kVoid) return std::nullopt;
    const auto id = scene.material_of(modifier);
    if (!id) return std::nullopt;
    const ModifierRecord& material = scene.modifier(*id);
    if (!is_light(material.type) || !material.primitive) return std::nullopt;
    const std::vector<double>& reals = material.primitive->reals;
    if (reals[0] <= kEpsilon && reals[1] <= kEpsilon && reals[2] <= kEpsilon) return std::nullopt;
    return id;
}

/// The same when it may light others: glows do so within their radius, or from infinity.
std::optional<ModifierId> light_material(const Scene& scene, const Surface& surface,
                                         ModifierId id) {
    const ModifierRecord& material = scene.modifier(id);
    const bool near_only = material.type == PrimitiveType::glow &&
                           material.primitive->reals[3] <= kEpsilon &&
                           surface.type() != PrimitiveType::source;
    return near_only ? std::nullopt : std::optional(id);
}

bool may_emit(PrimitiveType type) {
    using enum PrimitiveType;
    return type == source || type == sphere || type == polygon || type == ring || type == cylinder;
}

/// Whether patterns are functions that can be evaluated for several rays side by side.
bool have_lanes(const Scene& scene, ModifierId patterns) {
    for (ModifierId m = patterns; m != kVoid; m = scene.modifier(m).next) {
        const Modifier* node = scene.modifier(m).node.get();
        const FunctionBinding* function = node ? node->brightness_function() : nullptr;
        if (!function || !function->program().has_lanes()) return false;
    }
    return true;
}

LightSource make_source(const Emitter& emitter, ModifierId material, WarningSink& warnings) {
    if (!may_emit(emitter.surface.type())) {
        emitter.fail("illegal material \"" + emitter.material.name +
                     "\": only source, sphere, polygon, ring and cylinder can be light sources");
    }
    LightSource source;
    source.material = material;
    source.material_type = emitter.material.type;
    source.shape = emitter.surface.type();
    std::visit([&](const auto& shape) { set_shape(source, shape, emitter, warnings); },
               emitter.surface.shape());
    const std::vector<double>& reals = emitter.reals();
    source.radiance = {static_cast<float>(reals[0]), static_cast<float>(reals[1]),
                       static_cast<float>(reals[2])};
    const bool alone = emitter.surface.modifier() == material;
    source.uniform = alone && emitter.material.next == kVoid;
    source.plain = alone && source.material_type != PrimitiveType::spotlight;
    source.patterns = emitter.material.next;
    if (source.material_type == PrimitiveType::glow) {
        source.proximity = static_cast<float>(reals[3]);
        source.unusable = source.is_distant();
    } else if (source.material_type == PrimitiveType::spotlight) {
        set_spot(source, emitter, warnings);
    } else if (source.material_type == PrimitiveType::illum) {
        const std::vector<ModifierId>& alternate = emitter.material.references;
        source.transparent_illum = alternate.empty() || alternate[0] == kVoid;
    }
    return source;
}

/// Calls visit(id) for each of the scene's own surfaces, in their order, until it returns false. A
/// changed scene has other sources at infinity.
template <class Visit>
void visit_own_surfaces(const Scene& scene, const Visit& visit) {
    const std::vector<SourcePlace>* const changed = scene.changed_sources();
    std::size_t others = 0, next = 0;
    for (std::size_t i = 0; i < scene.own_surfaces(); ++i) {
        const SurfaceId id{static_cast<std::int32_t>(i)};
        if (changed != nullptr) {
            if (scene.surface(id).type() == PrimitiveType::source) continue;
            for (; next < changed->size() && (*changed)[next].before <= others; ++next)
                if (!visit((*changed)[next].id)) return;
            ++others;
        }
        if (!visit(id)) return;
    }
    for (; changed != nullptr && next < changed->size(); ++next)
        if (!visit((*changed)[next].id)) return;
}

/// Calls visit(surface, id, material) for each of the scene's own surfaces that emits, until it
/// returns false. Millions of surfaces may have one modifier in turn, which is asked once then.
template <class Visit>
void visit_emitters(const Scene& scene, const Visit& visit) {
    ModifierId last = kVoid;
    std::optional<ModifierId> material;
    visit_own_surfaces(scene, [&](SurfaceId id) {
        const Surface surface = scene.surface(id);
        if (surface.modifier() != last) {
            last = surface.modifier();
            material = emitting_material(scene, last);
        }
        return !material || is_placement(surface.type()) || visit(surface, id, *material);
    });
}

}  // namespace

bool has_glow(const Scene& scene) {
    bool found = false;
    visit_emitters(scene, [&](const Surface&, SurfaceId, ModifierId material) {
        found = scene.modifier(material).type == PrimitiveType::glow;
        return !found;
    });
    return found;
}

std::vector<LightSource> collect_sources(const Scene& scene, WarningSink& warnings) {
    std::vector<LightSource> sources;
    visit_emitters(scene, [&](const Surface& surface, SurfaceId id, ModifierId emitting) {
        const auto material = light_material(scene, surface, emitting);
        if (!material) return true;
        const bool fatal =
            surface.type() == PrimitiveType::source || surface.type() == PrimitiveType::polygon;
        // Other degenerate surfaces are ignored; the scene has warned of them.
        if (!surface.has_shape() && !fatal) return true;
        const Emitter emitter{surface, scene.modifier(*material)};
        LightSource source = make_source(emitter, *material, warnings);
        source.object = id;
        source.has_lanes = source.plain && have_lanes(scene, source.patterns);
        sources.push_back(source);
        return true;
    });
    return sources;
}

}  // namespace lightwalk
