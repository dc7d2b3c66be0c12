// pkgBSDF: a window system of a BSDF file as a scene, with the geometry that the file holds. See
// Radiance's manual page pkgBSDF(1).
#include <array>
#include <string_view>

#include "io/bsdf/bsdf_file.h"
#include "io/generators/generator.h"
#include "io/generators/generator_words.h"
#include "io/generators/mgf_scene.h"
#include "io/generators/scene_writer.h"

namespace lightwalk {
namespace {

constexpr std::string_view kPkgBsdfUsage = "-s input.xml ...";
/// By which the surfaces lie outside of the geometry [m].
constexpr double kClearance = 2e-6;

/// The file's name without folders and ending; what parts words becomes _.
std::string system_name(const std::string& file) {
    std::string name = file.substr(file.find_last_of('/') + 1);
    if (name.ends_with(".xml")) name.resize(name.size() - 4);
    for (char& c : name) {
        if (c == ' ' || c == '\t' || c == '\n' || c == '"' || c == '\'') c = '_';
    }
    return name;
}

/// A rectangle that stands for the system, centred, up along y.
struct SystemSurface {
    std::string name;
    double thickness = 0, z = 0;
};

void write_surface(const SystemSurface& surface, const BsdfData& data, const std::string& file,
                   SceneWriter& out) {
    const std::string material = "m_" + surface.name;
    out.write("void", "BSDF", material, {},
              std::array<std::string, 6>{general(surface.thickness, 9), file, "0", "1", "0", "."});
    const double x = data.size[0] / 2, y = data.size[1] / 2, z = surface.z;
    out.polygon(material, surface.name,
                std::array{Vec3{-x, -y, z}, Vec3{x, -y, z}, Vec3{x, y, z}, Vec3{-x, y, z}});
}

void write_system(const std::string& file, GeneratorContext& context, SceneWriter& out) {
    const std::string path = context.library.locate(file, "BSDF file");
    const BsdfData data = decode_bsdf(context.library.files().read(path), path);
    if (!(data.size[0] > 0) || !(data.size[1] > 0))
        throw InputError("pkgBSDF: " + path + ": expected Width and Height of the Material");
    const std::string name = system_name(file);
    const double depth = data.size[2];
    if (data.geometry.empty() || !(depth > 0)) {
        write_surface({name, 0, 0}, data, file, out);
    } else {
        const double thickness = depth + 2 * kClearance;
        write_surface({name + "_f", thickness, kClearance}, data, file, out);
        if (data.part(BsdfPart::back_reflection))
            write_surface({name + "_b", -thickness, kClearance - thickness}, data, file, out);
    }
    if (!data.geometry.empty()) {
        out.text(
            mgf_to_scene(data.geometry, {path, data.geometry_line}, data.geometry_unit, context));
    }
}

}  // namespace

std::string run_pkgbsdf(std::span<const std::string> args, GeneratorContext& context) {
    GeneratorWords words(args, kPkgBsdfUsage);
    if (!words.accept("-s")) words.fail("expected -s: scenes are written to standard output only");
    if (words.at_end()) words.fail("no BSDF file");
    SceneWriter out(args);
    while (!words.at_end()) {
        if (words.peek().starts_with('-')) words.unknown_option();
        write_system(words.text("BSDF file"), context, out);
    }
    return out.release();
}

}  // namespace lightwalk
