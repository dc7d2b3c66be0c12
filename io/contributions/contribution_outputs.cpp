#include "io/contributions/contribution_outputs.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdio>
#include <cstring>

#include "core/math/rgbe.h"
#include "io/options/option_words.h"

namespace lightwalk {
namespace {

constexpr std::size_t kWidest = 20;  ///< digits of a bin's number

/// A specification, divided at its conversions.
struct NamePattern {
    struct Piece {
        char kind = 't';  ///< t text, s modifier, d bin
        std::string text;
        std::size_t width = 0;
        bool zeros = false;
    };
    std::vector<Piece> pieces;

    [[nodiscard]] bool has(char kind) const {
        return std::ranges::any_of(pieces, [kind](const Piece& p) { return p.kind == kind; });
    }
};

[[noreturn]] void refuse(const std::string& specification) {
    throw UsageError("option -o: bad output format \"" + specification +
                     "\", expected a file's name with at most one %s (the modifier) and one %d or "
                     "%04d (the bin)");
}

/// The conversion whose % stands before `at`, which moves behind it.
NamePattern::Piece conversion(const std::string& specification, std::size_t& at) {
    NamePattern::Piece piece;
    const auto current = [&] { return at < specification.size() ? specification[at] : '\0'; };
    if (current() == '%') {
        ++at;
        piece.text = '%';
        return piece;
    }
    if (current() == '0') piece.zeros = true;
    const std::size_t digits = at;
    while (current() >= '0' && current() <= '9')
        piece.width = piece.width * 10 + static_cast<std::size_t>(specification[at++] - '0');
    piece.kind = current();
    const bool fits = piece.kind == 'd' || (piece.kind == 's' && at == digits);
    if (!fits || piece.width > kWidest) refuse(specification);
    ++at;
    return piece;
}

NamePattern parse_specification(const std::string& specification) {
    if (specification.starts_with('!'))
        throw UsageError("option -o: " + specification +
                         " is a command, which Lightwalk does not run: expected a file's name");
    NamePattern pattern;
    for (std::size_t at = 0; at < specification.size();) {
        if (specification[at] == '%') {
            NamePattern::Piece piece = conversion(specification, ++at);
            if (piece.kind != 't' && pattern.has(piece.kind)) refuse(specification);
            pattern.pieces.push_back(std::move(piece));
            continue;
        }
        const std::size_t end = std::min(specification.find('%', at), specification.size());
        pattern.pieces.push_back({'t', specification.substr(at, end - at), 0, false});
        at = end;
    }
    return pattern;
}

std::string name_of(const NamePattern& pattern, const std::string& modifier, std::size_t bin) {
    std::string name;
    for (const NamePattern::Piece& piece : pattern.pieces) {
        if (piece.kind == 't') name += piece.text;
        if (piece.kind == 's') name += modifier;
        if (piece.kind != 'd') continue;
        const std::string digits = std::to_string(bin);
        if (digits.size() < piece.width)
            name.append(piece.width - digits.size(), piece.zeros ? '0' : ' ');
        name += digits;
    }
    return name;
}

std::size_t size_of(NumberFormat format) {
    return format == NumberFormat::real64   ? sizeof(double)
           : format == NumberFormat::real32 ? sizeof(float)
                                            : 1;
}

template <class Number>
Number number_at(std::string_view bytes, std::size_t i) {
    Number value{};
    std::memcpy(&value, bytes.data() + i * sizeof value, sizeof value);
    return value;
}

/// The numbers of a record's columns, as they lie in memory.
template <class Number>
void append_numbers(const std::vector<std::size_t>& columns, const std::vector<double>& sums,
                    double scale, std::string& bytes) {
    const std::size_t before = bytes.size();
    bytes.resize(before + columns.size() * 3 * sizeof(Number));
    char* at = bytes.data() + before;
    for (const std::size_t column : columns) {
        const double* const sum = &sums[3 * column];
        const std::array<Number, 3> color{static_cast<Number>(sum[0] * scale),
                                          static_cast<Number>(sum[1] * scale),
                                          static_cast<Number>(sum[2] * scale)};
        std::memcpy(at, color.data(), sizeof color);
        at += sizeof color;
    }
}

/// As text or RGBE.
void append_color(NumberFormat format, const std::array<double, 3>& c, std::string& bytes) {
    if (format == NumberFormat::rgbe) {
        const Rgbe pixel = encode_rgbe(
            {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])});
        for (const unsigned char byte : {pixel.r, pixel.g, pixel.b, pixel.e})
            bytes += static_cast<char>(byte);
        return;
    }
    for (const double value : c) {
        std::array<char, 32> text{};
        const int size = std::snprintf(text.data(), text.size(), "%e\t", value);
        bytes.append(text.data(), static_cast<std::size_t>(size));
    }
}

}  // namespace

