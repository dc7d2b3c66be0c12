#include "io/ambient/ambient_file.h"

#include <cmath>
#include <optional>

#include "core/error.h"
#include "core/math/rgbe.h"
#include "io/formats/binary_reader.h"
#include "io/formats/header.h"

namespace lightwalk {
namespace {

constexpr std::int64_t kMagic = 561;
constexpr double kLargest = 1e10;
constexpr const char* kFormat = "Radiance_ambval";

void put_integer(std::string& out, std::uint64_t value, int size) {
    for (int k = size - 1; k >= 0; --k) out.push_back(static_cast<char>(value >> (8 * k) & 0xff));
}

/// Mantissa in four bytes, exponent of two in one.
void put_real(std::string& out, float value) {
    int exponent = 0;
    const double fraction = std::frexp(static_cast<double>(value), &exponent);
    auto mantissa = static_cast<std::int64_t>(fraction * 0x7fffffff);
    if (exponent > 127) {
        exponent = 127;
        mantissa = value > 0 ? 0x7fffffff : -0x7fffffff;
    } else if (exponent < -128) {
        exponent = 0;
        mantissa = 0;
    }
    put_integer(out, static_cast<std::uint64_t>(mantissa), 4);
    put_integer(out, static_cast<std::uint64_t>(exponent), 1);
}

bool within(double value, double least, double most) {
    return value >= least && value <= most;
}

/// What is wrong with a record; nothing when it can be used.
std::optional<std::string> problem(const AmbientRecord& r) {
    for (const float p : r.position) {
        if (!within(static_cast<double>(p), -kLargest, kLargest)) return "a position out of range";
    }
    if (r.normal == 0 || r.axis == 0) return "a direction that is none";
    if (!(r.weight > 0 && r.weight <= 1)) return "a weight out of range";
    for (const float radius : r.radius) {
        if (!(radius > 0 && static_cast<double>(radius) < kLargest)) return "a radius out of range";
    }
    if (static_cast<double>(r.radius[0]) > static_cast<double>(r.radius[1]) + kEpsilon)
        return "radii in the wrong order";
    for (const auto& gradient : {r.translation, r.rotation}) {
        for (const float g : gradient) {
            if (!within(static_cast<double>(g), -kLargest, kLargest))
                return "a gradient out of range";
        }
    }
    for (std::size_t k = 0; k < 3; ++k) {
        if (!within(static_cast<double>(r.value[k]), 0, kLargest)) return "a value out of range";
    }
    return std::nullopt;
}

AmbientRecord read_record(BinaryReader& reader) {
    const auto real = [&reader] { return static_cast<float>(reader.real()); };
    AmbientRecord r;
    r.level = static_cast<std::uint8_t>(reader.unsigned_integer(1));
    r.weight = real();
    for (float& p : r.position) p = real();
    r.normal = static_cast<std::uint32_t>(reader.unsigned_integer(4));
    r.axis = static_cast<std::uint32_t>(reader.unsigned_integer(4));
    for (auto* pair : {&r.radius, &r.translation, &r.rotation}) {
        for (float& x : *pair) x = real();
    }
    r.corral = static_cast<std::uint32_t>(reader.unsigned_integer(4));
    const auto byte = [&reader] { return static_cast<std::uint8_t>(reader.unsigned_integer(1)); };
    const std::uint8_t red = byte(), green = byte(), blue = byte(), exponent = byte();
    r.value = decode_rgbe({red, green, blue, exponent});
    return r;
}

/// Channels of the header; three where it says nothing.
int channels(const InfoHeader& header) {
    for (const std::string& line : header.lines) {
        if (const auto value = header_variable(line, "NCOMP"))
            return std::atoi(std::string(*value).c_str());
    }
    return 3;
}

}  // namespace

AmbientFile decode_ambient_file(std::string_view bytes, const std::string& name) {
    const InfoHeader header = decode_header(bytes, name);
    if (header.format != kFormat)
        throw InputError({name, 0}, "not an ambient file, expected FORMAT=Radiance_ambval");
    if (channels(header) != 3)
        throw InputError({name, 0},
                         "an ambient file of other than three channels is not supported");
    AmbientFile file;
    file.header = header.lines;
    BinaryReader reader(bytes.substr(header.size), name, "ambient file");
    if (reader.integer(2) != kMagic)
        throw InputError({name, 0}, "an ambient file of another version of Radiance");
    file.size = header.size + 2;
    while (reader.remaining() >= kAmbientRecordSize) {
        const AmbientRecord record = read_record(reader);
        if (const auto wrong = problem(record)) {
            file.damage = "record " + std::to_string(file.records.size() + 1) + " has " + *wrong;
            return file;
        }
        file.records.push_back(record);
        file.size += kAmbientRecordSize;
    }
    if (reader.remaining() > 0) file.damage = "the last record is incomplete";
    return file;
}

std::string encode_ambient_header(const std::vector<std::string>& lines) {
    std::string out = "#?RADIANCE\n";
    for (const std::string& line : lines) out += line + "\n";
    out += "NCOMP=3\nFORMAT=" + std::string(kFormat) + "\n\n";
    put_integer(out, static_cast<std::uint64_t>(kMagic), 2);
    return out;
}

std::string encode_ambient_record(const AmbientRecord& r) {
    std::string out;
    put_integer(out, r.level, 1);
    put_real(out, r.weight);
    for (const float p : r.position) put_real(out, p);
    put_integer(out, r.normal, 4);
    put_integer(out, r.axis, 4);
    for (const auto* pair : {&r.radius, &r.translation, &r.rotation}) {
        for (const float x : *pair) put_real(out, x);
    }
    put_integer(out, r.corral, 4);
    const Rgbe pixel = encode_rgbe(r.value);
    for (const std::uint8_t byte : {pixel.r, pixel.g, pixel.b, pixel.e})
        out.push_back(static_cast<char>(byte));
    return out;
}

}  // namespace lightwalk
