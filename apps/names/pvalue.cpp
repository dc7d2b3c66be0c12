// pvalue: the pixels of a picture as numbers, and numbers as a picture.
#include <array>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <iterator>
#include <optional>

#include "apps/command_run.h"
#include "apps/names/named_program.h"
#include "apps/names/program_words.h"
#include "core/math/rgbe.h"
#include "core/model/transform_args.h"
#include "io/formats/words.h"
#include "io/picture/resolution_line.h"
#include "io/picture/rgbe_picture.h"
#include "io/picture/scanline.h"

namespace lightwalk {
namespace {

struct PvalueCommand {
    bool header = true, resolution = true, places = true, brightness_only = false;
    bool original = false, unique = false, reverse = false, blue_first = false;
    int skip = 0;       ///< bytes of what is read, behind its header
    char format = 'a';  ///< a text, i integers, b bytes, f floats, d doubles
    double gamma = 1, multiplier = 1;
    int x = 0, y = 0;     ///< with -r -H
    std::string file;     ///< "": standard input
    std::string history;  ///< the command line, but for the file
};

/// "+2" and "-1" are stops, other numbers factors.
double exposure_factor(ProgramWords& words) {
    const std::string& word = words.text("an exposure");
    double value = 0;
    if (!parse_real(word, value)) throw UsageError("option -e: expected a number, found " + word);
    return word[0] == '+' || word[0] == '-' ? std::pow(2.0, value) : value;
}

char data_format(const std::string& option, const ProgramWords& words) {
    if (option.size() == 2) return 'a';
    if (option.size() == 3 && std::string_view("aibfd").find(option[2]) != std::string_view::npos)
        return option[2];
    words.refuse("expected -d, -da, -di, -db, -df or -dd");
}

PvalueCommand parse_pvalue(const std::string& name, const std::vector<std::string>& line) {
    PvalueCommand c;
    ProgramWords words(line);
    const auto more = [&] {
        return words.at_option() || (!words.at_end() && words.rest()[0].starts_with('+'));
    };
    while (more()) {
        const std::string option = words.take();
        const bool on = option[0] == '+';
        const std::string_view what = std::string_view(option).substr(1);
        if (what == "h")
            c.header = on;
        else if (what == "H")
            c.resolution = on;
        else if (what == "x")
            c.x = words.integer("a width", 1, 1 << 20);
        else if (what == "y")
            c.y = words.integer("a height", 1, 1 << 20);
        else if (on && what == "d")
            c.places = true;
        else if (on)
            words.unknown();
        else if (what[0] == 'd')
            c.places = false, c.format = data_format(option, words);
        else if (what == "b")
            c.brightness_only = true;
        else if (what == "o")
            c.original = true;
        else if (what == "u")
            c.unique = true;
        else if (what == "r")
            c.reverse = true;
        else if (what == "R")
            c.blue_first = true;
        else if (what == "s")
            c.skip = words.integer("a number of bytes", 0, 1 << 30);
        else if (what == "n")
            words.refuse("write one channel at a time, by -b or by another program");
        else if (what == "e")
            c.multiplier *= exposure_factor(words);
        else if (what == "g")
            c.gamma = words.real("a gamma");
        else
            words.unknown();
    }
    c.history = words.history(name);
    const std::vector<std::string> files = words.rest();
    if (files.size() > 1) throw UsageError("bad # file arguments");
    if (!files.empty()) c.file = files[0];
    if (!(c.gamma > 0) || !(c.multiplier > 0)) throw UsageError("expected a positive number");
    return c;
}

std::string input_of(const PvalueCommand& command) {
    return command.file.empty() ? read_standard_input() : read_file(command.file);
}

const char* format_name(const PvalueCommand& c) {
    switch (c.format) {
        case 'f':
            return "float";
        case 'd':
            return "double";
        case 'b':
            return c.brightness_only ? "byte" : "24-bit_rgb";
        default:
            return "ascii";
    }
}

class PixelWriter {
  public:
    explicit PixelWriter(const PvalueCommand& command) : c_(command) {}

