// genprism: a prism over a polygon, with square or rounded edges. See Radiance's manual page
// genprism(1).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "io/generators/generator.h"
#include "io/generators/generator_words.h"
#include "io/generators/scene_writer.h"
#include "io/generators/surface_data.h"

namespace lightwalk {
namespace {

constexpr std::string_view kGenprismUsage =
    "material name { - | file | N x1 y1 ... xN yN } [-l lx ly lz] [-r radius] [-c] [-e]";
constexpr std::size_t kMaxVertices = 1024;
constexpr std::size_t kMaxFileBytes = std::size_t{1} << 20;

/// Vectors in the plane z = 0.
struct Vec2 {
    double x = 0, y = 0;
};
Vec2 operator+(const Vec2& a, const Vec2& b) {
    return {a.x + b.x, a.y + b.y};
}
Vec2 operator-(const Vec2& a, const Vec2& b) {
    return {a.x - b.x, a.y - b.y};
}
Vec2 operator*(const Vec2& a, double s) {
    return {a.x * s, a.y * s};
}

struct PrismOptions {
    std::string material, name;
    std::vector<Vec2> base;
    Vec3 extrusion{0, 0, 1};
    double radius = 0;
    bool closed = true;  ///< with the side from the last vertex to the first
    bool ends = true;

    [[nodiscard]] std::size_t sides() const { return base.size() - (closed ? 0 : 1); }
    [[nodiscard]] double sign() const { return extrusion.z < 0 ? -1 : 1; }
};

std::vector<Vec2> pairs(const std::vector<double>& numbers, const std::string& where) {
    if (numbers.size() % 2 != 0) throw InputError({where, 0}, "a y coordinate is missing");
    std::vector<Vec2> result;
    for (std::size_t i = 0; i < numbers.size(); i += 2) {
        result.push_back({numbers[i], numbers[i + 1]});
    }
    return result;
}

std::vector<Vec2> read_base(GeneratorWords& words, GeneratorContext& context) {
    if (!words.at_end() && words.peek()[0] >= '0' && words.peek()[0] <= '9') {
        const long count = words.integer("number of vertices", 3, static_cast<long>(kMaxVertices));
        std::vector<Vec2> base(static_cast<std::size_t>(count));
        for (Vec2& v : base) {
            v.x = words.real("x coordinate");
            v.y = words.real("y coordinate");
        }
        return base;
    }
    const std::string source = words.text("vertices");
    const bool standard = source == "-";
    const std::string path = path_from(context.directory, source);
    if (!standard && !context.library.files().readable(path))
        words.fail("cannot open vertex file \"" + path + "\"");
    const std::string text =
        standard ? context.standard_input() : context.library.files().read(path, kMaxFileBytes);
    const std::string where = standard ? "standard input" : source;
    std::vector<Vec2> base = pairs(parse_numbers(text, where, 2 * kMaxVertices), where);
    if (base.size() < 3) throw InputError({where, 0}, "expected at least 3 vertices");
    return base;
}

PrismOptions parse(GeneratorWords& words, GeneratorContext& context) {
    PrismOptions prism;
    prism.material = words.text("material");
    prism.name = words.text("name");
    prism.base = read_base(words, context);
    while (!words.at_end()) {
        if (words.accept("-l")) {
            for (std::size_t i = 0; i < 3; ++i) prism.extrusion[i] = words.real("extrusion");
        } else if (words.accept("-r")) {
            prism.radius = words.real("radius");
        } else if (words.accept("-c")) {
            prism.closed = !prism.closed;
        } else if (words.accept("-e")) {
            prism.ends = !prism.ends;
        } else {
            words.unknown_option();
        }
    }
    if (std::abs(prism.extrusion.z) <= kEpsilon) words.fail("the extrusion's z is zero");
    if (prism.radius > std::abs(prism.extrusion.z)) {
        words.fail("the radius is larger than the extrusion's z");
    }
    return prism;
}

std::string numbered(const std::string& name, const char* part, std::size_t number) {
    return name + "." + part + std::to_string(number);
}

/// The polygon at height z = 0 and its copy after the extrusion, in reverse order.
void write_ends(const PrismOptions& prism, const std::vector<Vec2>& outline, SceneWriter& out) {
    std::vector<Vec3> bottom;
    std::vector<Vec3> top;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Vec2& last = outline[outline.size() - 1 - i];
        bottom.push_back({outline[i].x, outline[i].y, 0});
        top.push_back(Vec3{last.x, last.y, 0} + prism.extrusion);
    }
    out.polygon(prism.material, prism.name + ".b", bottom);
    out.polygon(prism.material, prism.name + ".t", top);
}

void write_plain(const PrismOptions& prism, SceneWriter& out) {
    if (prism.ends) write_ends(prism, prism.base, out);
    for (std::size_t i = 0; i < prism.sides(); ++i) {
        const Vec2& p = prism.base[i];
        const Vec2& q = prism.base[(i + 1) % prism.base.size()];
        const Vec3 a{p.x, p.y, 0};
        const Vec3 b{q.x, q.y, 0};
        const std::array<Vec3, 4> corners = {a, a + prism.extrusion, b + prism.extrusion, b};
        out.polygon(prism.material, numbered(prism.name, "", i + 1), corners);
    }
}

/// A prism whose edges are cylinders and whose vertices are spheres.
class RoundedPrism {
  public:
    RoundedPrism(const PrismOptions& prism, const std::string& program)
        : prism_(prism), r_(prism.sign() * prism.radius) {
        const std::size_t n = prism.base.size();
        for (std::size_t i = 0; i < n; ++i) {
            const Vec2 side = prism.base[(i + n - 1) % n] - prism.base[i];
            const double length = std::hypot(side.x, side.y);
            if (length == 0) {
                throw InputError(program + ": vertices " + std::to_string((i + n - 1) % n + 1) +
                                 " and " + std::to_string(i + 1) + " are the same");
            }
            back_.push_back(side * (1 / length));
        }
        for (std::size_t i = 0; i < n; ++i) {
            const Vec2& u = back_[i];
            const Vec2& w = back_[(i + 1) % n];
            const double cosine = u.x * w.x + u.y * w.y;
            if (cosine <= -1 + kEpsilon) {
                throw InputError(program + ": the sides at vertex " + std::to_string(i + 1) +
                                 " lie on each other");
            }
            const double half = std::sqrt(std::max(0.0, (1 - cosine) / (1 + cosine)));
            setback_.push_back(w.x * u.y - w.y * u.x < 0 ? -half : half);
            const double g = setback_.back();
            center_.push_back(prism.base[i] + Vec2{g * u.x - u.y, g * u.y + u.x} * r_);
        }
    }

