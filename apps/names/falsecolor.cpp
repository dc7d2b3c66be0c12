// falsecolor: values of a picture as colours, contour lines or bands, with a legend.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>

#include "apps/command_run.h"
#include "apps/names/named_program.h"
#include "apps/names/program_words.h"
#include "core/math/rgb.h"
#include "core/model/transform_args.h"
#include "io/picture/display.h"
#include "io/picture/picture.h"
#include "io/picture/pixel_font.h"

namespace lightwalk {
namespace {

enum class Drawing { colours, lines, bands, steps };

/// Colours of a scale, 0 to 1, as light.
using Palette = std::array<double, 3> (*)(double at);

struct FalsecolorCommand {
    std::string input, background;
    Drawing drawing = Drawing::colours;
    bool extrema = false;
    double scale = 1000, multiplier = kEfficacy;
    bool automatic = false;  ///< the scale ends at the greatest value
    double decades = 0;      ///< 0: linear
    int divisions = 8, width = 100, height = 200, digits = 3;
    std::string label = "cd/m2";
    Palette palette = nullptr;
};

/// The scale that the page of a walk has, which is told in shares of what a screen shows.
std::array<double, 3> own_palette(double at) {
    constexpr double kGamma = 2.2;
    std::array<double, 3> colour = scale_colour(at);
    for (double& part : colour) part = std::pow(part, kGamma);
    return colour;
}
/// Source: Radiance manual page falsecolor(1), the mapping of -spec.
std::array<double, 3> spectrum(double at) {
    const auto part = [](double value) { return std::clamp(value, 0.0, 1.0); };
    return {part(1.6 * at - .6), part(at < .375 ? 8.0 / 3 * at : 1.6 - 1.6 * at),
            part(1 - 8.0 / 3 * at)};
}
/// Source: Gnuplot's manual, "set palette rgbformulae": 21, 22, 23 and 7, 5, 15.
std::array<double, 3> hot(double at) {
    const auto part = [](double value) { return std::clamp(value, 0.0, 1.0); };
    return {part(3 * at), part(3 * at - 1), part(3 * at - 2)};
}
std::array<double, 3> pm3d(double at) {
    return {std::sqrt(at), at * at * at, std::max(0.0, std::sin(2 * kPi * at))};
}

Palette palette_option(ProgramWords& words) {
    const std::string& name = words.text("a palette");
    if (name == "def") return own_palette;
    if (name == "spec") return spectrum;
    if (name == "hot") return hot;
    if (name == "pm3d") return pm3d;
    words.refuse("expected def, spec, hot or pm3d");
}

void take_scale(FalsecolorCommand& c, ProgramWords& words) {
    const std::string& word = words.text("a value, or auto");
    c.automatic = word.starts_with('a') || word.starts_with('A');
    if (!c.automatic && (!parse_real(word, c.scale) || !(c.scale > 0)))
        throw UsageError("expected a value for the scale's end, or auto, found \"" + word + '"');
}

FalsecolorCommand parse_falsecolor(const std::vector<std::string>& line) {
    FalsecolorCommand c;
    c.palette = own_palette;
    constexpr int kLargest = 1 << 14;
    ProgramWords words(line);
    while (words.at_option()) {
        const std::string option = words.take();
        if (option == "-i")
            c.input = words.text("a picture");
        else if (option == "-p")
            c.background = words.text("a picture");
        else if (option == "-ip" || option == "-pi")
            c.input = c.background = words.text("a picture");
        else if (option == "-cl")
            c.drawing = Drawing::lines;
        else if (option == "-cb")
            c.drawing = Drawing::bands;
        else if (option == "-cp")
            c.drawing = Drawing::steps;
        else if (option == "-e")
            c.extrema = true;
        else if (option == "-s")
            take_scale(c, words);
        else if (option == "-m")
            c.multiplier = words.real("a factor");
        else if (option == "-log")
            c.decades = words.real("a number of decades");
        else if (option == "-n")
            c.divisions = words.integer("a number of steps", 1, 256);
        else if (option == "-lw")
            c.width = words.integer("a width", 0, kLargest);
        else if (option == "-lh")
            c.height = words.integer("a height", 0, kLargest);
        else if (option == "-d")
            c.digits = words.integer("a number of digits", 0, 9);
        else if (option == "-l")
            c.label = words.text("a label");
        else if (option == "-pal")
            c.palette = palette_option(words);
        else if (option == "-spec")
            c.palette = spectrum;
        else if (option == "-r" || option == "-g" || option == "-b")
            words.refuse("choose a palette, by -pal");
        else
            words.unknown();
    }
    if (!words.at_end()) throw UsageError("unknown argument: use -i for the picture");
    if (!(c.multiplier > 0) || !(c.decades >= 0) || c.decades > 30)
        throw UsageError("expected a positive factor, and 0 to 30 decades");
    return c;
}

/// Where a value lies on the scale, 0 to 1.
double place_of(const FalsecolorCommand& c, double value) {
    const double at = value / c.scale;
    if (c.decades == 0) return std::clamp(at, 0.0, 1.0);
    return std::clamp(at > 0 ? 1 + std::log10(at) / c.decades : 0.0, 0.0, 1.0);
}
double value_at(const FalsecolorCommand& c, double place) {
    return c.decades == 0 ? c.scale * place : c.scale * std::pow(10.0, (place - 1) * c.decades);
}

Rgb colour_at(const FalsecolorCommand& c, double place) {
    const std::array<double, 3> colour = c.palette(place);
    return {static_cast<float>(colour[0]), static_cast<float>(colour[1]),
            static_cast<float>(colour[2])};
}

/// The middle of the step that a place is in.
double step_of(const FalsecolorCommand& c, double place) {
    const double n = c.divisions;
    return (std::min(std::floor(place * n), n - 1) + .5) / n;
}

/// Whether neighbours, to the right and below, are of another step: that is where a line is.
bool has_line(const FalsecolorCommand& c, const std::vector<double>& places, int width, int height,
              int x, int y) {
    const auto step = [&](int column, int row) {
        return step_of(c, places[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                                 static_cast<std::size_t>(column)]);
    };
    const double own = step(x, y);
    return (x + 1 < width && step(x + 1, y) != own) || (y + 1 < height && step(x, y + 1) != own);
}

void draw_values(const FalsecolorCommand& c, const std::vector<double>& places, Picture& picture) {
    constexpr double kBand = .5;  // of a step
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            const std::size_t i =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                static_cast<std::size_t>(x);
            const double place = places[i], step = step_of(c, place);
            bool drawn = true;
            if (c.drawing == Drawing::lines)
                drawn = has_line(c, places, picture.width, picture.height, x, y);
            if (c.drawing == Drawing::bands)
                drawn = std::abs(place - step) * c.divisions < kBand / 2;
            if (drawn)
                picture.pixels[i] = colour_at(c, c.drawing == Drawing::colours ? place : step);
        }
    }
}

