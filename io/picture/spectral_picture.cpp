#include "io/picture/spectral_picture.h"

#include <array>
#include <cmath>
#include <cstdint>

#include "core/model/transform_args.h"
#include "io/formats/header.h"
#include "io/formats/words.h"
#include "io/picture/resolution_line.h"
#include "io/picture/rgbe_picture.h"

namespace lightwalk {
namespace {

constexpr long kMostBands = 1000;
constexpr std::size_t kShortestRuns = 8, kLongestRuns = 32767;  ///< scanlines with run lengths
constexpr std::uint64_t kValuesAlwaysAllowed = 1 << 24, kValuesPerByte = 64;

/// What the header says of the bands.
struct SpectralHeader {
    InfoHeader header;
    std::size_t bands = 0;
    std::array<double, 4> splits{};
};

SpectralHeader read_spectral_header(std::string_view bytes, const std::string& name) {
    SpectralHeader read{decode_header(bytes, name), 0, {}};
    if (read.header.format != "Radiance_spectra")
        throw bad_picture(name, "format \"" + read.header.format + "\", expected Radiance_spectra");
    for (const std::string& line : read.header.lines) {
        if (std::optional<std::string_view> value = header_variable(line, "NCOMP")) {
            long count = 0;
            if (!parse_integer(take_word(*value), count) || count < 3 || count > kMostBands)
                throw bad_picture(name, "bad NCOMP, expected 3 to 1000");
            read.bands = static_cast<std::size_t>(count);
        }
        if (std::optional<std::string_view> value = header_variable(line, "WAVELENGTH_SPLITS")) {
            for (double& split : read.splits) {
                if (!parse_real(take_word(*value), split) || !std::isfinite(split))
                    throw bad_picture(name, "bad WAVELENGTH_SPLITS, expected four wavelengths");
            }
        }
    }
    if (read.bands == 0) throw bad_picture(name, "no NCOMP");
    if (read.splits[0] == read.splits[3]) throw bad_picture(name, "no WAVELENGTH_SPLITS");
    return read;
}

/// Reads the components of scanlines: mantissas, then an exponent, for each pixel.
class SpectralScanlines {
  public:
    SpectralScanlines(std::string_view bytes, std::size_t components, const std::string& name)
        : bytes_(bytes), components_(components), name_(name) {}

    /// @param line  [pixel * components + component]
    void read(std::vector<std::uint8_t>& line) {
        const std::size_t length = line.size() / components_;
        const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(bytes_[i]); };
        const bool runs = length >= kShortestRuns && length <= kLongestRuns && bytes_.size() >= 4 &&
                          byte(0) == 2 && byte(1) == 2 && byte(2) * 256U + byte(3) == length;
        if (!runs) {
            for (std::uint8_t& value : line) value = take();
            return;
        }
        bytes_.remove_prefix(4);
        for (std::size_t c = 0; c < components_; ++c) {
            for (std::size_t at = 0; at < length;) {
                const std::size_t code = take(), count = code > 128 ? code - 128 : code;
                if (count == 0 || count > length - at)
                    throw bad_picture(name_, "a run is longer than its scanline");
                const std::uint8_t run = code > 128 ? take() : std::uint8_t{0};
                for (const std::size_t end = at + count; at < end; ++at)
                    line[at * components_ + c] = code > 128 ? run : take();
            }
        }
    }

  private:
    std::uint8_t take() {
        if (bytes_.empty()) throw bad_picture(name_, "the data end within a scanline");
        const auto value = static_cast<std::uint8_t>(bytes_.front());
        bytes_.remove_prefix(1);
        return value;
    }

    std::string_view bytes_;
    std::size_t components_;
    const std::string& name_;
};

/// The stored pixels as values, in their stored order.
std::vector<float> read_values(std::string_view bytes, const PictureResolution& resolution,
                               std::size_t bands, const std::string& name) {
    const auto lines = static_cast<std::size_t>(resolution.scanlines()),
               length = static_cast<std::size_t>(resolution.length());
    if (lines > bytes.size() ||
        length * bands > (kValuesAlwaysAllowed + kValuesPerByte * bytes.size()) / lines)
        throw bad_picture(name, "too many pixels for a file of its size");
    SpectralScanlines scanlines(bytes, bands + 1, name);
    std::vector<float> values;
    std::vector<std::uint8_t> line(length * (bands + 1));
    for (std::size_t j = 0; j < lines; ++j) {
        scanlines.read(line);
        for (std::size_t i = 0; i < length; ++i) {
            const std::uint8_t* pixel = &line[i * (bands + 1)];
            const double scale = pixel[bands] ? std::ldexp(1.0, pixel[bands] - 136) : 0;
            for (std::size_t b = 0; b < bands; ++b)
                values.push_back(static_cast<float>((pixel[b] + 0.5) * scale));
        }
    }
    return values;
}

}  // namespace

SpectralPicture decode_spectral_picture(std::string_view bytes, const std::string& name) {
    const SpectralHeader read = read_spectral_header(bytes, name);
    bytes.remove_prefix(read.header.size);
    const PictureResolution resolution = take_resolution(bytes, name);
    const std::vector<float> stored = read_values(bytes, resolution, read.bands, name);
    const double width = resolution.width,
                 height = resolution.height * pixel_aspect(read.header, name);
    SpectralPicture picture;
    picture.axes[0].extent = static_cast<float>(width <= height ? height / width : 1);
    picture.axes[0].count = static_cast<std::uint32_t>(resolution.height);
    picture.axes[1].extent = static_cast<float>(width <= height ? 1 : width / height);
    picture.axes[1].count = static_cast<std::uint32_t>(resolution.width);
    picture.first_edge = read.splits[0];
    picture.last_edge = read.splits[3];
    picture.bands = read.bands;
    const std::size_t rows = picture.axes[0].count, columns = picture.axes[1].count;
    for (std::size_t row = rows; row-- > 0;) {
        for (std::size_t column = 0; column < columns; ++column) {
            const auto from =
                stored.begin() +
                static_cast<std::ptrdiff_t>(resolution.stored_index(row, column) * read.bands);
            picture.values.insert(picture.values.end(), from,
                                  from + static_cast<std::ptrdiff_t>(read.bands));
        }
    }
    return picture;
}

}  // namespace lightwalk
