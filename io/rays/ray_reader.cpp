#include "io/rays/ray_reader.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <system_error>

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
    std::size_t first_line = 0;
    for (std::size_t i = 0; i < v.size(); ++i) {
        const Found found = ended_ ? Found::end : number(v[i]);
        if (found != Found::number) {
            if (found == Found::end && i > 0 && !ended_)
                fail("the last ray is incomplete: " + std::to_string(i) + " of 6 numbers");
            ended_ = true;
            return std::nullopt;
        }
        if (i == 0) first_line = word_line_;
    }
    ++rays_;
    if (format_ == NumberFormat::text) note_lines(first_line);
    return InputRay{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
}

/// Of a ray that has been read.
void RayReader::note_lines(std::size_t first_line) {
    if (misaligned_line_ == 0 && first_line == last_line_ && word_line_ != first_line)
        misaligned_line_ = first_line;
    last_line_ = word_line_;
}

RayReader::Found RayReader::fail(const std::string& what) {
    if (!problem_.empty()) return Found::fault;  // the first one counts
    problem_ = "standard input:";
    if (format_ == NumberFormat::text)
        problem_ += std::to_string(word_line_);
    else
        problem_ += " ray " + std::to_string(rays_ + 1);
    problem_ += ": " + what;
    return Found::fault;
}

bool RayReader::drained() {
    if (format_ == NumberFormat::text) {
        for (; at_ < buffer_.size() && is_blank(static_cast<unsigned char>(buffer_[at_])); ++at_)
            line_ += buffer_[at_] == '\n' ? 1 : 0;
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
    if (count < 0) fail("cannot be read: " + std::generic_category().message(errno));
    buffer_.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return !buffer_.empty();
}

int RayReader::byte() {
    if (at_ == buffer_.size() && !fill()) return -1;
    return static_cast<unsigned char>(buffer_[at_++]);
}

/// Fault: the word is longer than any number.
RayReader::Found RayReader::word(std::string& text) {
    text.clear();
    int c = byte();
    for (; is_blank(c); c = byte()) line_ += c == '\n' ? 1 : 0;
    if (c < 0) return Found::end;
    word_line_ = line_;
    const int quote = c == '"' || c == '\'' ? c : 0;
    if (quote != 0) c = byte();
    while (c >= 0 && (quote != 0 ? c != quote : !is_blank(c))) {
        text += static_cast<char>(c);
        if (text.size() > kLongestNumber) return Found::fault;
        c = byte();
    }
    line_ += c == '\n' ? 1 : 0;
    return Found::number;
}

RayReader::Found RayReader::number(double& value) {
    const Found found =
        format_ == NumberFormat::text ? number_of_text(value) : number_of_bytes(value);
    if (!problem_.empty()) return Found::fault;  // of the system
    if (found == Found::number && !std::isfinite(value)) return fail("a number is not finite");
    return found;
}

RayReader::Found RayReader::number_of_text(double& value) {
    std::string text;
    const Found found = word(text);
    if (found == Found::end) return Found::end;
    if (found == Found::fault) text += "...";
    if (found == Found::number && parse_real(text, value)) return Found::number;
    return fail("expected six numbers for each ray, found \"" + text + '"');
}

RayReader::Found RayReader::number_of_bytes(double& value) {
    std::array<char, sizeof(double)> bytes{};
    const std::size_t size = format_ == NumberFormat::real32 ? sizeof(float) : sizeof(double);
    for (std::size_t i = 0; i < size; ++i) {
        const int c = byte();
        if (c < 0) return i == 0 ? Found::end : fail("the last ray is incomplete");
        bytes[i] = static_cast<char>(c);
    }
    if (format_ == NumberFormat::real64) {
        std::memcpy(&value, bytes.data(), sizeof value);
    } else {
        float single = 0;
        std::memcpy(&single, bytes.data(), sizeof single);
        value = static_cast<double>(single);
    }
    return Found::number;
}

}  // namespace lightwalk
