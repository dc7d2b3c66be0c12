#include "io/generators/mgf_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <vector>

#include "io/generators/mgf_material.h"
#include "io/generators/rounded_box.h"
#include "io/generators/scene_writer.h"
#include "io/generators/xform_options.h"
#include "io/language/command_line.h"

namespace lightwalk {
namespace {

constexpr int kMostNested = 32;  ///< transformations in one another
constexpr int kTorusSteps = 24;  ///< cones that make a torus
constexpr std::string_view kMgfBlank = " \t\r\f\v";

struct MgfVertex {
    Vec3 position, normal;  ///< normal 0: none
};

struct MgfLine {
    std::vector<std::string> words;
    std::int32_t number = 0;  ///< from 0
};

/// Lines with their words; a backslash at the end of a line continues it, # begins a comment.
std::vector<MgfLine> mgf_lines(std::string_view text) {
    std::vector<MgfLine> lines;
    bool continues = false;
    for (std::int32_t number = 0; !text.empty(); ++number) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (!continues) lines.push_back({{}, number});
        if (line.ends_with('\r')) line.remove_suffix(1);
        continues = line.ends_with('\\');
        if (continues) line.remove_suffix(1);
        while (true) {
            line.remove_prefix(std::min(line.find_first_not_of(kMgfBlank), line.size()));
            if (line.empty()) break;
            const std::size_t size = std::min(line.find_first_of(kMgfBlank), line.size());
            lines.back().words.emplace_back(line.substr(0, size));
            line.remove_prefix(size);
        }
        if (lines.back().words.empty() && !continues) lines.pop_back();
    }
    std::erase_if(lines, [](const MgfLine& line) {
        return line.words.empty() || line.words[0].starts_with('#');
    });
    return lines;
}

class MgfReader {
  public:
    MgfReader(std::vector<MgfLine> lines, const SourceLocation& where, GeneratorContext& context)
        : lines_(std::move(lines)), where_(where), context_(context) {}

    /// The lines up to the end of a transformation, transformed.
    /// @param start  xf and its arguments
    std::string block(const MgfLine& start, int depth) {
        if (depth > kMostNested) throw InputError(place(start), "transformations nest too deep");
        SceneWriter out(start.words);
        while (at_ < lines_.size()) {
            const MgfLine& line = lines_[at_++];
            if (line.words[0] != "xf") {
                read(line, out);
            } else if (line.words.size() > 1) {
                out.text(block(line, depth + 1));
            } else {
                if (depth == 0) throw InputError(place(line), "xf without a transformation");
                break;
            }
        }
        std::string text = out.release();
        return start.words.size() > 1 ? transformed(start, std::move(text)) : text;
    }

  private:
    [[nodiscard]] SourceLocation place(const MgfLine& line) const {
        return {where_.file, where_.line + line.number};
    }

    void read(const MgfLine& line, SceneWriter& out) {
        try {
            if (read_context(line.words) || read_surface(line.words, out)) return;
        } catch (const InputError& error) {
            throw InputError(place(line), error.what());
        }
        context_.warnings.warn(to_prefix(place(line)) + "MGF: \"" + line.words[0] +
                               "\" is not known and left out");
    }

    std::string transformed(const MgfLine& start, std::string text) {
        std::vector<std::string> args = start.words;
        args[0] = "xform";
        try {
            const XformCommandLine line = parse_xform(args);
            if (!line.files.empty())
                throw InputError("found \"" + line.files[0] + "\", expected a transformation");
            GeneratorContext inner{
                context_.library, context_.directory, std::move(text), true, context_.warnings, {}};
            return run_xform(args, inner);
        } catch (const CommandError&) {
            throw;
        } catch (const InputError& error) {
            throw InputError(place(start), error.what());
        }
    }

