// genbox: a box with square, bevelled or rounded edges. See Radiance's manual page genbox(1).
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "io/generators/generator.h"
#include "io/generators/generator_words.h"
#include "io/generators/rounded_box.h"
#include "io/generators/scene_writer.h"

namespace lightwalk {
namespace {

constexpr std::string_view kGenboxUsage =
    "material name xsize ysize zsize [-i] [-b bevel | -r radius [-n segments] [-s]] [-o]";
constexpr long kDefaultSegments = 32;
constexpr long kMaxSegments = 256;  ///< a quarter circle; more would exceed the largest output

// A vertex code: bits 0-2 choose the high side in x, y, z; bits 3-5 inset that coordinate.
using Face = std::array<std::uint8_t, 4>;

constexpr std::array<Face, 6> kPlainFaces = {
    {{1, 5, 4, 0}, {4, 6, 2, 0}, {2, 3, 1, 0}, {3, 2, 6, 7}, {5, 1, 3, 7}, {6, 4, 5, 7}}};
constexpr std::array<Face, 6> kInsetFaces = {{{051, 055, 054, 050},
                                              {064, 066, 062, 060},
                                              {032, 033, 031, 030},
                                              {053, 052, 056, 057},
                                              {065, 061, 063, 067},
                                              {036, 034, 035, 037}}};
constexpr std::array<Face, 12> kBevelEdges = {{{031, 051, 050, 030},
                                               {060, 062, 032, 030},
                                               {050, 054, 064, 060},
                                               {034, 036, 066, 064},
                                               {037, 057, 056, 036},
                                               {052, 062, 066, 056},
                                               {052, 053, 033, 032},
                                               {057, 067, 063, 053},
                                               {061, 031, 033, 063},
                                               {065, 067, 037, 035},
                                               {055, 051, 061, 065},
                                               {034, 054, 055, 035}}};
constexpr std::array<std::array<std::uint8_t, 3>, 8> kBevelCorners = {{{030, 050, 060},
                                                                       {051, 031, 061},
                                                                       {032, 062, 052},
                                                                       {064, 054, 034},
                                                                       {036, 056, 066},
                                                                       {065, 035, 055},
                                                                       {053, 063, 033},
                                                                       {037, 067, 057}}};
constexpr std::array<std::array<std::uint8_t, 2>, 12> kRoundEdges = {{{070, 071},
                                                                      {070, 074},
                                                                      {070, 072},
                                                                      {073, 071},
                                                                      {073, 072},
                                                                      {073, 077},
                                                                      {075, 071},
                                                                      {075, 074},
                                                                      {075, 077},
                                                                      {076, 072},
                                                                      {076, 074},
                                                                      {076, 077}}};

struct BoxOptions {
    std::string material, name;
    Vec3 size;
    double inset = 0;  ///< bevel or radius
    bool bevelled = false, round = false, inward = false, smooth = false, obj = false;
    std::optional<long> segments;  ///< a quarter circle, if given