    void header(const RgbePicture& picture) {
        for (const std::string& line : picture.header.lines)
            if (!(c_.original && line.starts_with("EXPOSURE="))) bytes_ += line + '\n';
        bytes_ += c_.history + '\n';
        if (c_.multiplier != 1) print("EXPOSURE=%.4e\n", c_.multiplier);
        if (!c_.places) bytes_ += c_.brightness_only ? "NCOMP=1\n" : "NCOMP=3\n";
        if (c_.format == 'f' || c_.format == 'd') bytes_ += "BigEndian=0\n";
        bytes_ += std::string("FORMAT=") + format_name(c_) + "\n\n";
    }
    void resolution(int width, int height) { print("-Y %8d +X %8d\n", height, width); }

    void pixel(int x, int y, const Rgb& color) {
        std::array<double, 3> values{static_cast<double>(color.r), static_cast<double>(color.g),
                                     static_cast<double>(color.b)};
        if (c_.brightness_only) values[0] = static_cast<double>(brightness(color));
        if (c_.blue_first) std::swap(values[0], values[2]);
        for (double& value : values) value = std::pow(value * c_.multiplier, 1 / c_.gamma);
        if (c_.places) print("%7d %7d ", x, y);
        const std::size_t count = c_.brightness_only ? 1 : 3;
        for (std::size_t i = 0; i < count; ++i) number(values[i], i > 0);
        if (c_.format == 'a' || c_.format == 'i') bytes_ += '\n';
        constexpr std::size_t kEnoughBytes = std::size_t{1} << 16;
        if (bytes_.size() > kEnoughBytes) flush();
    }
    void flush() {
        write_to_stdout(bytes_);
        bytes_.clear();
    }

  private:
    template <class... Values>
    void print(const char* format, Values... values) {
        char text[96];
        std::snprintf(text, sizeof text, format, values...);
        bytes_ += text;
    }
    void number(double value, bool follows) {
        const auto level = [&] { return std::min(256 * value, 2e9); };
        switch (c_.format) {
            case 'f':
                return append(static_cast<float>(value));
            case 'd':
                return append(value);
            case 'b':
                return append(static_cast<unsigned char>(std::min(level(), 255.0)));
            case 'i':
                return print(follows ? " %d" : "%d", static_cast<int>(level()));
            default:
                return print(follows ? " %15.3e" : "%15.3e", value);
        }
    }
    template <class Number>
    void append(Number number) {
        bytes_.append(reinterpret_cast<const char*>(&number), sizeof number);
    }

    const PvalueCommand& c_;
    std::string bytes_;
};

void write_values(const PvalueCommand& c) {
    const std::string name = c.file.empty() ? "standard input" : c.file;
    const RgbePicture picture = decode_rgbe_picture(input_of(c), name, XyzPictures::accept);
    PixelWriter writer(c);
    if (c.header) writer.header(picture);
    if (c.resolution) writer.resolution(picture.width, picture.height);
    const auto factor =
        static_cast<float>(c.original ? 1 / header_product(picture.header, "EXPOSURE", name) : 1);
    std::optional<Rgbe> last;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        if (c.unique && last == picture.pixels[i]) continue;
        last = picture.pixels[i];
        const int column = static_cast<int>(i % static_cast<std::size_t>(picture.width));
        const int row = static_cast<int>(i / static_cast<std::size_t>(picture.width));
        writer.pixel(column, picture.height - 1 - row, decode_rgbe(picture.pixels[i]) * factor);
    }
    writer.flush();
}

/// Numbers of standard input or a file, one after the other.
class NumberSource {
  public:
    NumberSource(const PvalueCommand& command, std::string_view bytes)
        : c_(command), rest_(bytes) {}