    bool read_context(MgfWords words) {
        const std::string& entity = words[0];
        if (entity == "c") {
            colors_.select(words);
        } else if (entity == "m") {
            materials_.select(words);
        } else if (entity == "v") {
            vertices_.select(words);
        } else if (entity == "p") {
            vertices_.current().position = vector(words);
        } else if (entity == "n") {
            vertices_.current().normal = vector(words);
        } else if (entity == "o") {
            if (words.size() > 1)
                objects_.push_back(words[1]);
            else if (objects_.empty())
                throw InputError("o without an object");
            else
                objects_.pop_back();
        } else if (entity == "i") {
            throw InputError("MGF: other files are not included");
        } else {
            return read_color_entity(words, colors_) ||
                   read_material_entity(words, colors_.current(), materials_.current());
        }
        return true;
    }

    static Vec3 vector(MgfWords words) {
        return {mgf_number(words, 1), mgf_number(words, 2), mgf_number(words, 3)};
    }
    [[nodiscard]] const MgfVertex& vertex(MgfWords words, std::size_t at) const {
        if (at >= words.size()) throw InputError(words[0] + ": too few arguments");
        return vertices_.find(words[at]);
    }

    bool read_surface(MgfWords words, SceneWriter& out) {
        const std::string& entity = words[0];
        if (entity == "f")
            face(words, out);
        else if (entity == "fh")
            face_with_holes(words, out);
        else if (entity == "sph")
            sphere(words, out);
        else if (entity == "cyl")
            cone(words, 3, mgf_number(words, 2), mgf_number(words, 2), out);
        else if (entity == "cone")
            cone(words, 3, mgf_number(words, 2), mgf_number(words, 4), out);
        else if (entity == "ring")
            ring(words, out);
        else if (entity == "prism")
            prism(words, out);
        else if (entity == "torus")
            torus(words, out);
        else
            return false;
        return true;
    }

    /// The current material's name; its primitives are written where they have changed.
    std::string material(SceneWriter& out) {
        std::string name = materials_.name().empty() ? "mat" : materials_.name();
        const std::string text = material_text(materials_.current(), name);
        std::string& written = written_[name];
        if (written != text) out.text(written = text);
        return name;
    }
    std::string next_name() {
        std::string name;
        for (const std::string& object : objects_) name += object + ".";
        return name + std::to_string(++surfaces_);
    }

    void face(MgfWords words, SceneWriter& out) {
        if (words.size() < 4) throw InputError("f: too few arguments");
        std::vector<Vec3> corners, normals;
        for (std::size_t i = 1; i < words.size(); ++i) {
            const MgfVertex& at = vertices_.find(words[i]);
            corners.push_back(at.position);
            if (length_squared(at.normal) > 0) normals.push_back(normalize(at.normal));
        }
        const std::string modifier = material(out);
        if (normals.size() < corners.size()) {
            out.polygon(modifier, next_name(), corners);
            return;
        }
        for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
            const std::array<Vec3, 3> triangle{corners[0], corners[i], corners[i + 1]},
                bent{normals[0], normals[i], normals[i + 1]};
            const bool smooth = write_smoothing(modifier, triangle, bent, out);
            out.polygon(smooth ? "Phong" : modifier, next_name(), triangle);
        }
    }

    /// Seams join the holes to the last vertex of the outline.
    void face_with_holes(MgfWords words, SceneWriter& out) {
        std::vector<std::vector<Vec3>> loops(1);
        for (std::size_t i = 1; i < words.size(); ++i) {
            if (words[i] == "-")
                loops.emplace_back();
            else
                loops.back().push_back(vertices_.find(words[i]).position);
        }
        std::vector<Vec3> corners = loops[0];
        for (const std::vector<Vec3>& loop : loops) {
            if (loop.size() < 3) throw InputError("fh: fewer than three vertices");
            if (&loop == loops.data()) continue;
            corners.insert(corners.end(), loop.begin(), loop.end());
            corners.push_back(loop[0]);
            corners.push_back(loops[0].back());
        }
        out.polygon(material(out), next_name(), corners);
    }

    void sphere(MgfWords words, SceneWriter& out) {
        const Vec3 center = vertex(words, 1).position;
        const double radius = mgf_number(words, 2);
        const std::array<double, 4> reals{center.x, center.y, center.z, std::abs(radius)};
        out.write(material(out), radius < 0 ? "bubble" : "sphere", next_name(), reals);
    }

    void cone(MgfWords words, std::size_t end, double first, double second, SceneWriter& out) {
        const Vec3 p = vertex(words, 1).position, q = vertex(words, end).position;
        write_cone(p, first, q, second, first < 0 || second < 0, out);
    }

