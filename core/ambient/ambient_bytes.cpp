#include "core/ambient/ambient_bytes.h"

#include <cassert>
#include <cstdint>

#include "core/math/portable_numbers.h"
#include "core/math/rgbe.h"

namespace lightwalk {
namespace {

constexpr double kLargest = 1e10;  ///< of positions [m], radii [m], gradients and values

bool within(double value, double least, double most) {
    return value >= least && value <= most;
}

}  // namespace

std::string encode_ambient_record(const AmbientRecord& r) {
    std::string out;
    out.reserve(kAmbientRecordSize);
    append_integer(out, r.level, 1);
    append_real(out, r.weight);
    for (const float p : r.position) append_real(out, p);
    append_integer(out, r.normal, 4);
    append_integer(out, r.axis, 4);
    for (const auto* pair : {&r.radius, &r.translation, &r.rotation}) {
        for (const float x : *pair) append_real(out, x);
    }
    append_integer(out, r.corral, 4);
    const Rgbe pixel = encode_rgbe(r.value);
    for (const std::uint8_t byte : {pixel.r, pixel.g, pixel.b, pixel.e})
        out.push_back(static_cast<char>(byte));
    return out;
}

AmbientRecord decode_ambient_record(std::string_view bytes) {
    assert(bytes.size() >= kAmbientRecordSize);
    const auto real = [&bytes] { return static_cast<float>(take_real(bytes)); };
    const auto word = [&bytes] {
        return static_cast<std::uint32_t>(take_unsigned_integer(bytes, 4));
    };
    const auto byte = [&bytes] {
        return static_cast<std::uint8_t>(take_unsigned_integer(bytes, 1));
    };
    AmbientRecord r;
    r.level = byte();
    r.weight = real();
    for (float& p : r.position) p = real();
    r.normal = word();
    r.axis = word();
    for (auto* pair : {&r.radius, &r.translation, &r.rotation}) {
        for (float& x : *pair) x = real();
    }
    r.corral = word();
    const std::uint8_t red = byte(), green = byte(), blue = byte(), exponent = byte();
    r.value = decode_rgbe({red, green, blue, exponent});
    return r;
}

std::optional<std::string> ambient_record_problem(const AmbientRecord& r) {
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

}  // namespace lightwalk
