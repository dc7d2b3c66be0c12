#pragma once
// The fields of core's types on the wire (see wire.h).
#include "core/ambient/ambient_record.h"
#include "core/cloud/point.h"
#include "core/cloud/progressive.h"
#include "core/transport/light_groups.h"
#include "core/view/pixels.h"
#include "core/view/view.h"
#include "parallel/comm/wire.h"

namespace lightwalk {

template <class Wire>
void visit_fields(Wire& wire, Vec3& v) {
    wire(v.x, v.y, v.z);
}
template <class Wire>
void visit_fields(Wire& wire, Rgb& c) {
    wire(c.r, c.g, c.b);
}
template <>
inline constexpr bool wire::kPlain<Rgb> = sizeof(Rgb) == 3 * sizeof(float);
template <class Wire>
void visit_fields(Wire& wire, LightMixture& mixture) {
    wire(mixture.levels);
}
template <class Wire>
void visit_fields(Wire& wire, PixelPlace& place) {
    wire(place.x, place.y);
}
template <>
inline constexpr bool wire::kPlain<PixelPlace> = sizeof(PixelPlace) == 2 * sizeof(int);
template <class Wire>
void visit_fields(Wire& wire, PixelRectangle& r) {
    wire(r.x0, r.y0, r.x1, r.y1);
}
template <class Wire>
void visit_fields(Wire& wire, PixelValue& value) {
    wire(value.radiance, value.distance);
}
template <>
inline constexpr bool wire::kPlain<PixelValue> = sizeof(PixelValue) == 4 * sizeof(float);
template <class Wire>
void visit_fields(Wire& wire, View& v) {
    wire(v.type, v.position, v.direction, v.up, v.horizontal, v.vertical, v.fore, v.aft, v.shift,
         v.lift);
}
template <class Wire>
void visit_fields(Wire& wire, AmbientRecord& r) {
    wire(r.position, r.normal, r.axis, r.radius, r.translation, r.rotation, r.value, r.weight,
         r.corral, r.level);
}

template <>
inline constexpr int wire::kEnumerators<PointKind> = kPointKinds;
template <class Wire>
void visit_fields(Wire& wire, CloudPoint& p) {
    PointKind kind = p.kind;  // a bit-field has no reference
    bool paired = p.paired;
    wire(p.position, p.radiance, p.surface, p.direction, p.max_view_angle, kind, p.age, p.old,
         paired, p.pattern);
    p.kind = kind;
    p.paired = paired;
}

template <>
inline constexpr int wire::kEnumerators<PixelOrigin::Kind> = 4;
template <class Wire>
void visit_fields(Wire& wire, PixelOrigin& origin) {
    wire(origin.kind, origin.samples, origin.order);
}

}  // namespace lightwalk
