// Light of surfaces that coincide with others: a shadow ray finds what every other ray would see.
#include <doctest/doctest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "tests/test_scene.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const std::string kGreyFloor =
    "void plastic grey\n0\n0\n5 .5 .5 .5 0 0\ngrey polygon floor\n0\n0\n12 -50 -50 0 50 -50 0 50 "
    "50 0 -50 50 0\n";
const std::string kGlowOfLamp = "void glow lamp\n0\n0\n4 60 55 50 20\n";
const std::string kLightOfLamp = "void light lamp\n0\n0\n3 60 55 50\n";

/// A polygon whose corners are turned about the z axis.
std::string turned_polygon(const std::string& modifier, const std::string& name, double degrees,
                           const std::vector<Vec3>& corners) {
    std::ostringstream text;
    text.precision(17);
    const double c = std::cos(degrees * kPi / 180), s = std::sin(degrees * kPi / 180);
    text << modifier << " polygon " << name << "\n0\n0\n" << 3 * corners.size();
    for (const Vec3& p : corners)
        text << ' ' << c * p.x - s * p.y << ' ' << s * p.x + c * p.y << ' ' << p.z;
    return text.str() + '\n';
}

std::string panel_at(double height, double degrees) {
    return turned_polygon(
        "lamp", "p", degrees,
        {{-.3, -.3, height}, {-.3, .3, height}, {.3, .3, height}, {.3, -.3, height}});
}

/// A shape of a lamp at a height.
std::string lamp_at(const std::string& shape, double height) {
    std::ostringstream text;
    text.precision(17);
    if (shape == "panel") return panel_at(height, 0);
    if (shape == "turned panel") return panel_at(height, 28.1);
    text << "lamp " << shape << " s\n0\n0\n";
    if (shape == "sphere") text << "4 0 0 " << height << " .2\n";
    if (shape == "ring") text << "8 0 0 " << height << " .1 .2 -1 0 .3\n";
    if (shape == "cylinder") text << "7 -.5 .1 " << height << " .5 0 " << height << " .05\n";
    return text.str();
}

struct FloorLight {
    double sum = 0;
    int lit = 0;
};

/// Of points on the floor along a line that no axis runs along.
FloorLight floor_light(const std::string& scene_text, bool in_batches = false) {
    TestScene scene(kGreyFloor + scene_text);
    std::vector<Ray> rays;
    for (int i = 0; i < 60; ++i) {
        const Vec3 eye{0.13 + 0.031 * i, -0.07 + 0.05 * i, 0.5};
        rays.push_back(
            scene.tracer.primary(eye, {0, 0, -1}, 0, RandomStream::of_pixel(7, 0, 0, 0)));
    }
    if (in_batches) {
        std::vector<Hit> hits;
        for (const Ray& ray : rays)
            hits.push_back(scene.tracer.scene().geometry().intersect(ray.segment()));
        scene.tracer.shade_hits(rays, hits, scene.context);
    } else {
        for (Ray& ray : rays) scene.tracer.trace(ray, scene.context);
    }
    FloorLight found;
    for (const Ray& ray : rays) {
        found.sum += static_cast<double>(ray.value.r);
        found.lit += ray.value.r > 0 ? 1 : 0;
    }
    return found;
}

}  // namespace

TEST_CASE("of coincident lamps one shines, whatever their shape, material, distance and number") {
    for (const std::string& material :
         {kLightOfLamp, kGlowOfLamp, std::string("void illum lamp\n0\n0\n3 60 55 50\n"),
          std::string(
              "void glass pane\n0\n0\n3 .5 .5 .5\nvoid illum lamp\n1 pane\n0\n3 60 55 50\n"),
          std::string("void spotlight lamp\n0\n0\n7 60 55 50 170 0 0 -1\n"),
          std::string("void brightfunc half\n2 .5 .\n0\n0\nhalf light lamp\n0\n0\n3 60 55 50\n")}) {
        for (const char* shape : {"panel", "turned panel", "sphere", "ring", "cylinder"}) {
            const FloorLight one = floor_light(material + lamp_at(shape, 3));
            REQUIRE(one.lit > 30);
            for (const double step : {0.0, 1e-12, 1e-9, 6e-7, 1e-6, -1e-6, 1.7e-6}) {
                for (const int count : {2, 3, 5}) {
                    CAPTURE(material);
                    CAPTURE(shape);
                    CAPTURE(step);
                    CAPTURE(count);
                    std::string lamps = material;
                    for (int i = 0; i < count; ++i) lamps += lamp_at(shape, 3 + step * i);
                    const FloorLight all = floor_light(lamps);
                    CHECK(all.lit == one.lit);
                    // A lamp that is moved by some micrometres lights the floor that much
                    // differently.
                    CHECK(all.sum == within(1e-5, one.sum));
                }
            }
        }
    }
}

