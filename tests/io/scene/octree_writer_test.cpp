#include "io/scene/octree_writer.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "core/math/portable_numbers.h"
#include "io/scene/binary_models.h"
#include "io/scene/scene_reader.h"
#include "tests/test_scene.h"

namespace lightwalk {
namespace {

std::shared_ptr<const Model> parsed(const std::string& text) {
    test::Silence silence;
    return parse_scene(text, "test.rad", {}, silence);
}

std::string octree_of(const Model& model, const OctreeOptions& options = {}) {
    test::Silence silence;
    test::MemoryResources resources;
    return encode_octree(model, resources, options, silence);
}

std::string message_of(const Model& model, const OctreeOptions& options = {}) {
    try {
        static_cast<void>(octree_of(model, options));
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

/// What the leaf names that holds a point.
class TreeWalk {
  public:
    explicit TreeWalk(std::string_view tree) : tree_(tree) {}

    std::vector<std::uint64_t> leaf(const Vec3& point, const Vec3& corner, double size) const {
        std::string_view rest = tree_;
        return node(rest, point, corner, size, true);
    }

  private:
    /// Reads a node, and answers where it holds the point.
    std::vector<std::uint64_t> node(std::string_view& rest, const Vec3& p, const Vec3& corner,
                                    double size, bool wanted) const {
        std::vector<std::uint64_t> found;
        const std::uint64_t tag = take_unsigned_integer(rest, 1);
        if (tag == 1) {
            for (std::uint64_t n = take_unsigned_integer(rest, 4); n > 0; --n)
                found.push_back(take_unsigned_integer(rest, 4));
        }
        for (unsigned k = 0; tag == 2 && k < 8; ++k) {
            const double half = size / 2;
            const Vec3 low = corner + Vec3{k & 1 ? half : 0, k & 2 ? half : 0, k & 4 ? half : 0};
            const auto in = [half](double x, double from) { return x >= from && x < from + half; };
            const bool mine = wanted && in(p.x, low.x) && in(p.y, low.y) && in(p.z, low.z);
            std::vector<std::uint64_t> below = node(rest, p, low, half, mine);
            if (mine) found = std::move(below);
        }
        return found;
    }

    std::string_view tree_;
};

std::string number(double value) {
    return ' ' + std::to_string(value);
}

}  // namespace

TEST_CASE("octree writer: what is read again is the model, aliases and shadowed names included") {
    const auto model = parsed(R"(
void plastic red 0 0 5 .8 .1 .1 0 0
void alias paint red
red sphere a 0 0 4 1 2 3 .1
void plastic red 0 0 5 .1 .1 .8 0 0
void alias late paint
void mixfunc mix 4 red paint .25 . 0 0
void glow shine 0 0 4 1 2 3 -1
shine source sun 0 0 4 0 0 1 .5
paint polygon b 0 0 9 0 0 0 1 0 0 0 1 0
late ring c 0 0 8 1 1 1 0 0 1 0 .3333333333333
)");
    const OctreeContents again = decode_octree(octree_of(*model), "test.oct");
    REQUIRE(again.model);
    const Model& read = *again.model;
    CHECK(again.objects == model->size());
    REQUIRE(read.modifiers.size() == model->modifiers.size());
    REQUIRE(read.surfaces.size() == model->surfaces.size());
    for (std::size_t i = 0; i < read.surfaces.size(); ++i) {
        CHECK(read.surfaces[i].type == model->surfaces[i].type);
        CHECK(read.surfaces[i].name == model->surfaces[i].name);
        CHECK(read.surfaces[i].modifier == model->surfaces[i].modifier);
        REQUIRE(read.surfaces[i].reals.size() == model->surfaces[i].reals.size());
        for (std::size_t k = 0; k < read.surfaces[i].reals.size(); ++k)
            CHECK(std::abs(read.surfaces[i].reals[k] - model->surfaces[i].reals[k]) <=
                  4.7e-10 * std::abs(model->surfaces[i].reals[k]));
    }
    // What each modifier stands for: an alias of a name that has another meaning by now, too.
    const auto meant = [](const Model& of, std::size_t i) {
        const Primitive& own = of.modifiers[i];
        const bool alias = own.type == PrimitiveType::alias;
        return alias ? of.modifiers[static_cast<std::size_t>(own.references[0])] : own;
    };
    for (std::size_t i = 0; i < read.modifiers.size(); ++i) {
        CAPTURE(i);
        CHECK(read.modifiers[i].name == model->modifiers[i].name);
        CHECK(meant(read, i).type == meant(*model, i).type);
        REQUIRE(meant(read, i).reals.size() == meant(*model, i).reals.size());
        if (!meant(read, i).reals.empty())
            CHECK(meant(read, i).reals[0] == doctest::Approx(meant(*model, i).reals[0]));
    }
}

TEST_CASE("octree writer: every point of a surface lies in a leaf that names the surface") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    std::string text = "void plastic m 0 0 5 .5 .5 .5 0 0\n";
    std::vector<Vec3> points;
    std::vector<std::uint64_t> owners;
    for (std::uint64_t i = 0; i < 300; ++i) {
        const auto place = [&] { return Vec3{10 * unit(random), 10 * unit(random), unit(random)}; };
        const Vec3 c = place();
        if (i % 3 == 0) {  // of a sphere, at its poles and equator
            const double r = .05 + .3 * unit(random);
            text += "m sphere s 0 0 4" + number(c.x) + number(c.y) + number(c.z) + number(r) + '\n';
            for (const Vec3& d : {Vec3{0, 0, 1}, Vec3{-1, 0, 0}, Vec3{.6, .8, 0}})
                points.push_back(c + d * r), owners.push_back(1 + i);
            continue;
        }
        const auto near = [&] { return c + Vec3{unit(random), unit(random), -unit(random)}; };
        const Vec3 a = near(), b = near();
        text += "m polygon p 0 0 9";
        for (const Vec3& v : {a, b, c}) text += number(v.x) + number(v.y) + number(v.z);
        text += '\n';
        for (int k = 0; k < 10; ++k) {
            const double u = unit(random), v = unit(random) * (1 - u);
            points.push_back(a + (b - a) * u + (c - a) * v);
            owners.push_back(1 + i);
        }
    }
    const std::string bytes = octree_of(*parsed(text));
    const OctreeContents again = decode_octree(bytes, "test.oct");
    const Vec3 corner{again.cube.x, again.cube.y, again.cube.z};
    // The tree begins behind the number of objects, which the empty list of files precedes.
    const std::string count{'\0', '\0', '\0', '\0', '\x01', '\x2d'};
    const std::size_t begin = bytes.find(count);
    REQUIRE(begin != std::string::npos);
    TreeWalk tree(std::string_view(bytes).substr(begin + count.size()));
    std::size_t largest = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::vector<std::uint64_t> leaf = tree.leaf(points[i], corner, again.cube.size);
        CAPTURE(i);
        CHECK(std::ranges::find(leaf, owners[i]) != leaf.end());
        CHECK(std::ranges::is_sorted(leaf));
        largest = std::max(largest, leaf.size());
    }
    CHECK(largest < 100);  // it tells surfaces apart
}

TEST_CASE("octree writer: what an octree cannot hold is an error") {
    std::string many = "void plastic m 0 0 5 .5 .5 .5 0 0\n";
    for (int i = 0; i < 512; ++i) many += "m sphere s 0 0 4 0 0 0 1\n";
    CHECK(message_of(*parsed(many)).find("512 surfaces that meet in one place") !=
          std::string::npos);
    OctreeOptions small;
    small.cube = ModelCube{0, 0, 0, 1};
    small.strict = true;
    const auto sphere = parsed("void plastic m 0 0 5 .5 .5 .5 0 0\nm sphere s 0 0 4 0 0 0 1\n");
    CHECK(message_of(*sphere, small) == "boundary does not encompass scene");
    small.strict = false;
    CHECK(message_of(*sphere, small) == "no error");
    CHECK(message_of(*parsed("void instance i 1 nosuch.oct 0 0\n")) != "no error");
}

}  // namespace lightwalk
