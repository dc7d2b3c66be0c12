#include "io/wavefront/mtl_file.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/math/rgb.h"
#include "core/model/transform_args.h"
#include "io/formats/words.h"

namespace lightwalk {
namespace {

constexpr double kMostExponent = 1e6;
constexpr double kMostRadiance = 1e9;

class MtlReader {
  public:
    MtlReader(std::string_view text, const std::string& name) : rest_(text), where_{name, 0} {}

    std::vector<MtlMaterial> read() {
        while (!rest_.empty()) {
            ++where_.line;
            std::string_view line = take_line(rest_);
            const std::string_view statement = take_word(line);
            if (statement == "newmtl") {
                const std::string_view name = without_blanks(line);
                if (name.empty()) throw InputError(where_, "newmtl without a name");
                materials_.emplace_back().name = name;
            } else if (!materials_.empty()) {
                read_statement(statement, line, materials_.back());
            }
        }
        return std::move(materials_);
    }

  private:
    void read_statement(std::string_view statement, std::string_view line, MtlMaterial& m) {
        if (statement == "Kd") return read_color(line, 1, m.kd);
        if (statement == "Ks") return read_color(line, 1, m.ks);
        if (statement == "Tf") return read_color(line, 1, m.tf);
        if (statement == "Ke") return read_color(line, kMostRadiance, m.ke);
        if (statement == "Ns") m.ns = number(line, kMostExponent);
        if (statement == "Ni") m.ni = number(line, 100);
        if (statement == "illum") m.illum = static_cast<int>(number(line, 10));
        if (statement == "Tr") m.d = 1 - number(line, 1);
        if (statement == "d") {
            if (std::string_view rest = line; take_word(rest) == "-halo") line = rest;
            m.d = number(line, 1);
        }
        if (statement == "map_Kd") m.map_kd = file_of(without_blanks(line));
        if (statement == "map_Bump" || statement == "map_bump" || statement == "bump" ||
            statement == "norm")
            m.bumpy = true;
        if (statement == "map_d") m.map_d = file_of(without_blanks(line));
    }

    /// The file after the options of a map, the words of which begin with '-'.
    static std::string file_of(std::string_view line) {
        if (!line.starts_with('-')) return std::string(line);
        return std::string(line.substr(line.find_last_of(" \t") + 1));
    }

    double number(std::string_view& line, double most) {
        const std::string_view word = take_word(line);
        double value = 0;
        if (!parse_real(word, value) || !std::isfinite(value))
            throw InputError(where_, "found \"" + std::string(word) + "\", expected a number");
        return std::clamp(value, 0.0, most);
    }

    /// One number is of all channels.
    void read_color(std::string_view line, double most, std::array<double, 3>& color) {
        std::string_view rest = line;
        const std::string_view first = take_word(rest);
        if (first == "spectral" || first == "xyz")
            throw InputError(where_, "colours by \"" + std::string(first) +
                                         "\" are not supported, expected red, green and blue");
        color[0] = color[1] = color[2] = number(line, most);
        if (without_blanks(line).empty()) return;
        color[1] = number(line, most);
        color[2] = number(line, most);
    }

    std::string_view rest_;
    SourceLocation where_;
    std::vector<MtlMaterial> materials_;
};

using Color = std::array<double, 3>;

double brightness_of(const Color& c) {
    return static_cast<double>(
        brightness({static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])}));
}

bool is_grey(const Color& c) {
    constexpr double kLeastDifference = 0.02;
    return std::ranges::max(c) - std::ranges::min(c) <= kLeastDifference * std::ranges::max(c);
}

class MtlScene {
  public:
    MtlScene(const MtlMaterial& material, const MtlPictures& pictures)
        : m_(material), pictures_(pictures) {}

    std::string write() {
        const int illum = m_.illum.value_or(2);
        const bool is_glass = illum == 4 || illum == 6 || illum == 7 || illum == 9;
        if (std::ranges::max(m_.ke) > 0)
            out_.add("void", "glow", m_.name, {}, {m_.ke[0], m_.ke[1], m_.ke[2], 0});
        else if (m_.d < 1 && is_glass)
            write_glass();
        else
            write_reflection(illum);
        return out_.release();
    }

  private:
    void write_glass() {
        std::vector<double> reals;
        for (const double tint : m_.tf) reals.push_back(transmissivity((1 - m_.d) * tint));
        if (m_.ni > 1) reals.push_back(m_.ni);
        out_.add("void", "glass", m_.name, {}, reals);
    }

    void write_reflection(int illum) {
        const bool dissolves = m_.d < 1 || pictures_.opacity;
        const std::string name = dissolves ? m_.name + "_opaque" : m_.name;
        const std::string modifier = pictures_.diffuse ? m_.name + "_map" : "void";
        if (pictures_.diffuse) out_.add_map(modifier, *pictures_.diffuse);
        const Color ks = illum == 0 || illum == 1 ? Color{} : m_.ks;
        Color sum = m_.kd;
        for (std::size_t c = 0; c < 3; ++c) sum[c] += ks[c];
        const double scale = 1 / std::max(1.0, std::ranges::max(sum));
        const double roughness = ks == Color{} ? 0 : std::sqrt(2 / (m_.ns + 2));
        const double specular = scale * brightness_of(ks);
        std::vector<double> reals(3);
        if (is_grey(ks)) {
            for (std::size_t c = 0; c < 3; ++c)
                reals[c] = specular < 1 ? std::min(1.0, scale * m_.kd[c] / (1 - specular)) : 0;
            reals.insert(reals.end(), {specular, roughness});
            out_.add(modifier, "plastic", name, {}, reals);
        } else {
            for (std::size_t c = 0; c < 3; ++c) reals[c] = scale * sum[c];
            reals.insert(reals.end(),
                         {std::min(1.0, brightness_of(ks) / brightness_of(sum)), roughness});
            out_.add(modifier, "metal", name, {}, reals);
        }
        if (pictures_.opacity)
            out_.add_fading(m_.name, name, *pictures_.opacity, m_.d);
        else if (dissolves)
            out_.add_veil(m_.name, name, m_.d);
    }

    const MtlMaterial& m_;
    const MtlPictures& pictures_;
    MaterialText out_;
};

}  // namespace

std::vector<MtlMaterial> decode_mtl(std::string_view text, const std::string& name) {
    return MtlReader(text, name).read();
}

std::string mtl_scene(const MtlMaterial& material, const MtlPictures& pictures) {
    return MtlScene(material, pictures).write();
}

}  // namespace lightwalk
