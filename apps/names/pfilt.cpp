// pfilt: pictures in other sizes and exposures.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "apps/command_run.h"
#include "apps/names/named_program.h"
#include "apps/names/program_words.h"
#include "core/math/rgbe.h"
#include "core/model/transform_args.h"
#include "io/picture/resample.h"
#include "io/picture/rgbe_picture.h"
#include "io/picture/scanline.h"

namespace lightwalk {
namespace {

/// A size in pixels, or a part of the picture's.
struct WantedSize {
    double value = 1;
    bool divides = true;  ///< "/2"

    [[nodiscard]] int of(int size) const {
        return static_cast<int>(divides ? size / value + .5 : value);
    }
};

struct PfiltCommand {
    WantedSize x, y;
    std::optional<double> aspect;  ///< -p
    bool correct = false;          ///< -c: do not tell of pixels that are no squares
    double exposure = 1;           ///< factor
    bool automatic = true;         ///< without -1: the mean brightness becomes 0.5
    double radius = 0;             ///< of a Gaussian [new pixels]; 0: a box
    std::string file;              ///< "": standard input
    std::string history;           ///< the command line, but for the file
};

WantedSize size_option(ProgramWords& words) {
    const std::string& word = words.text("a size in pixels, or /N");
    WantedSize size;
    size.divides = word.starts_with('/');
    constexpr double kLargest = 1 << 20;
    if (!parse_real(std::string_view(word).substr(size.divides ? 1 : 0), size.value) ||
        !(size.value > 0) || size.value > kLargest)
        throw UsageError("expected a size in pixels, or /N, found \"" + word + '"');
    return size;
}

double exposure_words(ProgramWords& words) {
    const std::string& word = words.text("an exposure");
    double value = 0;
    const bool stops = word.starts_with('+') || word.starts_with('-');
    if (!parse_real(word, value) || (!stops && !(value > 0)) || std::abs(value) > 1e30)
        throw UsageError("expected a factor, or +N or -N stops, found \"" + word + '"');
    return stops ? std::exp2(value) : value;
}

PfiltCommand parse_pfilt(const std::string& name, const std::vector<std::string>& line) {
    PfiltCommand c;
    ProgramWords words(line);
    while (words.at_option()) {
        const std::string& option = words.take();
        if (option == "-x")
            c.x = size_option(words);
        else if (option == "-y")
            c.y = size_option(words);
        else if (option == "-p")
            c.aspect = words.real("height / width of a pixel");
        else if (option == "-c")
            c.correct = true;
        else if (option == "-e")
            c.exposure *= exposure_words(words);
        else if (option == "-r")
            c.radius = words.real("a radius in pixels");
        else if (option == "-b")
            c.radius = 0;
        else if (option == "-1" || option == "-2")
            c.automatic = option == "-2";
        else if (option == "-m")
            words.refuse("lightwalk render --samples draws without fireflies");
        else if (option == "-t" || option == "-f")
            words.refuse("expected light of one colour");
        else if (option == "-n" || option == "-s" || option == "-h" || option == "-a")
            words.refuse("star patterns are not drawn");
        else
            words.unknown();
    }
    c.history = words.history(name);
    const std::vector<std::string> files = words.rest();
    if (files.size() > 1)
        throw UsageError("expected one picture; a file for the result is not supported: use >");
    if (!files.empty()) c.file = files[0];
    if (!(c.radius >= 0 && c.radius <= 1e3) || (c.aspect && !(*c.aspect > 0)))
        throw UsageError("expected a positive radius and pixel aspect");
    return c;
}

/// Of the pixels that are neither black nor light sources.
double mean_brightness(const Picture& picture) {
    constexpr float kHot = 100;
    double sum = 0;
    std::size_t count = 0;
    for (const Rgb& pixel : picture.pixels) {
        if (!(brightness(pixel) > 0) || brightness(pixel) > kHot) continue;
        sum += static_cast<double>(brightness(pixel));
        ++count;
    }
    return count > 0 ? sum / static_cast<double>(count) : 0;
}

PictureSize new_size(const PfiltCommand& c, const RgbePicture& old, const std::string& name) {
    const double old_aspect = pixel_aspect(old.header, name);
    PictureSize size{c.x.of(old.width), c.y.of(old.height), 1};
    if (c.aspect) {
        const double view_aspect = old_aspect * old.height / old.width;
        size = fit_picture(size.width, size.height, view_aspect, *c.aspect);
    }
    constexpr double kMostPixels = 1 << 28;
    if (size.width < 1 || size.height < 1 ||
        static_cast<double>(size.width) * size.height > kMostPixels)
        throw UsageError("bad picture size");
    size.pixel_aspect = static_cast<double>(old.height) / size.height * size.width / old.width;
    return size;
}

std::string header_text(const PfiltCommand& c, const RgbePicture& old, bool xyz,
                        const PictureSize& size, double exposure) {
    std::string text;
    for (const std::string& line : old.header.lines) text += line + '\n';
    text += std::string("FORMAT=") + (xyz ? "32-bit_rle_xyze" : "32-bit_rle_rgbe") + '\n';
    text += c.history + '\n';
    char line[64];
    if (!c.correct && std::abs(size.pixel_aspect - 1) > .005) {
        std::snprintf(line, sizeof line, "PIXASPECT=%f\n", size.pixel_aspect);
        text += line;
    }
    if (exposure != 1) {
        std::snprintf(line, sizeof line, "EXPOSURE=%.4e\n", exposure);
        text += line;
    }
    std::snprintf(line, sizeof line, "\n-Y %8d +X %8d\n", size.height, size.width);
    return text + line;
}

}  // namespace

int run_pfilt(const std::string& name, const std::vector<std::string>& words,
              Communicator* /*ranks*/) {
    const PfiltCommand command = parse_pfilt(name, words);
    const std::string shown = command.file.empty() ? "standard input" : command.file;
    const RgbePicture old =
        decode_rgbe_picture(command.file.empty() ? read_standard_input() : read_file(command.file),
                            shown, XyzPictures::accept);
    Picture picture{old.width, old.height, {}};
    picture.pixels.reserve(old.pixels.size());
    for (const Rgbe& pixel : old.pixels) picture.pixels.push_back(decode_rgbe(pixel));
    constexpr double kMiddle = .5;
    double exposure = command.exposure;
    if (const double mean = command.automatic ? mean_brightness(picture) : 0; mean > 0)
        exposure *= kMiddle / mean;
    const PictureSize size = new_size(command, old, shown);
    picture = resampled(picture, size.width, size.height, command.radius);
    const bool xyz = old.header.format == "32-bit_rle_xyze";
    std::string bytes = header_text(command, old, xyz, size, exposure);
    std::vector<Rgbe> row(static_cast<std::size_t>(size.width));
    for (std::size_t y = 0; y < static_cast<std::size_t>(size.height); ++y) {
        for (std::size_t x = 0; x < row.size(); ++x)
            row[x] = encode_rgbe(picture.pixels[y * row.size() + x] * static_cast<float>(exposure));
        encode_scanline(row, bytes);
    }
    write_to_stdout(bytes);
    return kSuccessStatus;
}

}  // namespace lightwalk
