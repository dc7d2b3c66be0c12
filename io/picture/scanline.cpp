#include "io/picture/scanline.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/error.h"

namespace lightwalk {
namespace {

constexpr std::size_t kShortestCoded = 17, kLongestCoded = 32767;
constexpr std::size_t kShortestRun = 4, kLongestRun = 127, kLongestLiteral = 128;
constexpr int kMostRepeatBytes = 4;
constexpr std::array<unsigned char Rgbe::*, 4> kComponents{&Rgbe::r, &Rgbe::g, &Rgbe::b, &Rgbe::e};

void put(std::string& out, std::size_t byte) {
    out.push_back(static_cast<char>(byte));
}

/// Bytes without long runs. Two or three equal ones are cheaper as a run.
void put_literal(std::string_view bytes, std::string& out) {
    const bool equal =
        std::all_of(bytes.begin(), bytes.end(), [&](char c) { return c == bytes.front(); });
    if (equal && (bytes.size() == 2 || bytes.size() == 3)) {
        put(out, 128 + bytes.size());
        out.push_back(bytes.front());
        return;
    }
    while (!bytes.empty()) {
        const std::string_view chunk = bytes.substr(0, kLongestLiteral);
        put(out, chunk.size());
        out.append(chunk);
        bytes.remove_prefix(chunk.size());
    }
}

/// Length of the run of equal bytes at the front, at most 127.
std::size_t run_length(std::string_view bytes) {
    const std::size_t longest = std::min(bytes.size(), kLongestRun);
    std::size_t n = 1;
    while (n < longest && bytes[n] == bytes[0]) ++n;
    return n;
}

void encode_component(std::string_view bytes, std::string& out) {
    while (!bytes.empty()) {
        std::size_t begin = 0, run = 0;
        while (begin < bytes.size()) {
            run = run_length(bytes.substr(begin));
            if (run >= kShortestRun) break;
            begin += run;
            run = 0;
        }
        put_literal(bytes.substr(0, begin), out);
        if (run > 0) {
            put(out, 128 + run);
            out.push_back(bytes[begin]);
        }
        bytes.remove_prefix(begin + run);
    }
}

unsigned char take_byte(std::string_view& bytes) {
    if (bytes.empty()) throw InputError("the data end within a scanline");
    const auto byte = static_cast<unsigned char>(bytes.front());
    bytes.remove_prefix(1);
    return byte;
}

Rgbe take_pixel(std::string_view& bytes) {
    if (bytes.size() < 4) throw InputError("the data end within a scanline");
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
    const Rgbe pixel{byte(0), byte(1), byte(2), byte(3)};
    bytes.remove_prefix(4);
    return pixel;
}

/// The components one after the other, each in runs (count byte above 128) and literals.
void decode_components(std::string_view& bytes, std::span<Rgbe> pixels) {
    for (unsigned char Rgbe::*const component : kComponents) {
        for (std::size_t at = 0; at < pixels.size();) {
            const std::size_t code = take_byte(bytes);
            const bool run = code > 128;
            const std::size_t count = run ? code - 128 : code;
            if (count > pixels.size() - at) throw InputError("a run is longer than its scanline");
            const unsigned char value = run ? take_byte(bytes) : 0;
            for (const std::size_t end = at + count; at < end; ++at) {
                pixels[at].*component = run ? value : take_byte(bytes);
            }
        }
    }
}

/// Pixels as they are, but 1 1 1 k repeats the one before it k times; directly following ones count
/// in 256s.
void decode_pixels(std::string_view& bytes, const Rgbe& first, std::span<Rgbe> pixels) {
    pixels[0] = first;
    int repeats = 0;
    for (std::size_t at = 1; at < pixels.size();) {
        const Rgbe pixel = take_pixel(bytes);
        if (pixel.r != 1 || pixel.g != 1 || pixel.b != 1) {
            pixels[at++] = pixel;
            repeats = 0;
            continue;
        }
        if (repeats == kMostRepeatBytes) throw InputError("a repeat count of more than four bytes");
        const std::uint64_t count = std::uint64_t{pixel.e} << (8 * repeats++);
        const std::size_t end = at + std::min<std::uint64_t>(count, pixels.size() - at);
        std::fill(pixels.begin() + static_cast<std::ptrdiff_t>(at),
                  pixels.begin() + static_cast<std::ptrdiff_t>(end), pixels[at - 1]);
        at = end;
    }
}

}  // namespace

void encode_scanline(std::span<const Rgbe> pixels, std::string& out) {
    const std::size_t n = pixels.size();
    if (n < kShortestCoded || n > kLongestCoded) {
        for (const Rgbe& p : pixels) {
            for (unsigned char Rgbe::*const component : kComponents) put(out, p.*component);
        }
        return;
    }
    put(out, 2);
    put(out, 2);
    put(out, n >> 8);
    put(out, n & 255);
    std::string bytes(n, '\0');
    for (unsigned char Rgbe::*const component : kComponents) {
        std::transform(pixels.begin(), pixels.end(), bytes.begin(),
                       [&](const Rgbe& p) { return static_cast<char>(p.*component); });
        encode_component(bytes, out);
    }
}

void decode_scanline(std::string_view& bytes, std::span<Rgbe> pixels) {
    const Rgbe first = take_pixel(bytes);
    if (first.r != 2 || first.g != 2 || first.b >= 128) {
        decode_pixels(bytes, first, pixels);
        return;
    }
    const std::size_t length = first.b * std::size_t{256} + first.e;
    if (length != pixels.size()) {
        throw InputError("scanline of length " + std::to_string(length) + ", expected " +
                         std::to_string(pixels.size()));
    }
    decode_components(bytes, pixels);
}

}  // namespace lightwalk
