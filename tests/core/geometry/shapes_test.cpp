#include "core/geometry/shapes.h"

#include <doctest/doctest.h>

#include <limits>

#include "tests/core/geometry/geometry_scenes.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;
using enum PrimitiveType;

namespace {

ValidatedShape make(PrimitiveType type, std::vector<double> reals) {
    return make_shape(kept_primitive(type, std::move(reals)));
}
bool is_ignored(const ValidatedShape& valid) {
    return std::holds_alternative<std::monostate>(valid.shape);
}

std::optional<ShapeHit> hit(const ValidatedShape& valid, const Vec3& origin,
                            const Vec3& direction) {
    return intersect(valid.shape, origin, normalize(direction), kHuge);
}

}  // namespace

TEST_CASE(
    "degenerate spheres and bubbles: negative radii turn them inside out, zero radii remove them") {
    const ValidatedShape negative = make(sphere, {1, 2, 3, -2});
    CHECK(negative.type == bubble);
    CHECK(negative.warning == "negative radius");
    CHECK(std::get<SphereShape>(negative.shape).radius == 2);
    CHECK(std::get<SphereShape>(negative.shape).inward);
    CHECK(make(bubble, {0, 0, 0, -2}).type == sphere);
    CHECK_FALSE(std::get<SphereShape>(make(bubble, {0, 0, 0, -2}).shape).inward);
    for (const double r : {0.0, 1e-6, -1e-6}) {
        CHECK(is_ignored(make(sphere, {0, 0, 0, r})));
        CHECK(make(sphere, {0, 0, 0, r}).warning == "zero radius, ignored");
    }
    CHECK(make(sphere, {0, 0, 0, 1.1e-6}).warning.empty());
}

TEST_CASE("degenerate cylinders, cones and rings follow the reference's table") {
    CHECK(make(cylinder, {0, 0, 0, 0, 0, 1, -2}).type == tube);
    CHECK(make(tube, {0, 0, 0, 0, 0, 1, -2}).type == cylinder);
    CHECK(make(cylinder, {0, 0, 0, 0, 0, 1, -2}).warning == "negative radii");
    CHECK(is_ignored(make(cylinder, {0, 0, 0, 0, 0, 1, 1e-6})));
    CHECK(make(cylinder, {0, 0, 0, 0, 0, 1, 0}).warning == "illegal radii, ignored");

    const ValidatedShape negative = make(cone, {0, 0, 0, 0, 0, 1, -1, -2});
    CHECK(negative.type == cup);
    CHECK(negative.warning == "negative radii");
    CHECK(std::get<ConeShape>(negative.shape).r1 == 2);
    CHECK(make(cup, {0, 0, 0, 0, 0, 1, 0, -2}).type == cone);
    CHECK(is_ignored(make(cone, {0, 0, 0, 0, 0, 1, 1, -2})));
    CHECK(is_ignored(make(cone, {0, 0, 0, 0, 0, 1, 1e-7, -1e-7})));
    CHECK(make(cone, {0, 0, 0, 0, 0, 1, 0, 0}).warning == "illegal radii, ignored");
    CHECK(make(cone, {0, 0, 0, 0, 0, 1, 2, 2 + 1e-7}).type == cylinder);
    CHECK(make(cone, {0, 0, 0, 0, 0, 1, 2, 2 + 1e-7}).warning.empty());
    CHECK(std::get<ConeShape>(make(cone, {0, 0, 0, 0, 0, 1, 2, 2 + 1e-7}).shape).r1 == 2);
    CHECK(make(cup, {0, 0, 0, 0, 0, 1, 2, 2}).type == tube);
    CHECK(make(cone, {0, 0, 1, 0, 0, 1, 1, 2}).warning == "unknown orientation, ignored");
    CHECK(make(cylinder, {0, 0, 1, 0, 0, 1, 1}).warning == "unknown orientation, ignored");

    const ConeShape swapped = std::get<ConeShape>(make(cone, {0, 0, 0, 0, 0, 4, 2, 1}).shape);
    CHECK(swapped.p0 == Vec3{0, 0, 4});
    CHECK(swapped.r0 == 1);
    CHECK(swapped.axis == Vec3{0, 0, -1});
    CHECK(swapped.length == 4);

    for (const auto& [r0, r1] :
         {std::pair(-1.0, 2.0), std::pair(0.0, 0.0), std::pair(2.0, 2.0), std::pair(1e-7, -1e-7)}) {
        CHECK(make(ring, {0, 0, 0, 0, 0, 1, r0, r1}).warning == "illegal radii, ignored");
    }
    CHECK(make(ring, {0, 0, 0, 0, 0, 0, 0, 1}).warning == "unknown orientation, ignored");
    const ValidatedShape wide = make(ring, {0, 0, 0, 0, 0, 5, 2, 1});
    CHECK(wide.warning.empty());
    CHECK(std::get<RingShape>(wide.shape).r0 == 1);
    CHECK(std::get<RingShape>(wide.shape).r1 == 2);
    CHECK(std::get<RingShape>(wide.shape).normal == Vec3{0, 0, 1});
}

