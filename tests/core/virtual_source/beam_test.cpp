// The beam of a redirecting surface: never leaves out a point that the redirecting surface lights,
// and most that it does not.
#include "core/virtual_source/beam.h"

#include <doctest/doctest.h>

#include "core/light/light_source.h"
#include "core/math/random.h"
#include "tests/core/geometry/geometry_scenes.h"

namespace lightwalk {
using test::kept_primitive;

namespace {

Vec3 random_place(RandomStream& random, double reach) {
    const auto next = [&] { return reach * (2 * random.next() - 1); };
    const double x = next(), y = next();
    return {x, y, next()};
}

/// A triangle, a kite or a ring in a random plane.
Shape random_surface(RandomStream& random, int kind) {
    const Vec3 center = random_place(random, 1), normal = normalize(random_place(random, 1));
    if (kind == 2) return RingShape{center, normal, 0, 0.2 + random.next()};
    const Vec3 u = perpendicular(normal), v = cross(normal, u);
    std::vector<Vec3> points{center + u, center + v * random.next(), center - u * random.next()};
    if (kind == 1) points.push_back(center - v * 0.7);
    std::vector<double> reals;
    for (const Vec3& p : points) reals.insert(reals.end(), {p.x, p.y, p.z});
    return make_shape(kept_primitive(PrimitiveType::polygon, std::move(reals))).shape;
}

LightSource random_source(RandomStream& random, bool distant) {
    LightSource source;
    if (distant) source.shape = PrimitiveType::source;
    source.center = distant ? normalize(random_place(random, 1)) : random_place(random, 6);
    const double size = distant ? 0.02 : 0.4;
    source.u = random_place(random, size);
    source.v = random_place(random, size);
    if (!distant) source.w = random_place(random, size);
    return source;
}

}  // namespace

TEST_CASE(
    "a virtual source's beam holds every point from which a sample is seen through the mirror or "
    "prism") {
    RandomStream random(11);
    int lit = 0, dark = 0, left_out = 0;
    for (int i = 0; i < 1200; ++i) {
        const Shape surface = random_surface(random, i % 3);
        const LightSource source = random_source(random, i % 2 == 0);
        const auto beam = virtual_source_beam(source, surface);
        if (!beam) continue;
        for (int j = 0; j < 300; ++j) {
            const Vec3 point = random_place(random, 4), a = random_place(random, 1.13);
            const Vec3 target = source.center + source.u * a.x + source.v * a.y + source.w * a.z;
            const Vec3 direction = normalize(source.is_distant() ? target : target - point);
            if (intersect(surface, point, direction, kHuge)) {
                REQUIRE(beam->may_reach(point));
                ++lit;
            } else {
                ++dark;
                left_out += beam->may_reach(point) ? 0 : 1;
            }
        }
    }
    CHECK(lit > 2000);
    CHECK(left_out > dark / 3);  // a half lies on the source's side
}

TEST_CASE("no beam: a source that straddles the mirror's plane, a surface that is not flat") {
    LightSource source;
    source.u = {0, 0, 1};
    const Shape mirror = RingShape{{0, 0, 0.5}, {0, 0, 1}, 0, 1};
    CHECK_FALSE(virtual_source_beam(source, mirror));
    source.u = {0.1, 0, 0};
    CHECK(virtual_source_beam(source, mirror));
    CHECK_FALSE(virtual_source_beam(source, SphereShape{}));
}

}  // namespace lightwalk
