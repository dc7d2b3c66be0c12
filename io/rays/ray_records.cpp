#include "io/rays/ray_records.h"

#include <array>
#include <bit>
#include <cstdio>

#include "core/math/rgbe.h"
#include "core/math/xyz.h"
#include "io/options/option_words.h"

namespace lightwalk {
namespace {

constexpr std::string_view kLetters = "odvVwWlLcpnNsmMrxRX~";
constexpr std::string_view kNotShaded = "odpcLNswmM~";
constexpr std::string_view kColors = "vVrx";
constexpr std::string_view kVectors = "odpnNW";
/// The PRIMARIES line that Radiance's rtrace writes for CIE XYZ.
constexpr std::string_view kXyzPrimaries =
    "PRIMARIES= 1.0000 0.0000 0.0000 1.0000 0.0000 0.0000 0.3333 0.3333\n";

bool is_single(ColorOutput color) {
    return color == ColorOutput::luminance || color == ColorOutput::mean;
}

std::string_view format_name(NumberFormat format, ColorOutput color) {
    switch (format) {
        case NumberFormat::text:
            return "ascii";
        case NumberFormat::real32:
            return "float";
        case NumberFormat::real64:
            return "double";
        case NumberFormat::rgbe:
            break;
    }
    return color == ColorOutput::xyz ? "32-bit_rle_xyze" : "32-bit_rle_rgbe";
}

std::size_t number_size(NumberFormat format) {
    return format == NumberFormat::real64   ? sizeof(double)
           : format == NumberFormat::real32 ? sizeof(float)
                                            : 1;
}

Vec3 shading_normal(const Ray& ray) {
    return normalize(ray.hit.normal + ray.hit.perturbation);
}

Vec3 as_vector(const Rgb& c) {
    return {static_cast<double>(c.r), static_cast<double>(c.g), static_cast<double>(c.b)};
}

/// The ray's contribution coefficient to its primary ray, for each channel.
Rgb coefficient(const Ray& ray) {
    Rgb product{1, 1, 1};
    for (const Ray* at = &ray; at->parent != nullptr; at = at->parent) product *= at->coef;
    return product;
}

}  // namespace

void append_number(double value, NumberFormat format, std::string& output) {
    if (format == NumberFormat::text) {
        std::array<char, 32> text{};
        const int size = std::snprintf(text.data(), text.size(), "%e\t", value);
        output.append(text.data(), static_cast<std::size_t>(size));
    } else if (format == NumberFormat::real64) {
        const auto bytes = std::bit_cast<std::array<char, sizeof value>>(value);
        output.append(bytes.data(), bytes.size());
    } else {
        const auto bytes =
            std::bit_cast<std::array<char, sizeof(float)>>(static_cast<float>(value));
        output.append(bytes.data(), bytes.size());
    }
}

RayRecords::RayRecords(std::string_view letters, NumberFormat format, ColorOutput color)
    : letters_(letters), format_(format), color_(color) {
    if (letters.empty()) throw UsageError("option -o: empty output specification");
    const std::size_t unknown = letters.find_first_not_of(kLetters);
    if (unknown != std::string_view::npos) {
        throw UsageError(std::string("option -o: unrecognized output option '") + letters[unknown] +
                         "', expected " + std::string(kLetters) + "tT");
    }
    const bool one_color =
        letters.size() == 1 && std::string_view("vrx").find(letters) != std::string_view::npos;
    if (format == NumberFormat::rgbe && (!one_color || is_single(color))) {
        throw UsageError("option -f: format c needs exactly one colour field, v, r or x");
    }
}

bool RayRecords::shades() const {
    return letters_.find_first_not_of(kNotShaded) != std::string::npos;
}

int RayRecords::components() const {
    int count = 0;
    for (const char letter : letters_) {
        if (letter == '~') continue;
        if (kColors.find(letter) != std::string_view::npos)
            count += is_single(color_) ? 1 : 3;
        else if (kVectors.find(letter) != std::string_view::npos)
            count += 3;
        else
            count += letter == 'c' ? 2 : 1;
    }
    return count;
}

void RayRecords::append(const RayRecord& traced, const Scene& scene, std::string& output) const {
    for (const char letter : letters_) append_field(letter, traced, scene, output);
    if (format_ == NumberFormat::text) output += '\n';
}

void RayRecords::append_field(char letter, const RayRecord& traced, const Scene& scene,
                              std::string& output) const {
    const Ray& ray = traced.ray;
    const bool hit = ray.hit.exists() && !traced.sensor;
    const bool local = hit && ray.hit.t < kHuge;
    const auto name = [&](const std::string& text) { output += (hit ? text : "*") + '\t'; };
    switch (letter) {
        case 'o':
            return append_vector(ray.origin, output);
        case 'd':
            return append_vector(ray.direction, output);
        case 'v':
            return append_color(ray.value, output);
        case 'V':
            return append_color(ray.value * coefficient(ray), output);
        case 'w':
            return append_number(ray.weight, output);
        case 'W':
            return append_vector(as_vector(coefficient(ray)), output);
        case 'l':
            return append_number(traced.sensor ? ray.hit.t : ray.effective_distance(), output);
        case 'L':
            return append_number(ray.hit.t, output);
        case 'c':
            append_number(ray.hit.u, output);
            return append_number(ray.hit.v, output);
        case 'p':
            return append_vector(ray.hit.position, output);
        case 'n':
            return append_vector(local ? shading_normal(ray)
                                 : hit ? -ray.direction
                                       : Vec3{},
                                 output);
        case 'N':
            return append_vector(local ? traced.first.normal
                                 : hit ? -ray.direction
                                       : Vec3{},
                                 output);
        case 's':
            return name(hit ? std::string(scene.surface(ray.hit.surface).name()) : "");
        case 'm':
            return name(hit && ray.hit.modifier != kVoid ? scene.modifier(ray.hit.modifier).name
                                                         : "void");
        case 'M': {
            const std::optional<ModifierId> material =
                hit ? scene.material_of(ray.hit.modifier) : std::nullopt;
            // Of an alias, or an alias of one, the name of what it stands for.
            return name(material ? scene.modifier(*material).primitive->name : "void");
        }
        case 'r':
            return append_color(traced.sensor ? Rgb{} : ray.mirrored, output);
        case 'x':
            return append_color(traced.sensor ? ray.value : ray.value - ray.mirrored, output);
        case 'R':
            return append_number(traced.sensor ? kHuge : ray.reflected_path_length, output);
        case 'X':
            return append_number(traced.sensor ? ray.hit.t : ray.unreflected_path_length, output);
        default:
            output += "~\t";
    }
}

void RayRecords::append_vector(const Vec3& v, std::string& output) const {
    append_number(v.x, output);
    append_number(v.y, output);
    append_number(v.z, output);
}

void RayRecords::append_color(const Rgb& color, std::string& output) const {
    if (color_ == ColorOutput::luminance) {
        return append_number(static_cast<double>(kEfficacy * brightness(color)), output);
    }
    if (color_ == ColorOutput::mean) return append_number(static_cast<double>(mean(color)), output);
    const Rgb shown = color_ == ColorOutput::xyz ? to_xyz(color) : color;
    if (format_ == NumberFormat::rgbe) {
        const Rgbe pixel = encode_rgbe(shown);
        for (const unsigned char byte : {pixel.r, pixel.g, pixel.b, pixel.e})
            output += static_cast<char>(byte);
        return;
    }
    append_vector(as_vector(shown), output);
}

std::string RayRecords::header_end(std::size_t bytes_before, bool one_kind) const {
    std::string text;
    if (one_kind) text = "NCOMP=" + std::to_string(components()) + '\n';
    if (color_ == ColorOutput::xyz) text += kXyzPrimaries;
    if (format_ == NumberFormat::real32 || format_ == NumberFormat::real64) {
        text += std::endian::native == std::endian::big ? "BigEndian=1\n" : "BigEndian=0\n";
    }
    text += "FORMAT=" + std::string(format_name(format_, color_));
    while ((bytes_before + text.size() + 2) % number_size(format_) != 0) text += ' ';
    return text + "\n\n";
}

}  // namespace lightwalk