TEST_CASE("polygons: closing vertex, normal, area, planarity") {
    const ValidatedShape closed = make(polygon, {0, 0, 1, 2, 0, 1, 2, 3, 1, 0, 3, 1, 1e-7, 0, 1});
    const PolygonShape& p = std::get<PolygonShape>(closed.shape);
    CHECK(p.vertices.size() == 4);
    CHECK(area_of(p) == 6);
    CHECK(p.normal == Vec3{0, 0, 1});
    CHECK(p.offset == 1);
    CHECK(p.drop_axis == 2);
    CHECK(closed.warning.empty());
    CHECK(std::get<PolygonShape>(make(polygon, {0, 0, 0, 1, 0, 0, 0, 1e-7, 0}).shape)
              .vertices.size() == 3);
    CHECK(make(polygon, {0, 0, 0, 1, 1, 1, 2, 2, 2}).warning == "zero area, ignored");
    CHECK(is_ignored(make(polygon, {0, 0, 0, 1, 1, 1, 2, 2, 2})));

    CHECK(make(polygon, {0, 0, 1, 1, 0, 1, 1, 1, 1.01, 0, 1, 1}).warning == "non-planar vertex");
    CHECK_FALSE(is_ignored(make(polygon, {0, 0, 1, 1, 0, 1, 1, 1, 1.01, 0, 1, 1})));
    // relative to the distance of the plane from the origin
    CHECK(make(polygon, {0, 0, 1000, 1, 0, 1000, 1, 1, 1000.004, 0, 1, 1000}).warning.empty());
    CHECK(make(polygon, {0, 0, 0, 1, 0, 0, 1, 1, 0.004, 0, 1, 0}).warning == "non-planar vertex");

    const auto axis = [](const Vec3& n) {  // of a triangle with this normal
        const Vec3 u = perpendicular(normalize(n)), v = cross(normalize(n), u);
        return std::get<PolygonShape>(make(polygon, {0, 0, 0, u.x, u.y, u.z, v.x, v.y, v.z}).shape)
            .drop_axis;
    };
    CHECK(axis({3, 2, 1}) == 0);
    CHECK(axis({1, 3, 2}) == 1);
    CHECK(axis({1, 2, 3}) == 2);
}

TEST_CASE("a source's solid angle is a float: half the sky holds its own horizon") {
    const SourceShape half = std::get<SourceShape>(make(source, {0, 0, 4, 180}).shape);
    CHECK(half.direction == Vec3{0, 0, 1});
    CHECK(half.solid_angle == 6.2831855f);
    CHECK(contains(half, {1, 0, 0}));
    CHECK_FALSE(contains(half, normalize({1, 0, -1e-3})));
    const SourceShape sun = std::get<SourceShape>(make(source, {1, 0, 0, 0.5}).shape);
    CHECK(contains(sun, {1, 0, 0}));
    CHECK(contains(sun, normalize({1, 0.0043, 0})));
    CHECK_FALSE(contains(sun, normalize({1, 0.0044, 0})));
    CHECK(contains(std::get<SourceShape>(make(source, {1, 0, 0, 360}).shape), {-1, 0, 0}));
    CHECK_FALSE(intersect(half, {0, 0, 0}, {0, 0, 1}, kHuge));
}