    [[nodiscard]] bool is_segmented() const {
        if (!round) return false;
        return obj || (segments ? *segments > 2 : inward);
    }
};

BoxOptions parse_genbox(GeneratorWords& words) {
    BoxOptions box;
    box.material = words.text("material");
    box.name = words.text("name");
    box.size = {words.positive("x size"), 0, 0};
    box.size.y = words.positive("y size");
    box.size.z = words.positive("z size");
    while (!words.at_end()) {
        if (words.accept("-i")) {
            box.inward = true;
        } else if (words.accept("-s")) {
            box.smooth = true;
        } else if (words.accept("-o")) {
            box.obj = true;
        } else if (words.accept("-b")) {
            box.inset = words.positive("bevel");
            box.bevelled = true;
        } else if (words.accept("-r")) {
            box.inset = words.positive("radius");
            box.round = true;
        } else if (words.accept("-n")) {
            box.segments = words.integer("number of segments", 1, kMaxSegments);
        } else {
            words.unknown_option();
        }
    }
    return box;
}

Vec3 vertex(const BoxOptions& box, std::uint8_t code) {
    const unsigned high = box.inward ? ~code & 7U : code & 7U;
    Vec3 p;
    for (unsigned i = 0; i < 3; ++i) {
        const double inset = (code >> (3 + i) & 1U) != 0 ? box.inset : 0;
        p[i] = (high >> i & 1U) != 0 ? box.size[i] - inset : inset;
    }
    return p;
}

/// "name.1540": one character a vertex.
std::string part_name(const BoxOptions& box, std::span<const std::uint8_t> codes) {
    constexpr std::string_view kAlphabet =
        "0123456789._ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";
    std::string name = box.name + ".";
    for (const std::uint8_t code : codes) name.push_back(kAlphabet[code]);
    return name;
}

template <class Faces>
void write_faces(const BoxOptions& box, const Faces& faces, SceneWriter& out) {
    std::vector<Vec3> corners;
    for (const auto& face : faces) {
        corners.clear();
        for (const std::uint8_t code : face) corners.push_back(vertex(box, code));
        out.polygon(box.material, part_name(box, face), corners);
    }
}

template <class Faces>
void add_faces(const BoxOptions& box, const Faces& faces, PolygonMesh& mesh) {
    for (const auto& face : faces) {
        PolygonMesh::Face added;
        for (const std::uint8_t code : face) {
            added.vertex[added.corners++] = static_cast<std::uint32_t>(mesh.positions.size());
            mesh.positions.push_back(vertex(box, code));
        }
        mesh.faces.push_back(added);
    }
}

void write_round_edges(const BoxOptions& box, SceneWriter& out) {
    for (const auto& edge : kRoundEdges) {
        out.cylinder(box.material, part_name(box, edge), vertex(box, edge[0]), vertex(box, edge[1]),
                     box.inset);
    }
    for (std::uint8_t code = 070; code <= 077; ++code) {
        out.sphere(box.material, part_name(box, {&code, 1}), vertex(box, code), box.inset);
    }
}

PolygonMesh box_mesh(const BoxOptions& box) {
    if (box.is_segmented()) {
        return rounded_box({box.size, box.inset, box.inward, box.smooth,
                            static_cast<std::size_t>(box.segments.value_or(kDefaultSegments))});
    }
    PolygonMesh mesh;
    if (box.bevelled) {
        add_faces(box, kInsetFaces, mesh);
        add_faces(box, kBevelEdges, mesh);
        add_faces(box, kBevelCorners, mesh);
    } else {
        add_faces(box, kPlainFaces, mesh);
    }
    return mesh;
}

/// The faces as polygons name.1, name.2, ...; the curved ones smoothed where the mesh has normals.
void write_segmented(const BoxOptions& box, SceneWriter& out) {
    const PolygonMesh mesh = box_mesh(box);
    std::size_t number = 0;
    for (const PolygonMesh::Face& face : mesh.faces) {
        std::vector<Vec3> corners;
        std::vector<Vec3> normals;
        for (std::size_t i = 0; i < face.corners; ++i) {
            corners.push_back(mesh.positions[face.vertex[i]]);
            if (!mesh.normals.empty()) normals.push_back(mesh.normals[face.vertex[i]]);
        }
        const bool curved = !normals.empty() && face.corners == 3;
        const bool smoothed = curved && write_smoothing(box.material, corners, normals, out);
        out.polygon(smoothed ? "Phong" : box.material, box.name + "." + std::to_string(++number),
                    corners);
    }
}

}  // namespace

std::string run_genbox(std::span<const std::string> args, GeneratorContext& context) {
    static_cast<void>(context);
    GeneratorWords words(args, kGenboxUsage);
    const BoxOptions box = parse_genbox(words);
    if (box.obj) return write_obj(args, box.material, box.name, box_mesh(box));
    SceneWriter out(args);
    if (box.is_segmented()) {
        write_segmented(box, out);
    } else if (box.round) {
        write_faces(box, kInsetFaces, out);
        write_round_edges(box, out);
    } else if (box.bevelled) {
        write_faces(box, kInsetFaces, out);
        write_faces(box, kBevelEdges, out);
        write_faces(box, kBevelCorners, out);
    } else {
        write_faces(box, kPlainFaces, out);
    }
    return out.release();
}

}  // namespace lightwalk