    double next() {
        switch (c_.format) {
            case 'f':
                return static_cast<double>(take<float>());
            case 'd':
                return take<double>();
            case 'b':
                return (take<unsigned char>() + .5) / 256;
            default:
                return (word() + (c_.format == 'i' ? .5 : 0)) / (c_.format == 'i' ? 256 : 1);
        }
    }
    double word() {
        const std::string_view text = next_word(rest_);
        double value = 0;
        if (!parse_real(text, value))
            throw InputError(text.empty()
                                 ? "read error: the numbers end too soon"
                                 : "expected a number, found \"" + std::string(text) + '"');
        return value;
    }

  private:
    static std::string_view next_word(std::string_view& rest) {
        const std::size_t begin = std::min(rest.find_first_not_of(" \t\r\n"), rest.size());
        rest.remove_prefix(begin);
        const std::string_view word = rest.substr(0, rest.find_first_of(" \t\r\n"));
        rest.remove_prefix(word.size());
        return word;
    }
    template <class Number>
    Number take() {
        Number number{};
        if (rest_.size() < sizeof number) throw InputError("read error: the numbers end too soon");
        std::copy_n(rest_.data(), sizeof number, reinterpret_cast<char*>(&number));
        rest_.remove_prefix(sizeof number);
        return number;
    }

    const PvalueCommand& c_;
    std::string_view rest_;
};

void write_reverse(const PvalueCommand& c) {
    constexpr double kMostPixels = 1 << 28;
    const std::string bytes = input_of(c);
    std::string_view rest = bytes;
    std::string picture = "#?RADIANCE\n";
    const std::string name = c.file.empty() ? "standard input" : c.file;
    if (c.header) {
        const InfoHeader header = decode_header(bytes, name);
        picture.clear();
        for (const std::string& line : header.lines)
            if (!line.starts_with("NCOMP=") && !line.starts_with("BigEndian="))
                picture += line + '\n';
        rest.remove_prefix(header.size);
    }
    PictureResolution size;
    if (c.x > 0 && c.y > 0)
        size = {c.x, c.y, false, false, true};
    else if (!c.resolution)
        throw UsageError("missing resolution");
    if (c.resolution) size = take_resolution(rest, name);
    if (!size.standard()) throw InputError({name, 0}, "expected rows from the top, -Y ... +X ...");
    if (static_cast<double>(size.width) * size.height > kMostPixels)
        throw InputError({name, 0}, "too many pixels");
    picture += c.history + "\nFORMAT=32-bit_rle_rgbe\n\n";
    char line[64];
    std::snprintf(line, sizeof line, "-Y %8d +X %8d\n", size.height, size.width);
    picture += line;
    rest.remove_prefix(std::min(rest.size(), static_cast<std::size_t>(c.skip)));
    NumberSource numbers(c, rest);
    std::vector<Rgbe> row(static_cast<std::size_t>(size.width));
    for (int y = 0; y < size.height; ++y) {
        for (Rgbe& pixel : row) {
            if (c.places)
                for (int i = 0; i < 2; ++i) (void)numbers.word();
            std::array<double, 3> v{};
            for (std::size_t i = 0; i < 3; ++i)
                v[i] = c.brightness_only && i > 0
                           ? v[0]
                           : std::pow(std::max(numbers.next(), 0.0), c.gamma) * c.multiplier;
            if (c.blue_first) std::swap(v[0], v[2]);
            pixel = encode_rgbe(
                {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])});
        }
        encode_scanline(row, picture);
    }
    write_to_stdout(picture);
}

}  // namespace

int run_pvalue(const std::string& name, const std::vector<std::string>& words,
               Communicator* /*ranks*/) {
    const PvalueCommand command = parse_pvalue(name, words);
    if (command.reverse)
        write_reverse(command);
    else
        write_values(command);
    return kSuccessStatus;
}

}  // namespace lightwalk