    void write(SceneWriter& out) const {
        if (prism_.ends) {
            write_ends(prism_, center_, out);
            write_end_edges("bc", "be", {0, 0, r_}, out);
            const Vec3& l = prism_.extrusion;
            write_end_edges("tc", "te", {l.x, l.y, l.z - r_}, out);
        }
        for (std::size_t i = 0; i < prism_.sides(); ++i) write_side(i, out);
    }

  private:
    [[nodiscard]] Vec3 center(std::size_t i, const Vec3& shift) const {
        return Vec3{center_[i].x, center_[i].y, 0} + shift;
    }

    void write_end_edges(const char* corner, const char* edge, const Vec3& shift,
                         SceneWriter& out) const {
        const std::size_t n = center_.size();
        for (std::size_t i = 0; i < n; ++i) {
            if (prism_.sign() * setback_[i] > 0) {
                out.sphere(prism_.material, numbered(prism_.name, corner, i + 1), center(i, shift),
                           prism_.radius);
            }
            out.cylinder(prism_.material, numbered(prism_.name, edge, i + 1),
                         center((i + n - 1) % n, shift), center(i, shift), prism_.radius);
        }
    }

    void write_side(std::size_t i, SceneWriter& out) const {
        const std::size_t j = (i + 1) % center_.size();
        const Vec2& u = back_[j];
        const Vec3& l = prism_.extrusion;
        // Where the tangent plane of a slanted side touches the cylinders, in units of the radius.
        Vec3 tangent;
        const double sine = prism_.sign() * (l.y * u.x - l.x * u.y) / length(l);
        if (std::abs(sine) > kEpsilon) {
            const double cosine = std::sqrt(1 - sine * sine);
            tangent = {(cosine - 1) * u.y, (1 - cosine) * u.x, sine};
        }
        const Vec2 flat{tangent.x, tangent.y};
        const Vec2 a = prism_.base[i] + (flat - u * setback_[i]) * r_;
        const Vec2 b = prism_.base[j] + (flat + u * setback_[j]) * r_;
        const double low = r_ * (tangent.z + 1);
        const double high = l.z + r_ * (tangent.z - 1);
        const std::array<Vec3, 4> corners = {{{a.x, a.y, low},
                                              {a.x + l.x, a.y + l.y, high},
                                              {b.x + l.x, b.y + l.y, high},
                                              {b.x, b.y, low}}};
        out.polygon(prism_.material, numbered(prism_.name, "", i + 1), corners);
        if (prism_.sign() * setback_[j] < 0) return;
        out.cylinder(prism_.material, numbered(prism_.name, "e", i + 1), center(j, {0, 0, r_}),
                     center(j, {l.x, l.y, l.z - r_}), prism_.radius);
    }

    const PrismOptions& prism_;
    double r_;                     ///< negative when the prism points down
    std::vector<Vec2> back_;       ///< unit vector from vertex i to vertex i - 1
    std::vector<double> setback_;  ///< how far the rounding's centre is set back along it, in radii
    std::vector<Vec2> center_;     ///< centre of the rounded corner at each vertex
};

}  // namespace

std::string run_genprism(std::span<const std::string> args, GeneratorContext& context) {
    GeneratorWords words(args, kGenprismUsage);
    const PrismOptions prism = parse(words, context);
    SceneWriter out(args);
    if (prism.radius > kEpsilon)
        RoundedPrism(prism, words.program()).write(out);
    else
        write_plain(prism, out);
    return out.release();
}

}  // namespace lightwalk
