#pragma once
// Light sources for tests.
#include "core/light/light_source.h"

namespace lightwalk::test {

/// A square panel of the given half width at height 1, facing down.
inline LightSource panel(double half) {
    LightSource source;
    source.shape = PrimitiveType::polygon;
    source.center = {0, 0, 1};
    source.normal = {0, 0, -1};
    source.u = {half, 0, 0};
    source.v = {0, half, 0};
    source.size = static_cast<float>(4 * half * half);
    return source;
}

inline LightSource tube(double half_length, double radius) {
    LightSource source;
    source.shape = PrimitiveType::cylinder;
    source.center = {0, 0, 1};
    source.u = {half_length, 0, 0};
    source.v = {0, kCylinderBox * radius, 0};
    source.w = {0, 0, kCylinderBox * radius};
    source.size = static_cast<float>(4 * radius * half_length);
    return source;
}

}  // namespace lightwalk::test