std::vector<ContributionOutput> contribution_outputs(const std::vector<OutputRequest>& requests) {
    std::vector<ContributionOutput> outputs;
    std::size_t column = 0;
    for (const OutputRequest& request : requests) {
        const NamePattern pattern = parse_specification(request.specification);
        const bool by_modifier = pattern.has('s'), by_bin = pattern.has('d');
        for (std::size_t bin = 0; bin < request.bins; ++bin, ++column) {
            const std::string file = name_of(pattern, request.modifier, bin);
            auto at = std::ranges::find(outputs, file, &ContributionOutput::file);
            if (at == outputs.end()) {
                at = outputs.insert(outputs.end(), ContributionOutput{});
                at->file = file;
                if (by_modifier) at->modifier = request.modifier;
                if (by_bin) at->bin = bin;
            }
            at->columns.push_back(column);
        }
    }
    return outputs;
}

std::size_t RecordFormat::record_size(std::size_t columns) const {
    if (numbers == NumberFormat::text) return 0;
    return columns * (numbers == NumberFormat::rgbe ? 4 : 3 * size_of(numbers));
}

void RecordFormat::append(const ContributionOutput& output, const std::vector<double>& sums,
                          double scale, std::string& bytes) const {
    if (numbers == NumberFormat::real32)
        return append_numbers<float>(output.columns, sums, scale, bytes);
    if (numbers == NumberFormat::real64)
        return append_numbers<double>(output.columns, sums, scale, bytes);
    for (const std::size_t column : output.columns) {
        const double* const sum = &sums[3 * column];
        append_color(numbers, {sum[0] * scale, sum[1] * scale, sum[2] * scale}, bytes);
    }
    if (numbers == NumberFormat::text) bytes += '\n';
}

bool RecordFormat::add(const ContributionOutput& output, std::string_view record,
                       std::vector<double>& sums) const {
    const char* at = record.data();
    const char* const end = at + record.size();
    for (std::size_t i = 0; i < output.columns.size(); ++i) {
        double* const sum = &sums[3 * output.columns[i]];
        if (numbers == NumberFormat::rgbe) {
            const auto byte = [&](std::size_t k) {
                return static_cast<unsigned char>(record[4 * i + k]);
            };
            const Rgb color = decode_rgbe({byte(0), byte(1), byte(2), byte(3)});
            for (std::size_t k = 0; k < 3; ++k) sum[k] += static_cast<double>(color[k]);
            continue;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            double value = 0;
            if (numbers == NumberFormat::real64) {
                value = number_at<double>(record, 3 * i + k);
            } else if (numbers == NumberFormat::real32) {
                value = static_cast<double>(number_at<float>(record, 3 * i + k));
            } else {
                while (at != end && (*at == '\t' || *at == ' ')) ++at;
                const auto read = std::from_chars(at, end, value);
                if (read.ec != std::errc()) return false;
                at = read.ptr;
            }
            sum[k] += value;
        }
    }
    return true;
}

std::string RecordFormat::header(const ContributionOutput& output,
                                 const std::vector<std::string>& history) const {
    std::string text = "#?RADIANCE\n";
    for (const std::string& line : history) text += line + '\n';
    text += "NCOMP=3\n";
    if (!output.modifier.empty()) text += "MODIFIER=" + output.modifier + '\n';
    if (output.bin) text += "BIN=" + std::to_string(*output.bin) + '\n';
    const bool single = output.columns.size() == 1;
    const auto rows = static_cast<long long>(y) * std::max(x, 1);
    if (y > 0) text += "NROWS=" + std::to_string(rows) + '\n';
    if (!single || x <= 0) text += "NCOLS=" + std::to_string(output.columns.size()) + '\n';
    if (numbers == NumberFormat::real32 || numbers == NumberFormat::real64)
        text += std::endian::native == std::endian::big ? "BigEndian=1\n" : "BigEndian=0\n";
    text += std::string("FORMAT=") + (numbers == NumberFormat::text     ? "ascii"
                                      : numbers == NumberFormat::real32 ? "float"
                                      : numbers == NumberFormat::real64 ? "double"
                                                                        : "32-bit_rle_rgbe");
    // Binary data start at a multiple of their size.
    std::string resolution;
    if (single && x > 0 && y > 0) {
        std::array<char, 64> line{};
        std::snprintf(line.data(), line.size(), "-Y %8d +X %8d\n", y, x);
        resolution = line.data();
    }
    while ((text.size() + 2 + resolution.size()) % size_of(numbers) != 0) text += ' ';
    return text + "\n\n" + resolution;
}

}  // namespace lightwalk