TEST_CASE("wrong counts and unusable numbers are refused with the place") {
    const auto text = [](PrimitiveType type, std::vector<double> reals) {
        try {
            static_cast<void>(make(type, std::move(reals)));
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    CHECK(text(sphere, {1, 2, 3}) ==
          "room.rad:7: sphere \"it\": bad arguments: expected 4 real arguments, found 3");
    CHECK(text(ring, {1}) ==
          "room.rad:7: ring \"it\": bad # arguments: expected 8 real arguments, found 1");
    CHECK(text(polygon, {0, 0, 0, 1, 0, 0, 1, 1}) ==
          "room.rad:7: polygon \"it\": bad # arguments: expected three coordinates for each of at "
          "least three "
          "vertices, found 8 real arguments");
    CHECK(text(polygon, {}).find("found 0") != std::string::npos);
    for (const PrimitiveType type : {source, bubble})
        CHECK(text(type, {1, 2, 3, 4, 5}).find("expected 4") != std::string::npos);
    for (const PrimitiveType type : {cone, cup})
        CHECK(text(type, {1}).find("expected 8") != std::string::npos);
    for (const PrimitiveType type : {cylinder, tube})
        CHECK(text(type, {1}).find("expected 7") != std::string::npos);
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity(), -2e30}) {
        CHECK(text(sphere, {0, bad, 0, 1}).find("real argument 2 is not a usable number") !=
              std::string::npos);
        CHECK(text(polygon, {0, 0, 0, 1, 0, 0, 0, 1, bad}).find("real argument 9") !=
              std::string::npos);
        CHECK(text(source, {0, 0, 1, bad}).find("real argument 4") != std::string::npos);
        CHECK(text(cone, {0, 0, 0, 0, 0, 1, bad, 1}).find("real argument 7") != std::string::npos);
    }
    CHECK(text(sphere, {1e30, 0, 0, 1e30}) == "accepted");
}

TEST_CASE("a sphere is met where its equation says, first root in front, second behind") {
    const ValidatedShape ball = make(sphere, {1, 2, 3, 2}), hollow = make(bubble, {1, 2, 3, 2});
    const auto outside = hit(ball, {1, 2, 10}, {0, 0, -1});
    REQUIRE(outside);
    CHECK(outside->t == 5);
    CHECK(outside->normal == Vec3{0, 0, 1});
    CHECK(outside->front);
    CHECK_FALSE(hit(hollow, {1, 2, 10}, {0, 0, -1})->front);
    CHECK(hit(hollow, {1, 2, 10}, {0, 0, -1})->normal == Vec3{0, 0, -1});
    const auto inside = hit(ball, {1, 2, 3}, {0, 0, -1});
    CHECK(inside->t == 2);
    CHECK_FALSE(inside->front);
    CHECK(inside->normal == Vec3{0, 0, -1});
    CHECK_FALSE(hit(ball, {1, 2, -10}, {0, 0, -1}));
    CHECK_FALSE(intersect(ball.shape, {1, 2, 10}, {0, 0, -1}, 4.999));
    CHECK(intersect(ball.shape, {1, 2, 10}, {0, 0, -1}, 5.0));
    // a hit beyond t_max hides the far side, too
    CHECK_FALSE(intersect(ball.shape, {1, 2, 5 + 1e-7}, {0, 0, -1}, 1.0));
    CHECK(hit(ball, {1, 2, 5 + 1e-7}, {0, 0, -1})->t ==
          rounded(4 + 1e-7));  // t <= 1e-6 does not count
}