    /// @param inward  whether the surface looks to its axis
    void write_cone(const Vec3& p, double first, const Vec3& q, double second, bool inward,
                    SceneWriter& out) {
        first = std::abs(first);
        second = std::abs(second);
        const std::array<double, 8> cone{p.x, p.y, p.z, q.x, q.y, q.z, first, second};
        const std::string modifier = material(out);
        if (first != second)
            out.write(modifier, inward ? "cup" : "cone", next_name(), cone);
        else
            out.write(modifier, inward ? "tube" : "cylinder", next_name(),
                      std::span(cone).first(7));
    }

    void ring(MgfWords words, SceneWriter& out) {
        const MgfVertex& at = vertex(words, 1);
        const Vec3 &p = at.position, &n = at.normal;
        const std::array<double, 8> reals{
            p.x, p.y, p.z, n.x, n.y, n.z, mgf_number(words, 2), mgf_number(words, 3)};
        out.write(material(out), "ring", next_name(), reals);
    }

    /// The face that is given looks out of a prism of positive length, which lies behind it.
    void prism(MgfWords words, SceneWriter& out) {
        if (words.size() < 5) throw InputError("prism: too few arguments");
        const double length = mgf_number(words, words.size() - 1);
        std::vector<Vec3> base;
        for (std::size_t i = 1; i + 1 < words.size(); ++i)
            base.push_back(vertices_.find(words[i]).position);
        Vec3 normal;
        for (std::size_t i = 1; i + 1 < base.size(); ++i)
            normal += cross(base[i] - base[0], base[i + 1] - base[0]);
        if (!(length_squared(normal) > 0)) throw InputError("prism: its vertices lie on a line");
        const Vec3 shift = normalize(normal) * -length;
        const std::string modifier = material(out);
        out.polygon(modifier, next_name(), base);
        for (std::size_t i = 0; i < base.size(); ++i) {
            const Vec3 &a = base[i], &b = base[(i + 1) % base.size()];
            out.polygon(modifier, next_name(), std::array{a, a + shift, b + shift, b});
        }
        std::ranges::reverse(base);
        for (Vec3& corner : base) corner += shift;
        out.polygon(modifier, next_name(), base);
    }

    void torus(MgfWords words, SceneWriter& out) {
        const MgfVertex& at = vertex(words, 1);
        double inner = mgf_number(words, 2), outer = mgf_number(words, 3);
        const bool inward = outer < 0;
        inner = std::abs(inner);
        outer = std::abs(outer);
        if (!(length_squared(at.normal) > 0)) throw InputError("torus: its vertex has no normal");
        const Vec3 axis = normalize(at.normal);
        const double middle = 0.5 * (inner + outer), radius = 0.5 * (outer - inner);
        const auto angle = [](int i) { return 2 * kPi * i / kTorusSteps; };
        for (int i = 0; i < kTorusSteps; ++i) {
            const double a = angle(i), b = angle(i + 1);
            write_cone(at.position + axis * (radius * std::sin(a)), middle + radius * std::cos(a),
                       at.position + axis * (radius * std::sin(b)), middle + radius * std::cos(b),
                       inward != (std::cos(0.5 * (a + b)) < 0), out);
        }
    }

    std::vector<MgfLine> lines_;
    std::size_t at_ = 0;
    SourceLocation where_;
    GeneratorContext& context_;
    MgfContexts<MgfColor> colors_;
    MgfContexts<MgfMaterial> materials_;
    MgfContexts<MgfVertex> vertices_;
    std::vector<std::string> objects_;
    std::map<std::string, std::string> written_;  ///< the text of each material
    std::size_t surfaces_ = 0;
};

}  // namespace

std::string mgf_to_scene(std::string_view text, const SourceLocation& where, double unit,
                         GeneratorContext& context) {
    MgfLine all{{"MGF"}, 0};
    if (unit != 1) all.words.insert(all.words.end(), {"-s", general(unit, 9)});
    return MgfReader(mgf_lines(text), where, context).block(all, 0);
}

}  // namespace lightwalk
