#include "io/generators/mgf_material.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/model/transform_args.h"
#include "core/spectrum/spectrum_color.h"
#include "io/generators/scene_writer.h"

namespace lightwalk {
namespace {

constexpr double kLeastMetal = 0.1;  ///< specular reflectance from which on a surface is metal
constexpr double kLumens = 179;      ///< a watt, in Radiance

/// Throws for colours that are none.
MgfColor of_brightness_one(const Rgb& rgb) {
    const float y = brightness(rgb);
    if (!(y > 0) || !std::isfinite(y)) throw InputError("this is no colour");
    return {rgb * (1 / y)};
}

MgfColor from_chromaticity(double x, double y) {
    if (!(y > 0) || !(x >= 0) || !(x + y <= 1)) throw InputError("x and y are no chromaticity");
    return of_brightness_one(color_from_xyz({x / y, 1, (1 - x - y) / y}));
}

MgfColor from_spectrum(double first, double last, std::span<const double> values) {
    if (values.size() < 2 || !(first > 0) || !(last > first))
        throw InputError("cspec: expected two wavelengths and two values or more");
    const SpectrumColor color(ends_of_samples(first, last, values.size()), values.size());
    return of_brightness_one(color(values));
}

/// Source: Planck's law.
MgfColor from_temperature(double kelvin) {
    constexpr double kSecond = 1.4388e7;  // [nm K]
    if (!(kelvin >= 100) || !(kelvin <= 1e6)) throw InputError("cct: a temperature of 100 to 1e6");
    std::vector<double> values;
    for (double wavelength = 380; wavelength <= 780; wavelength += 10) {
        values.push_back(std::pow(wavelength / 560, -5) /
                         std::expm1(kSecond / (wavelength * kelvin)));
    }
    const double largest = *std::ranges::max_element(values);
    for (double& value : values) value /= largest;
    return from_spectrum(380, 780, values);
}

MgfColor mixed(MgfWords words, const MgfContexts<MgfColor>& colors) {
    if (words.size() < 3 || words.size() % 2 == 0)
        throw InputError("cmix: expected weights and colours");
    Rgb sum;
    for (std::size_t i = 1; i + 1 < words.size(); i += 2)
        sum += colors.find(words[i + 1]).rgb * static_cast<float>(mgf_number(words, i));
    return of_brightness_one(sum);
}

bool is_white(const Rgb& color) {
    return std::abs(color.r - color.g) < 1e-3f && std::abs(color.b - color.g) < 1e-3f;
}

std::string numbers(const Rgb& color) {
    std::string text;
    for (std::size_t c = 0; c < 3; ++c) text += " " + general(static_cast<double>(color[c]), 9);
    return text;
}

std::string primitive(const std::string& head, const std::string& name, int count,
                      const std::string& reals) {
    return "\nvoid " + head + " " + name + "\n0\n0\n" + std::to_string(count) + reals + "\n";
}

/// Reflection and transmission of any colour and roughness.
std::string general_text(const MgfMaterial& m, const std::string& name) {
    std::string text, parts;
    for (const auto& [part, ending] :
         {std::pair(&m.specular, ".rs"), std::pair(&m.specular_through, ".ts")}) {
        text += "\nvoid colorfunc " + name + ending + "\n4";
        text += numbers(part->value()) + " .\n0\n0\n";
        const std::string roughness = general(part->roughness, 9);
        parts += " " + name + ending + " 1 " + roughness + " " + roughness;
    }
    const std::string diffuse = numbers(m.diffuse.value());
    return text + "\nvoid WGMDfunc " + name + "\n13" + parts + " void 0 0 1 .\n0\n9" + diffuse +
           diffuse + numbers(m.diffuse_through.value()) + "\n";
}

std::string transparent_text(const MgfMaterial& m, const std::string& name) {
    const MgfPart &rd = m.diffuse, &td = m.diffuse_through, &rs = m.specular,
                  &ts = m.specular_through;
    const bool clear = rd.amount + td.amount <= 0 && ts.roughness <= 0 && rs.roughness <= 0;
    if (clear && m.index > 1 && m.two_sides)
        return primitive("glass", name, 4,
                         numbers(rs.value() + ts.value()) + " " + general(m.index, 9));
    const bool one_color = is_white(rs.color) && (rd.amount <= 0 || is_white(rd.color)) &&
                           (td.amount <= 0 || is_white(td.color)) && is_white(ts.color);
    const bool one_roughness = rs.amount <= 0 || ts.amount <= 0 || rs.roughness == ts.roughness;
    if (!one_color || !one_roughness || !(rs.amount < 1)) return general_text(m, name);
    const double through = td.amount + ts.amount, all = rd.amount + through;
    const double roughness = ts.amount > 0 ? ts.roughness : rs.roughness;
    return primitive("trans", name, 7,
                     numbers(Rgb::grey(static_cast<float>(all / (1 - rs.amount)))) + " " +
                         general(rs.amount, 9) + " " + general(roughness, 9) + " " +
                         general(through / all, 9) + " " + general(ts.amount / through, 9));
}

}  // namespace

double mgf_number(MgfWords words, std::size_t at) {
    double value = 0;
    if (at >= words.size()) throw InputError(words[0] + ": too few arguments");
    if (!parse_real(words[at], value) || !std::isfinite(value))
        throw InputError("found \"" + words[at] + "\", expected a number");
    return value;
}

bool read_color_entity(MgfWords words, MgfContexts<MgfColor>& colors) {
    const std::string& entity = words[0];
    if (entity == "cxy") {
        colors.current() = from_chromaticity(mgf_number(words, 1), mgf_number(words, 2));
    } else if (entity == "cct") {
        colors.current() = from_temperature(mgf_number(words, 1));
    } else if (entity == "cmix") {
        colors.current() = mixed(words, colors);
    } else if (entity == "cspec") {
        std::vector<double> values;
        for (std::size_t i = 3; i < words.size(); ++i) values.push_back(mgf_number(words, i));
        colors.current() = from_spectrum(mgf_number(words, 1), mgf_number(words, 2), values);
    } else {
        return false;
    }
    return true;
}

bool read_material_entity(MgfWords words, const MgfColor& color, MgfMaterial& material) {
    const auto part = [&](bool rough) {
        const double amount = mgf_number(words, 1);
        if (amount < 0) throw InputError(words[0] + ": a negative number");
        return MgfPart{amount, color.rgb, rough ? std::max(0.0, mgf_number(words, 2)) : 0.0};
    };
    const std::string& entity = words[0];
    if (entity == "sides")
        material.two_sides = mgf_number(words, 1) != 1;
    else if (entity == "rd")
        material.diffuse = part(false);
    else if (entity == "td")
        material.diffuse_through = part(false);
    else if (entity == "ed")
        material.emitted = part(false);
    else if (entity == "rs")
        material.specular = part(true);
    else if (entity == "ts")
        material.specular_through = part(true);
    else if (entity == "ir")
        material.index = mgf_number(words, 1);
    else
        return false;
    return true;
}

std::string material_text(const MgfMaterial& m, const std::string& name) {
    if (m.emitted.amount > 0)
        return primitive("light", name, 3,
                         numbers(m.emitted.value() * static_cast<float>(1 / (kLumens * kPi))));
    if (m.diffuse_through.amount + m.specular_through.amount > 0) return transparent_text(m, name);
    const MgfPart &rd = m.diffuse, &rs = m.specular;
    const std::string roughness = " " + general(rs.roughness, 9);
    if (rs.amount >= kLeastMetal || !is_white(rs.color)) {
        const double share = rs.amount > 0 ? rs.amount / (rs.amount + rd.amount) : 0;
        return primitive("metal", name, 5,
                         numbers(rd.value() + rs.value()) + " " + general(share, 9) + roughness);
    }
    return primitive("plastic", name, 5,
                     numbers(rd.value() * static_cast<float>(1 / (1 - rs.amount))) + " " +
                         general(rs.amount, 9) + roughness);
}

}  // namespace lightwalk