std::string shown(double value, int digits) {
    std::array<char, 64> text{};
    const bool short_one = value == 0 || (std::abs(value) >= 1e-3 && std::abs(value) < 1e6);
    std::snprintf(text.data(), text.size(), short_one ? "%.*f" : "%.*g", short_one ? digits : 3,
                  value);
    std::string found = text.data();
    if (found.find('.') != std::string::npos && found.find('e') == std::string::npos) {
        found.erase(found.find_last_not_of('0') + 1);
        if (found.ends_with('.')) found.pop_back();
    }
    return found;
}

/// The numbers of the darkest and the brightest pixel, beside these.
void draw_extrema(const std::vector<double>& values, Picture& picture) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    for (const auto place : {least, most}) {
        const auto at = static_cast<int>(place - values.begin());
        std::array<char, 32> number{};
        std::snprintf(number.data(), number.size(), "%.4g", *place);
        const std::string text = number.data();
        const int wide = kLetterWidth * static_cast<int>(text.size());
        const int x = std::min(at % picture.width, std::max(0, picture.width - wide));
        const int y = std::min(at / picture.width, std::max(0, picture.height - kLetterHeight));
        for (int i = 0; i < 4; ++i)  // on white, whatever is there
            draw_text(picture, x + i % 2 * 2 - 1, y + i / 2 * 2 - 1, text, Rgb::grey(1), 1);
        draw_text(picture, x, y, text, Rgb::grey(0), 1);
    }
}

