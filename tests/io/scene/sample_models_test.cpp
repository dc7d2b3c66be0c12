// Radiance's own sample models are read whole: counts, names, and rays that Radiance traced through
// them.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/math/vec3.h"
#include "io/scene/file_resources.h"
#include "io/scene/scene_reader.h"
#include "tests/all_primitives.h"
#include "tests/shared_data.h"
#include "tests/test_scene.h"
#include "tests/tolerance.h"

namespace lightwalk {
namespace {

using test::printed;

const std::string kCabin = "pattmats cabin bathroom furniture winpanes.rad mirrors.rad ";
const std::string kSummer = kCabin + "summerday landscape lights.off daywindows";
const std::string kNight = kCabin + "lights";

struct Sample {
    std::shared_ptr<const Model> model;
    std::map<std::string, int> counts;  ///< of primitives, by type
    std::vector<std::string> warnings;
};

Sample read_sample(const std::string& directory, const std::string& files) {
    std::istringstream stream(files);
    std::vector<std::string> names;
    for (std::string name; stream >> name;) names.push_back(name);
    test::Silence silence;
    const SceneReadOptions options{LibraryPath({".", "../lib"}), false, directory};
    Sample sample{read_scene(names, options, silence), {}, silence.messages};
    for (const Primitive& p : test::all_primitives(*sample.model)) {
        ++sample.counts[std::string(to_string(p.type))];
    }
    return sample;
}

bool names_resolve(const Model& model) {
    for (std::size_t i = 0; i < model.modifiers.size(); ++i) {
        const Primitive& p = model.modifiers[i];
        if (p.modifier >= static_cast<std::int32_t>(i)) return false;
        for (const std::int32_t reference : p.references) {
            if (reference == kUndefinedIndex) return false;
        }
    }
    for (std::size_t i = 0; i < model.surfaces.size(); ++i) {
        if (model.surfaces.modifier(i) >= static_cast<std::int32_t>(model.modifiers.size()))
            return false;
    }
    return true;
}

/// Distance of a point from the plane, sphere or axis of a surface; 0 for what is not local.
double distance_from(const Primitive& p, const Vec3& point) {
    const std::vector<double>& a = p.reals;
    const auto at = [&](std::size_t i) { return Vec3{a[i], a[i + 1], a[i + 2]}; };
    switch (p.type) {
        case PrimitiveType::polygon: {
            Vec3 normal;
            for (std::size_t i = 6; i < a.size(); i += 3) {
                normal += cross(at(i - 3) - at(0), at(i) - at(0));
            }
            return std::abs(dot(normalize(normal), point - at(0)));
        }
        case PrimitiveType::sphere:
        case PrimitiveType::bubble:
            return std::abs(length(point - at(0)) - a[3]);
        case PrimitiveType::ring:
            return std::abs(dot(normalize(at(3)), point - at(0)));
        case PrimitiveType::cylinder:
        case PrimitiveType::tube: {
            const Vec3 axis = normalize(at(3) - at(0));
            return std::abs(length(cross(axis, point - at(0))) - a[6]);
        }
        default:
            return 0;
    }
}

struct HitRecord {
    Vec3 point;
    std::string surface, modifier;
};

std::vector<HitRecord> read_hits(const std::string& file) {
    std::vector<HitRecord> hits;
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(
        popen(("zcat '" + file + "'").c_str(), "r"), pclose);
    REQUIRE(pipe);
    std::array<char, 4096> line{};
    while (std::fgets(line.data(), static_cast<int>(line.size()), pipe.get()) != nullptr) {
        std::vector<std::string> fields;
        std::istringstream stream(line.data());
        for (std::string field; std::getline(stream, field, '\t');) fields.push_back(field);
        if (fields.size() < 22 || fields[0][0] == '#') continue;
        const auto number = [&](std::size_t i) { return std::stod(fields[i]); };
        hits.push_back({{number(6), number(7), number(8)}, fields[20], fields[21]});
    }
    return hits;
}

/// Every hit that Radiance reports lies on a surface of that name and modifier in the model. Hits
/// inside instances are told by the modifiers of their octrees.
void check_hits(const Sample& sample, const std::string& file,
                const std::set<std::string>& instanced) {
    std::multimap<std::pair<std::string, std::string>, const Primitive*> surfaces;
    const std::vector<Primitive> all = test::surfaces_of(*sample.model);
    for (const Primitive& p : all) {
        if (p.modifier < 0) continue;
        const std::string& modifier =
            sample.model->modifiers[static_cast<std::size_t>(p.modifier)].name;
        surfaces.emplace(std::pair{p.name, modifier}, &p);
    }
    int found = 0;
    for (const HitRecord& hit : read_hits(file)) {
        if (instanced.count(hit.modifier) != 0 || hit.surface == "*") continue;
        CAPTURE(hit.surface);
        CAPTURE(hit.modifier);
        const auto [begin, end] = surfaces.equal_range({hit.surface, hit.modifier});
        double nearest = 1e10;
        for (auto at = begin; at != end; ++at) {
            nearest = std::min(nearest, distance_from(*at->second, hit.point));
        }
        CHECK(nearest < 1e-4 * (1 + length(hit.point)));  // points have 7 digits
        ++found;
    }
    CHECK(found > 20);
}

TEST_CASE("the cabin on a summer day is read whole") {
    LIGHTWALK_NEEDS_SHARED(cabin, "scenes/cabin");
    const Sample sample = read_sample(cabin, kSummer);
    CHECK(sample.warnings.empty());
    CHECK(sample.model->size() == 4118);  // what Radiance's oconv counts
    const std::map<std::string, int> expected = {
        {"alias", 30}, {"brightfunc", 13}, {"colorpict", 9}, {"cone", 149},     {"cylinder", 642},
        {"glass", 2},  {"glow", 2},        {"illum", 1},     {"instance", 82},  {"light", 1},
        {"metal", 2},  {"mirror", 2},      {"plastic", 23},  {"polygon", 1963}, {"ring", 18},
        {"source", 3}, {"sphere", 511},    {"texfunc", 665}};
    CHECK(sample.counts == expected);
    CHECK(names_resolve(*sample.model));
    for (const char* view : {"living", "living2", "bath", "ext.ne"}) {
        LIGHTWALK_NEEDS_SHARED(rays, "reference/rays/summer-" + std::string(view) + ".tsv.gz");
        check_hits(sample, rays, {"leaf_mat", "my_bark_mat"});
    }
}

TEST_CASE("the cabin at night is read whole") {
    LIGHTWALK_NEEDS_SHARED(cabin, "scenes/cabin");
    const Sample sample = read_sample(cabin, kNight);
    CHECK(names_resolve(*sample.model));
    for (const char* view : {"living2", "dresser"}) {
        LIGHTWALK_NEEDS_SHARED(rays, "reference/rays/night-" + std::string(view) + ".tsv.gz");
        check_hits(sample, rays, {});
    }
}

TEST_CASE("the virtual office and the example rooms are read whole") {
    LIGHTWALK_NEEDS_SHARED(office, "scenes/virtual");
    const Sample sample = read_sample(office, "plainoff.rad environ.rad furniture.rad");
    CHECK(names_resolve(*sample.model));
    LIGHTWALK_NEEDS_SHARED(rays, "reference/rays/virtual-back.tsv.gz");
    check_hits(sample, rays, {});
    LIGHTWALK_NEEDS_SHARED(misc, "scenes/misc");
    CHECK(sample.warnings.empty());
    CHECK(read_sample(misc, "examp").model->size() == 12);
    CHECK(read_sample(misc, "daffodil").counts["ring"] == 6);
}

TEST_CASE("the cabin's trees: one octree inside another, three deep") {
    LIGHTWALK_NEEDS_SHARED(library, "scenes/lib");
    test::Silence silence;
    FileResources resources(LibraryPath({library}), false, silence);
    const auto tree = resources.octree("tree.oct"), sapling = resources.octree("sapling.oct"),
               needles = resources.octree("n.150.oct");
    CHECK(tree->size() == 13207);
    CHECK(sapling->size() == 271);
    CHECK(needles->size() == 150);
    std::set<std::string> nested;
    for (const Primitive& p : test::surfaces_of(*tree)) {
        if (p.type == PrimitiveType::instance) nested.insert(p.strings.at(0));
    }
    CHECK(nested == std::set<std::string>{"n.150.oct"});
    CHECK(tree->header.size() == 2);
    CHECK(tree->cube->size == printed(12, 56.0034329464));
    CHECK(names_resolve(*tree));
}

}  // namespace
}  // namespace lightwalk
