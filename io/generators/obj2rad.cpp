// obj2rad: a Wavefront object file as polygons. See Radiance's manual page obj2rad(1).
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "io/formats/words.h"
#include "io/generators/generator.h"
#include "io/generators/generator_words.h"
#include "io/generators/scene_writer.h"
#include "io/wavefront/obj_mapping.h"

namespace lightwalk {
namespace {

constexpr std::string_view kObj2radUsage = "[-n] [-f] [-m mapfile] [-o name] [input]";
constexpr double kSmoothTolerance = 1e-6;  ///< of a normal that is the plane's
constexpr double kPlaneTolerance = 1e-5;   ///< of a plane's points, by the size of the face

class Obj2rad {
  public:
    Obj2rad(std::span<const std::string> args, GeneratorContext& context)
        : words_(args, kObj2radUsage), out_(args, context.output) {
        while (!words_.at_end() && words_.peek().starts_with('-') && words_.peek().size() > 1) {
            if (words_.accept("-f"))
                flat_ = true;
            else if (words_.accept("-n"))
                lists_ = true;
            else if (words_.accept("-m"))
                read_mapping(words_.text("mapfile"), context);
            else if (words_.accept("-o"))
                name_ = words_.text("name");
            else
                words_.unknown_option();
        }
        if (words_.at_end()) {
            file_ = decode_obj(context.standard_input(), "standard input");
            return;
        }
        input_ = words_.text("input");
        const std::string path = path_from(context.directory, input_);
        if (!words_.at_end()) words_.fail("there is more than one input");
        file_ = decode_obj(context.library.files().read(path), path);
    }

    std::string run() {
        if (lists_) return obj_qualifiers(file_, input_);
        std::size_t number = 0;
        for (const ObjFile::Face& face : file_.faces) write(face, ++number);
        return out_.release();
    }

  private:
    void read_mapping(const std::string& file, GeneratorContext& context) {
        const std::string path = path_from(context.directory, file);
        rules_ = decode_obj_mapping(context.library.files().read(path), path);
        for (const ObjRule& rule : rules_) {
            if (std::ranges::find(rule.conditions, ObjRule::Qualifier::map,
                                  &ObjRule::Condition::qualifier) == rule.conditions.end())
                continue;
            context.warnings.warn(path + ": conditions on a Map are never met, as in Radiance");
            return;
        }
    }

    /// The object's, or else its groups'.
    [[nodiscard]] std::string name_of(const ObjFile::Face& face) const {
        const bool is_object = face.object != ObjFile::kNone;
        const std::uint32_t named = is_object ? face.object : face.groups;
        if (named == ObjFile::kNone) return name_;
        std::string name;
        std::string_view words = file_.names[named];
        if (is_object) return std::string(take_word(words));
        for (std::string_view word = take_word(words); !word.empty(); word = take_word(words))
            name.append(name.empty() ? "" : ".").append(word);
        return name;
    }

    /// Nothing for faces that are left out. An empty mapping maps nothing.
    [[nodiscard]] std::optional<std::string> material_for(const ObjFile::Face& face,
                                                          std::size_t number) const {
        if (!rules_.empty()) return mapped_material(rules_, file_, face, number);
        std::string_view given = file_.material_of(face);
        const std::string_view material = take_word(given);
        return std::string(material.empty() ? "white" : material);
    }

    void write(const ObjFile::Face& face, std::size_t number) {
        const std::optional<std::string> mapped = material_for(face, number);
        if (!mapped) return;
        const std::string& material = *mapped;
        const std::string name = name_of(face) + "." + std::to_string(number);
        const std::span<const ObjFile::Corner> corners = file_.corners_of(face);
        bool smooth = !flat_;
        for (const ObjFile::Corner& corner : corners)
            smooth = smooth && corner.normal != ObjFile::kNone;
        if (!smooth && (corners.size() == 3 || is_flat(corners))) {
            std::vector<Vec3> points;
            for (const ObjFile::Corner& corner : corners)
                points.push_back(file_.positions[corner.position]);
            out_.polygon(material, name, points);
            return;
        }
        for (const ObjTriangle& triangle : triangulate(file_, face, 1)) {
            const std::array<ObjFile::Corner, 3> three = {
                corners[triangle[0]], corners[triangle[1]], corners[triangle[2]]};
            write_triangle(three, material, name, smooth);
        }
    }

    void write_triangle(const std::array<ObjFile::Corner, 3>& corners, const std::string& material,
                        const std::string& name, bool smooth) {
        std::array<Vec3, 3> points, normals;
        for (std::size_t i = 0; i < 3; ++i) {
            points[i] = file_.positions[corners[i].position];
            if (smooth) normals[i] = file_.normals[corners[i].normal];
        }
        const bool textured = smooth && write_texture(points, normals, material);
        out_.polygon(textured ? "Phong" : material, name, points);
    }

    /// The texture that interpolates normals; false where the plane has them anyway.
    bool write_texture(const std::array<Vec3, 3>& p, const std::array<Vec3, 3>& normals,
                       const std::string& material) {
        const Vec3 normal = normalize(cross(p[1] - p[0], p[2] - p[0]));
        if (normal == Vec3{}) return false;
        bool bent = false;
        for (const Vec3& n : normals) bent = bent || length(n - normal) > kSmoothTolerance;
        if (!bent) return false;
        std::size_t axis = 0;
        for (std::size_t k = 1; k < 3; ++k)
            if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
        const std::size_t s = (axis + 1) % 3, t = (axis + 2) % 3;
        const Vec3 a = p[1] - p[0], b = p[2] - p[0];
        const double area = a[s] * b[t] - a[t] * b[s];
        std::vector<double> reals = {static_cast<double>(axis)};
        for (std::size_t c = 0; c < 3; ++c) {  // n = ds * s + dt * t + constant
            const double da = normals[1][c] - normals[0][c], db = normals[2][c] - normals[0][c];
            const double ds = (da * b[t] - db * a[t]) / area, dt = (db * a[s] - da * b[s]) / area;
            reals.insert(reals.end(), {ds, dt, normals[0][c] - ds * p[0][s] - dt * p[0][t]});
        }
        const std::array<std::string, 4> strings = {"dx", "dy", "dz", "tmesh.cal"};
        out_.write(material, "texfunc", "Phong", reals, strings);
        return true;
    }

    [[nodiscard]] bool is_flat(std::span<const ObjFile::Corner> corners) const {
        const Vec3& origin = file_.positions[corners[0].position];
        Vec3 normal;
        double size = 0;
        for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
            const Vec3 a = file_.positions[corners[i].position] - origin;
            normal += cross(a, file_.positions[corners[i + 1].position] - origin);
            size = std::max(size, length(a));
        }
        normal = normalize(normal);
        for (const ObjFile::Corner& corner : corners) {
            if (std::abs(dot(file_.positions[corner.position] - origin, normal)) >
                kPlaneTolerance * size)
                return false;
        }
        return true;
    }

    GeneratorWords words_;
    SceneWriter out_;
    bool flat_ = false, lists_ = false;
    std::vector<ObjRule> rules_;
    std::string input_ = "<stdin>";
    std::string name_ = "unnamed";
    ObjFile file_;
};

}  // namespace

std::string run_obj2rad(std::span<const std::string> args, GeneratorContext& context) {
    return Obj2rad(args, context).run();
}

}  // namespace lightwalk