TEST_CASE("coincident lamps behind a pane and in batches shine as one") {
    const std::string pane =
        "void glass pane\n0\n0\n3 .9 .9 .9\npane ring w\n0\n0\n8 0 0 2 0 0 1 0 9\n";
    for (const std::string& before : {std::string(), pane}) {
        const FloorLight one = floor_light(before + kLightOfLamp + lamp_at("turned panel", 3));
        const std::string two =
            before + kLightOfLamp + lamp_at("turned panel", 3) + lamp_at("turned panel", 3 + 3e-7);
        for (const bool in_batches : {false, true}) {
            CHECK(floor_light(two, in_batches).sum == within(1e-5, one.sum));
            CHECK(floor_light(two, in_batches).lit == 60);
        }
    }
}

TEST_CASE("a window that lies on a wall shines if it is defined later, however both are turned") {
    for (const double degrees : {0.0, 31.7, 77.0, 123.4}) {
        CAPTURE(degrees);
        const std::string wall = turned_polygon("white", "wall", degrees,
                                                {{9, -9, 0}, {9, 9, 0}, {9, 9, 3}, {9, -9, 3}}) +
                                 turned_polygon("white", "back", degrees,
                                                {{-9, -9, 0}, {-9, -9, 3}, {-9, 9, 3}, {-9, 9, 0}});
        const std::string window = turned_polygon(
            "day", "window", degrees, {{9, -3, .7}, {9, -3, 2.7}, {9, 3, 2.7}, {9, 3, .7}});
        const std::string paint = "void plastic white\n0\n0\n5 .5 .5 .5 0 0\n";
        // Front over back comes before the order of definition: the wall has to face the room too.
        const std::string facing = turned_polygon("white", "wall", degrees,
                                                  {{9, -9, 0}, {9, -9, 3}, {9, 9, 3}, {9, 9, 0}});
        for (const char* type : {"illum", "light", "glow"}) {
            const std::string day = std::string("void ") + type + " day\n0\n0\n" +
                                    (type == std::string("glow") ? "4 10 9 8 99\n" : "3 10 9 8\n");
            const FloorLight alone = floor_light(day + window);
            REQUIRE(alone.lit == 60);
            CHECK(floor_light(paint + facing + day + window).sum == rounded(alone.sum));
            CHECK(floor_light(day + window + paint + facing).lit == 0);
            CHECK(floor_light(day + window + paint + wall).sum == rounded(alone.sum));
        }
    }
}

TEST_CASE("a mirror that lies on a wall throws light if it is defined later") {
    for (const double degrees : {0.0, -31.7}) {
        CAPTURE(degrees);
        const std::vector<Vec3> corners{{3, -5, 0}, {3, -5, 5}, {3, 5, 5}, {3, 5, 0}};
        const std::string white = "void plastic white\n0\n0\n5 .5 .5 .5 0 0\n" +
                                  turned_polygon("white", "wall", degrees, corners),
                          silver = "void mirror silver\n0\n0\n3 1 1 1\n" +
                                   turned_polygon("silver", "m", degrees, corners),
                          lamp = kLightOfLamp + "lamp sphere s\n0\n0\n4 0 0 2 .1\n";
        const double alone = floor_light(lamp).sum, mirrored = floor_light(lamp + silver).sum;
        REQUIRE(mirrored > 1.01 * alone);
        CHECK(floor_light(lamp + white + silver).sum == rounded(mirrored));
        CHECK(floor_light(lamp + silver + white).sum == rounded(alone));
    }
}
