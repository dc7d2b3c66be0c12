#include "io/rays/ray_reader.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "core/model/transform_args.h"

namespace lightwalk {
namespace {

constexpr std::size_t kBufferBytes = 65536;
constexpr std::size_t kLongestNumber = 31;

bool is_blank(int c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

std::optional<NumberFormat> format_of(char letter) {
    switch (letter) {
        case 'a':
            return NumberFormat::text;
        case 'f':
            return NumberFormat::real32;
        case 'd':
            return NumberFormat::real64;
        case 'c':
            return NumberFormat::rgbe;
        default:
            return std::nullopt;
    }
}

}  // namespace

std::optional<RayFormats> parse_ray_formats(std::string_view letters) {
    if (letters.empty() || letters.size() > 2) return std::nullopt;
    const std::optional<NumberFormat> input = format_of(letters.front());
    const std::optional<NumberFormat> output = format_of(letters.back());
    if (!input || !output || *input == NumberFormat::rgbe) return std::nullopt;
    return RayFormats{*input, *output};
}

std::optional<InputRay> RayReader::next() {
    std::array<double, 6> v{};
    for (double& value : v) {
        if (ended_ || !number(value) || !std::isfinite(value)) {
            ended_ = true;
            return std::nullopt;
        }
    }
    return InputRay{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
}

bool RayReader::drained() {
    if (format_ == NumberFormat::text) {
        while (at_ < buffer_.size() && is_blank(static_cast<unsigned char>(buffer_[at_]))) ++at_;
    }
    return at_ == buffer_.size();
}

bool RayReader::fill() {
    buffer_.resize(kBufferBytes);
    at_ = 0;
    ssize_t count = 0;
    do {
        count = ::read(descriptor_, buffer_.data(), buffer_.size());
    } while (count < 0 && errno == EINTR);
    buffer_.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return !buffer_.empty();
}

int RayReader::byte() {
    if (at_ == buffer_.size() && !fill()) return -1;
    return static_cast<unsigned char>(buffer_[at_++]);
}

bool RayReader::word(std::string& text) {
    text.clear();
    int c = byte();
    while (is_blank(c)) c = byte();
    const int quote = c == '"' || c == '\'' ? c : 0;
    if (quote != 0) c = byte();
    while (c >= 0 && (quote != 0 ? c != quote : !is_blank(c))) {
        text += static_cast<char>(c);
        if (text.size() > kLongestNumber) return false;
        c = byte();
    }
    return !text.empty();
}

bool RayReader::number(double& value) {
    if (format_ == NumberFormat::text) {
        std::string text;
        return word(text) && parse_real(text, value);
    }
    std::array<char, sizeof(double)> bytes{};
    const std::size_t size = format_ == NumberFormat::real32 ? sizeof(float) : sizeof(double);
    for (std::size_t i = 0; i < size; ++i) {
        const int c = byte();
        if (c < 0) return false;
        bytes[i] = static_cast<char>(c);
    }
    if (format_ == NumberFormat::real64) {
        std::memcpy(&value, bytes.data(), sizeof value);
        return true;
    }
    float single = 0;
    std::memcpy(&single, bytes.data(), sizeof single);
    value = static_cast<double>(single);
    return true;
}

}  // namespace lightwalk
