// genrev: a surface of revolution about the z axis. See Radiance's manual page genrev(1).
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "io/generators/expressions.h"
#include "io/generators/generator.h"
#include "io/generators/generator_words.h"
#include "io/generators/scene_writer.h"

namespace lightwalk {
namespace {

constexpr std::string_view kGenrevUsage =
    "material name z(t) r(t) segments [-e expression] [-f file] [-s]";
constexpr double kEqual = 1e-9;

/// A point of the profile, or a direction in its plane.
struct Profile {
    double z = 0, r = 0;
};

bool equal(double a, double b) {
    return std::abs(a - b) <= kEqual;
}

/// Unit normal of the segment from a to b, to the right of it as z points up and r to the right:
/// outward for rising z. Zero for no segment.
Profile segment_normal(const Profile& a, const Profile& b) {
    const double length = std::hypot(b.z - a.z, b.r - a.r);
    if (equal(a.z, b.z) && equal(a.r, b.r)) return {};
    return {(a.r - b.r) / length, (b.z - a.z) / length};
}

/// Slope and offset of the line through (x0, y0) and (x1, y1).
std::array<double, 2> line_through(double x0, double y0, double x1, double y1) {
    const double slope = (y1 - y0) / (x1 - x0);
    return {slope, y0 - slope * x0};
}

/// The texture that bends the normal of the piece from a to b, so that it runs from `before` to
/// `after`.
void write_texture(const std::string& material, const Profile& a, const Profile& b,
                   const Profile& before, const Profile& after, SceneWriter& out) {
    std::array<double, 2> z = {0, a.r > b.r ? 1.0 : -1.0};
    std::array<double, 2> r = {0, b.z > a.z ? 1.0 : -1.0};
    if (!equal(a.z, b.z)) z = line_through(a.z, before.z, b.z, after.z);
    if (!equal(a.r, b.r)) r = line_through(a.r, before.r, b.r, after.r);
    const std::array<std::string, 4> strings = {"rev_dx", "rev_dy", "rev_dz", "rev.cal"};
    out.write(material, "texfunc", "Phong", std::array{z[0], z[1], r[0], r[1]}, strings);
}

void write_piece(const std::string& modifier, const std::string& name, const Profile& a,
                 const Profile& b, SceneWriter& out) {
    const bool rising = b.z > a.z;
    if (equal(a.z, b.z)) {
        const double up = a.r > b.r ? 1 : -1;
        out.write(modifier, "ring", name, std::array{0.0, 0.0, b.z, 0.0, 0.0, up, a.r, b.r});
    } else if (equal(a.r, b.r)) {
        out.write(modifier, rising ? "cylinder" : "tube", name,
                  std::array{0.0, 0.0, a.z, 0.0, 0.0, b.z, b.r});
    } else {
        out.write(modifier, rising ? "cone" : "cup", name,
                  std::array{0.0, 0.0, a.z, 0.0, 0.0, b.z, a.r, b.r});
    }
}

}  // namespace

std::string run_genrev(std::span<const std::string> args, GeneratorContext& context) {
    GeneratorWords words(args, kGenrevUsage);
    const std::string material = words.text("material");
    const std::string name = words.text("name");
    const std::string z = words.text("z(t)");
    const std::string r = words.text("r(t)");
    const std::string count = words.text("number of segments");
    GeneratorExpressions expressions(context);
    bool smooth = false;
    while (!words.at_end()) {
        if (words.accept("-s"))
            smooth = true;
        else if (!expressions.accept_option(words))
            words.unknown_option();
    }
    const std::size_t segments = expressions.count(words, count, "number of segments", kMaxPieces);
    const std::array<std::string, 2> names = {"Z`SYS", "R`SYS"};
    expressions.define_function(words.program(), names[0], "t", z);
    expressions.define_function(words.program(), names[1], "t", r);
    CompiledFunctions profile(expressions.compile_program(words.program(), names, 1));

    std::vector<Profile> points(segments + 1);
    for (std::size_t i = 0; i <= segments; ++i) {
        const std::array<double, 1> t = {static_cast<double>(i) / static_cast<double>(segments)};
        points[i] = {profile(0, t), profile(1, t)};
    }
    expressions.report(words.program(), profile);
    const auto normal = [&](std::size_t i) {  // normal of segment i, 1 to `segments`; zero outside
        return i < 1 || i > segments ? Profile{} : segment_normal(points[i - 1], points[i]);
    };
    SceneWriter out(args);
    for (std::size_t i = 1; i <= segments; ++i) {
        const Profile& a = points[i - 1];
        const Profile& b = points[i];
        if (equal(a.z, b.z) && equal(a.r, b.r)) continue;
        if (smooth) write_texture(material, a, b, normal(i - 1), normal(i + 1), out);
        write_piece(smooth ? "Phong" : material, name + "." + std::to_string(i), a, b, out);
    }
    return out.release();
}

}  // namespace lightwalk