/// A bar of the steps' colours with what each begins and ends at, below the label; as high as the
/// whole picture, and black beside it.
Picture make_legend(const FalsecolorCommand& c, int height) {
    Picture legend{c.width, height, {}};
    legend.pixels.resize(static_cast<std::size_t>(c.width) * static_cast<std::size_t>(height));
    const int high = std::min(c.height, height), top = height - high;
    const int line = kLetterHeight + 2, bar = std::max(high - line, 0), left = c.width / 5;
    draw_text(legend, 1, top, c.label, Rgb::grey(1), 1);
    for (int y = 0; y < bar; ++y) {
        const double place = 1 - (y + .5) / bar;
        for (int x = 0; x < left; ++x)
            legend.pixels[static_cast<std::size_t>(top + line + y) *
                              static_cast<std::size_t>(c.width) +
                          static_cast<std::size_t>(x)] =
                colour_at(c, c.drawing == Drawing::colours ? place : step_of(c, place));
    }
    const int every = std::max(1, (line * c.divisions + bar - 1) / std::max(bar, 1));
    for (int i = 0; i < c.divisions; i += every) {
        const double place = (i + .5) / c.divisions;
        const int y = top + line + static_cast<int>((1 - place) * bar) - kLetterHeight / 2;
        draw_text(legend, left + 4, y, shown(value_at(c, place), c.digits), Rgb::grey(1), 1);
    }
    return legend;
}

Picture beside(const Picture& left, const Picture& right) {
    Picture both{left.width + right.width, right.height, {}};
    for (int y = 0; y < right.height; ++y)
        for (const Picture* one : {&left, &right}) {
            const auto row = one->pixels.begin() + std::ptrdiff_t{y} * one->width;
            both.pixels.insert(both.pixels.end(), row, row + one->width);
        }
    return both;
}

}  // namespace

int run_falsecolor(const std::string& name, const std::vector<std::string>& words,
                   Communicator* /*ranks*/) {
    FalsecolorCommand c = parse_falsecolor(words);
    PictureHeader header;
    const std::string shown_name = c.input.empty() ? "standard input" : c.input;
    const Picture input =
        read_hdr(c.input.empty() ? read_standard_input() : read_file(c.input), shown_name, &header);
    Picture picture = input;
    if (!c.background.empty()) {
        picture = read_hdr(read_file(c.background), c.background);
        if (picture.width != input.width || picture.height != input.height)
            throw InputError({c.background, 0}, "is not as large as " + shown_name);
    }
    std::vector<double> values, places;
    values.reserve(input.pixels.size());
    places.reserve(input.pixels.size());
    for (const Rgb& pixel : input.pixels)
        values.push_back(c.multiplier * static_cast<double>(brightness(pixel)));
    if (c.automatic) c.scale = std::max(*std::max_element(values.begin(), values.end()), 1e-30);
    for (const double value : values) places.push_back(place_of(c, value));
    draw_values(c, places, picture);
    if (c.extrema) draw_extrema(values, picture);
    if (c.width > 0 && c.height > 0) picture = beside(make_legend(c, picture.height), picture);
    header.lines.push_back(name + (words.empty() ? "" : ' ' + history_line(words)));
    header.xyz = false;
    write_to_stdout(encode_hdr(picture, header));
    return kSuccessStatus;
}

}  // namespace lightwalk
