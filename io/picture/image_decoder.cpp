#include "io/picture/image_decoder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "core/error.h"
#include "io/files/module.h"
#include "io/formats/header.h"
#include "io/picture/image_encoder.h"
#include "io/picture/picture_data.h"
#include "io/picture/resolution_line.h"

namespace lightwalk {
namespace {

/// Deflate makes a byte of up to 1032.
constexpr std::size_t kMostPixelsOfByte = 1024, kLeastMostPixels = std::size_t{1} << 20,
                      kMostPixels = std::size_t{1} << 26;

constexpr std::array<std::pair<std::string_view, const char*>, 4> kMarks{
    {{"\x89PNG\r\n\x1a\n", "png"},
     {"\xff\xd8\xff", "jpeg"},
     {std::string_view("II*\0", 4), "tiff"},
     {std::string_view("MM\0*", 4), "tiff"}}};

/// Numbers of a header, the low byte first.
class HeaderBytes {
  public:
    explicit HeaderBytes(std::string_view bytes) : bytes_(bytes) {}
    [[nodiscard]] std::uint32_t at(std::size_t place, std::size_t size) const {
        std::uint32_t number = 0;
        for (std::size_t i = size; i-- > 0;)
            number = number << 8 | static_cast<unsigned char>(bytes_[place + i]);
        return number;
    }

