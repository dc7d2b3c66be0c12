// genworm: a tube of varying radius along a curve, made of spheres and the cones that touch them.
// See Radiance's manual page genworm(1).
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "io/generators/expressions.h"
#include "io/generators/generator.h"
#include "io/generators/generator_words.h"
#include "io/generators/scene_writer.h"

namespace lightwalk {
namespace {

constexpr std::string_view kGenwormUsage =
    "material name x(t) y(t) z(t) r(t) segments [-e expression] [-f file]";

struct Bead {
    Vec3 center;
    double radius = 0;
};

/// The cylinder or cone that touches both spheres; nothing when they have one centre and unlike
/// radii.
void write_joint(const std::string& material, const std::string& name, const Bead& a, const Bead& b,
                 SceneWriter& out) {
    const double difference = a.radius - b.radius;
    if (std::abs(difference) <= kEpsilon) {
        return out.cylinder(material, name, a.center, b.center, b.radius);
    }
    const Vec3 axis = b.center - a.center;
    const double square = length_squared(axis);
    if (square == 0) return;
    const double shift = difference / square;
    const double cosine = std::sqrt(std::max(0.0, 1 - difference * shift));
    const Vec3 p = a.center + axis * (shift * a.radius);
    const Vec3 q = b.center + axis * (shift * b.radius);
    out.write(material, "cone", name,
              std::array{p.x, p.y, p.z, q.x, q.y, q.z, cosine * a.radius, cosine * b.radius});
}

}  // namespace

std::string run_genworm(std::span<const std::string> args, GeneratorContext& context) {
    GeneratorWords words(args, kGenwormUsage);
    const std::string material = words.text("material");
    const std::string name = words.text("name");
    std::array<std::string, 4> body;
    for (std::string& text : body) text = words.text("function of t");
    const std::string count = words.text("number of segments");
    GeneratorExpressions expressions(context);
    while (!words.at_end()) {
        if (!expressions.accept_option(words)) words.unknown_option();
    }
    const std::size_t segments = expressions.count(words, count, "number of segments", kMaxPieces);
    const std::array<std::string, 4> names = {"X`SYS", "Y`SYS", "Z`SYS", "R`SYS"};
    for (std::size_t i = 0; i < names.size(); ++i) {
        expressions.define_function(words.program(), names[i], "t", body[i]);
    }
    CompiledFunctions curve(expressions.compile_program(words.program(), names, 1));

    SceneWriter out(args);
    Bead last;
    for (std::size_t i = 0; i <= segments; ++i) {
        const std::array<double, 1> t = {static_cast<double>(i) / static_cast<double>(segments)};
        const Bead bead{{curve(0, t), curve(1, t), curve(2, t)}, curve(3, t)};
        const auto part = [&name, i](const char* kind) {
            return std::string(name).append(kind).append(std::to_string(i));
        };
        if (i > 0) write_joint(material, part(".c"), last, bead, out);
        out.sphere(material, part(".s"), bead.center, bead.radius);
        last = bead;
    }
    expressions.report(words.program(), curve);
    return out.release();
}

}  // namespace lightwalk