TEST_CASE("hits lie on the surface and normals are its gradient, from near and far") {
    Random random(5);
    int hits = 0;
    for (int i = 0; i < 4000; ++i) {
        const Vec3 p = random.in_box(1), q = p + random.direction() * random.uniform(0.3, 2);
        const bool pointed = i % 3 == 0;
        const double r0 = pointed ? 0 : random.uniform(0.1, 1),
                     r1 = i % 3 == 1 ? r0 : r0 + random.uniform(0.1, 1);
        const ValidatedShape valid = make(cone, {p.x, p.y, p.z, q.x, q.y, q.z, r0, r1});
        const ConeShape& shape = std::get<ConeShape>(valid.shape);
        const double far = i % 2 == 0 ? 1 : 1e4;
        const Vec3 o = random.direction() * (2 * far), d = normalize(p + random.in_box(0.7) - o);
        const auto h = intersect(valid.shape, o, d, kHuge);
        if (!h) continue;
        ++hits;
        const Vec3 at = o + d * h->t - shape.p0;
        const double height = dot(at, shape.axis), slope = (shape.r1 - shape.r0) / shape.length;
        const Vec3 radial = at - shape.axis * height;
        CHECK(height >= -kRounding * far);
        CHECK(height <= shape.length + kRounding * far);
        CHECK(std::abs(length(radial) - (shape.r0 + slope * height)) < kRounding * far);
        const Vec3 gradient = normalize(normalize(radial) - shape.axis * slope);
        CHECK(length(h->normal - gradient) < kRounding * far);
        // By the order of the roots: right for cylinders, while a ray steeper than a cone leaves it
        // by the first.
        if (shape.r0 == shape.r1) CHECK(h->front == (dot(h->normal, d) < 0));
    }
    CHECK(hits > 1000);
}

TEST_CASE("cones are open tubes with closed ends of their interval, cups and tubes face inward") {
    const ValidatedShape pipe = make(cylinder, {0, 0, 0, 0, 0, 2, 1});
    CHECK_FALSE(hit(pipe, {0.5, 0, 5}, {0, 0, -1}));  // through both ends
    CHECK(hit(pipe, {5, 0, 0}, {-1, 0, 0})->t == 4);  // the rim belongs to it
    CHECK(hit(pipe, {5, 0, 2}, {-1, 0, 0})->t == 4);
    CHECK_FALSE(hit(pipe, {5, 0, 2 + 1e-9}, {-1, 0, 0}));
    CHECK(hit(pipe, {0, 0, 3}, {1, 0, -2})->t == rounded(std::sqrt(5)));  // in through the top
    const ValidatedShape lining = make(tube, {0, 0, 0, 0, 0, 2, 1});
    CHECK(hit(lining, {5, 0, 1}, {-1, 0, 0})->normal == Vec3{-1, 0, 0});
    CHECK_FALSE(hit(lining, {5, 0, 1}, {-1, 0, 0})->front);
    CHECK(hit(lining, {0, 0, 1}, {-1, 0, 0})->front);

    const auto apex = hit(make(cone, {0, 0, 0, 0, 0, 2, 0, 1}), {-3, 0, 0}, {1, 0, 0});
    REQUIRE(apex);
    CHECK(apex->normal == Vec3{0, 0, -1});  // away from the body
    const auto cap = hit(make(cup, {0, 0, 0, 0, 0, 2, 0, 1}), {-3, 0, 0}, {1, 0, 0});
    REQUIRE(cap);
    CHECK(length(cap->normal) == 1);

    // almost along the axis: still where the surface is
    const auto steep =
        hit(make(cylinder, {0, 0, 0, 0, 0, 5000, 1}), {0.5, 0, 0}, normalize({5e-4, 0, 1}));
    REQUIRE(steep);
    // The square of the sine, 2.5e-7, is a difference of numbers near 1: 2^-52 / 2.5e-7 is 1e-9.
    CHECK(steep->t == within(1e-9, std::hypot(1000, 0.5)));
}

TEST_CASE("a ring is met between its radii, both included, and not edge-on") {
    const ValidatedShape disc = make(ring, {0, 0, 1, 0, 0, 2, 0.5, 2});
    for (const auto& [x, is_hit] : {std::pair(0.4999, false), std::pair(0.5, true),
                                    std::pair(2.0, true), std::pair(2.0001, false)}) {
        CHECK(hit(disc, {x, 0, 5}, {0, 0, -1}).has_value() == is_hit);
    }
    CHECK(hit(disc, {1, 0, 5}, {0, 0, -1})->front);
    CHECK_FALSE(hit(disc, {1, 0, -5}, {0, 0, 1})->front);
    CHECK(hit(disc, {1, 0, -5}, {0, 0, 1})->normal == Vec3{0, 0, 1});
    CHECK_FALSE(hit(disc, {-5, 0, 1 + 1e-6}, {1, 0, -1e-6}));
    CHECK(hit(disc, {-5, 0, 1 + 5e-6}, {1, 0, -1.25e-6}).has_value());
}