  private:
    std::string_view bytes_;
};

/// TGA files have no mark at their beginning: whether all numbers are such as occur there. None
/// that have a palette, beyond which OpenImageIO 2.4 reads. Source: "Truevision TGA File Format
/// Specification 2.0" (1991).
bool begins_as_tga(std::string_view bytes) {
    if (bytes.size() < 18) return false;
    const HeaderBytes header(bytes);
    const std::uint32_t has_palette = header.at(1, 1), type = header.at(2, 1),
                        bits = header.at(16, 1);
    const bool is_known = type == 2 || type == 3 || type == 10 || type == 11;
    return has_palette == 0 && is_known && bits % 8 == 0 && bits > 0 && bits <= 32 &&
           header.at(12, 2) > 0 && header.at(14, 2) > 0;
}

/// BMP files of three or four bytes a pixel. Those of run-length encoded pixels OpenImageIO decodes
/// before it says how many there are. Source: "Bitmap Storage", Windows GDI documentation.
bool begins_as_bmp(std::string_view bytes) {
    if (bytes.size() < 34 || !bytes.starts_with("BM")) return false;
    constexpr std::uint32_t kPlain = 0, kBitFields = 3;
    const HeaderBytes header(bytes);
    const std::uint32_t size = header.at(14, 4), bits = header.at(28, 2),
                        compression = header.at(30, 4);
    return size >= 40 && size <= 124 && (bits == 24 || bits == 32) &&
           (compression == kPlain || compression == kBitFields);
}

/// Width times height of a WebP file, which OpenImageIO decodes before it says how large the
/// picture is; nothing for other files, and for animations. Source: "WebP Container Specification",
/// "WebP Lossless Bitstream Specification" (Google), RFC 6386, sec. 9.1.
std::optional<std::size_t> webp_pixels(std::string_view bytes) {
    constexpr std::uint32_t kLowBits = 0x3fff, kAnimated = 2, kLosslessMark = 0x2f;
    if (bytes.size() < 30 || !bytes.starts_with("RIFF") || bytes.substr(8, 4) != "WEBP")
        return std::nullopt;
    const HeaderBytes header(bytes);
    const std::string_view chunk = bytes.substr(12, 4);
    if (chunk == "VP8 ")
        return std::size_t{header.at(26, 2) & kLowBits} * (header.at(28, 2) & kLowBits);
    if (chunk == "VP8L" && header.at(20, 1) == kLosslessMark) {
        const std::uint32_t sizes = header.at(21, 4);
        return std::size_t{(sizes & kLowBits) + 1} * ((sizes >> 14 & kLowBits) + 1);
    }
    if (chunk == "VP8X" && !(header.at(20, 1) & kAnimated))
        return std::size_t{header.at(24, 3) + 1} * (header.at(27, 3) + 1);
    return std::nullopt;
}

/// OpenImageIO's name; null for others.
const char* format_of_bytes(std::string_view bytes) {
    for (const auto& [mark, format] : kMarks) {
        if (bytes.starts_with(mark)) return format;
    }
    if (begins_as_bmp(bytes)) return "bmp";
    if (webp_pixels(bytes)) return "webp";
    return begins_as_tga(bytes) ? "targa" : nullptr;
}

float linear_of_srgb(float v) {
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

/// A sample that is no number is black.
float finite_part(float v) {
    return std::isfinite(v) ? std::max(v, 0.0f) : 0.0f;
}

class TableOfRows final : public ImageRows {
  public:
    TableOfRows(ImageChannels wanted, std::size_t most_pixels)
        : wanted_(wanted), most_pixels_(most_pixels) {}

    bool begin(int width, int height, int channels, bool is_float) override {
        width_ = static_cast<std::size_t>(std::max(width, 0));
        height_ = static_cast<std::size_t>(std::max(height, 0));
        channels_ = static_cast<std::size_t>(channels);
        decoded_ = wanted_ == ImageChannels::color && !is_float;
        if (width_ == 0 || height_ == 0 || width_ > most_pixels_ / height_) return false;
        fits_ = true;
        data_ = empty_picture(width, height, 1);
        values_ = data_.values.zeros(width_ * height_);
        return true;
    }

    void take(int y, int count, const float* values) override {
        for (int row = 0; row < count; ++row) {
            // Rows of tables go upward.
            const std::size_t from_below = height_ - 1 - static_cast<std::size_t>(y + row);
            Rgb* to = &values_[from_below * width_];
            for (std::size_t x = 0; x < width_; ++x, values += channels_) to[x] = pixel(values);
        }
    }

    [[nodiscard]] bool fits() const { return fits_; }
    PictureData release() { return std::move(data_); }

  private:
    [[nodiscard]] Rgb pixel(const float* v) const {
        const bool has_alpha = channels_ == 2 || channels_ == 4;
        if (wanted_ == ImageChannels::alpha && has_alpha)
            return Rgb::grey(finite_part(v[channels_ - 1]));
        const std::size_t green = channels_ >= 3 ? 1 : 0, blue = channels_ >= 3 ? 2 : 0;
        const Rgb stored{finite_part(v[0]), finite_part(v[green]), finite_part(v[blue])};
        if (!decoded_) return stored;
        return {linear_of_srgb(stored.r), linear_of_srgb(stored.g), linear_of_srgb(stored.b)};
    }

    ImageChannels wanted_;
    std::size_t most_pixels_, width_ = 0, height_ = 0, channels_ = 0;
    bool fits_ = false;
    bool decoded_ = false;  ///< from sRGB
    PictureData data_;
    std::span<Rgb> values_;
};

class SizeOfRows final : public ImageRows {
  public:
    bool begin(int width, int height, int /*channels*/, bool /*is_float*/) override {
        if (width > 0 && height > 0) aspect = static_cast<double>(width) / height;
        return false;
    }
    void take(int /*y*/, int /*count*/, const float* /*values*/) override {}
    double aspect = 0;
};

[[noreturn]] void refuse_size(const std::string& name) {
    throw InputError({name, 0}, "an image of no pixels, or of more than a file of this size holds");
}

std::size_t most_pixels(std::string_view bytes) {
    return std::min(kLeastMostPixels + kMostPixelsOfByte * bytes.size(), kMostPixels);
}

void decode_rows(std::string_view bytes, const std::string& name, ImageRows& rows) {
    const char* format = format_of_bytes(bytes);
    if (format == nullptr)
        throw InputError({name, 0},
                         "neither a Radiance picture, nor PNG, JPEG, TIFF, WebP, TGA or BMP");
    if (webp_pixels(bytes).value_or(0) > most_pixels(bytes)) refuse_size(name);
    std::string error;
    const auto decode =
        reinterpret_cast<DecodeImage>(load_from_module(kImageModule, kDecodeImageSymbol, error));
    if (!decode)
        throw InputError({name, 0}, "cannot decode: OpenImageIO's module does not load: " + error);
    decode(bytes, format, rows, error = {});
    if (error.empty()) return;
    throw InputError({name, 0}, std::string("damaged ") + format +
                                    " image: " + error.substr(0, error.find('\n')));
}

}  // namespace

bool is_image(std::string_view bytes) {
    return format_of_bytes(bytes) != nullptr;
}

PictureData decode_image(std::string_view bytes, const std::string& name, ImageChannels channels) {
    TableOfRows table(channels, most_pixels(bytes));
    decode_rows(bytes, name, table);
    if (!table.fits()) refuse_size(name);
    return table.release();
}

double image_aspect(std::string_view bytes, const std::string& name) {
    if (is_image(bytes)) {
        SizeOfRows size;
        decode_rows(bytes, name, size);
        if (!(size.aspect > 0)) throw InputError({name, 0}, "an image of no pixels");
        return size.aspect;
    }
    std::string_view rest = bytes.substr(decode_header(bytes, name).size);
    const PictureResolution size = take_resolution(rest, name);
    return static_cast<double>(size.width) / size.height;
}

}  // namespace lightwalk
