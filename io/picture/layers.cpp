#include "io/picture/layers.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <utility>

#include "core/error.h"
#include "io/files/atomic_file.h"
#include "io/files/module.h"
#include "io/formats/header.h"
#include "io/options/option_words.h"
#include "io/picture/encode_picture.h"
#include "io/picture/image_decoder.h"
#include "io/picture/image_encoder.h"
#include "io/picture/resolution_line.h"
#include "io/picture/tone.h"

namespace lightwalk {
namespace {

constexpr std::string_view kLayerVariable = "LIGHT_GROUP";
constexpr std::array<const char*, 3> kColors{"R", "G", "B"};
constexpr int kMostChannels = 1024;
/// Deflate makes a byte of up to 1032.
constexpr std::size_t kMostPixelsOfRgbeByte = 64, kMostValuesOfByte = 1024,
                      kLeastMostValues = std::size_t{1} << 24;

bool is_exr_file(std::string_view bytes) {
    return bytes.starts_with("\x76\x2f\x31\x01");
}

/// Walks over the head of an OpenEXR file, whose numbers have the low byte first. Behind the end
/// everything is 0 or empty.
class ExrHeader {
  public:
    explicit ExrHeader(std::string_view bytes) : rest_(bytes) {}
    [[nodiscard]] std::string_view text() {  // up to a zero byte
        const std::string_view taken = take(std::min(rest_.find('\0'), rest_.size()));
        (void)take(1);
        return taken;
    }
    [[nodiscard]] std::int32_t number() {
        const std::string_view four = take(4);
        std::uint32_t value = 0;
        for (std::size_t i = four.size(); i-- > 0;)
            value = value << 8 | static_cast<unsigned char>(four[i]);
        return static_cast<std::int32_t>(value);
    }
    std::string_view take(std::size_t size) {
        const std::string_view taken = rest_.substr(0, size);
        rest_.remove_prefix(taken.size());
        return taken;
    }

  private:
    std::string_view rest_;
};

/// Whether no more memory is needed for a file's buffers than its size justifies, which OpenEXR
/// allocates before it looks at what there is. Files of tiles and of several parts are none of
/// ours. Source: "OpenEXR File Layout", openexr.com.
bool is_sound_exr(std::string_view bytes) {
    constexpr std::uint32_t kScanlines = 2, kLongNames = 0x400;
    constexpr double kMostLinesTogether = 256;
    ExrHeader header(bytes.substr(4));
    const auto version = static_cast<std::uint32_t>(header.number());
    if ((version & ~kLongNames) != kScanlines) return false;
    double width = 0, height = 0, channels = 0;
    while (true) {
        const std::string_view name = header.text();
        if (name.empty()) break;
        const std::string_view type = header.text();
        const std::int32_t size = header.number();
        if (size < 0 || type == "preview") return false;
        const std::string_view value = header.take(static_cast<std::size_t>(size));
        if (value.size() != static_cast<std::size_t>(size)) return false;
        ExrHeader inside(value);
        if (name == "channels") {
            for (; !inside.text().empty(); ++channels) {
                (void)inside.take(8);
                if (inside.number() != 1 || inside.number() != 1) return false;  // subsampled
            }
        } else if (name == "dataWindow" || name == "displayWindow") {
            const double x0 = inside.number(), y0 = inside.number();
            width = std::max(width, inside.number() - x0 + 1);
            height = std::max(height, inside.number() - y0 + 1);
        }
    }
    const double values = width * std::max(height, kMostLinesTogether) * channels;
    if (width < 1 || height < 1 || channels < 1) return false;
    // Each part of so many lines has an offset, a number and a size.
    return height <= kMostLinesTogether / 16 * static_cast<double>(bytes.size()) &&
           values <= static_cast<double>(kLeastMostValues + kMostValuesOfByte * bytes.size());
}

/// Where a value of an OpenEXR file belongs: a colour of a layer.
struct ChannelPlace {
    std::size_t layer = 0, color = 0;
};

std::optional<std::size_t> color_of(std::string_view channel) {
    for (std::size_t k = 0; k < kColors.size(); ++k) {
        if (channel == kColors[k]) return k;
    }
    return std::nullopt;
}

/// The head of an OpenEXR file, or its values as well.
class LayerRows final : public ImageRows {
  public:
    /// @param name_of_whole  of the only layer, where there are none
    explicit LayerRows(std::string name_of_whole, std::size_t bytes)
        : whole_(std::move(name_of_whole)),
          most_values_(kLeastMostValues + kMostValuesOfByte * bytes) {}
    /// From here on values are added.
    void add_to(Picture& sum, std::span<const Rgb> factors) {
        sum_ = &sum;
        factors_ = factors;
    }

    [[nodiscard]] int most_channels() const override { return kMostChannels; }
    void named(const std::vector<std::string>& channels, const std::string& comments) override {
        find_lines(comments);
        const bool layered = std::ranges::any_of(channels, [](const std::string& channel) {
            const std::size_t dot = channel.rfind('.');
            return dot != std::string::npos && color_of(channel.substr(dot + 1));
        });
        for (const std::string& channel : channels) {
            const std::size_t dot = channel.rfind('.');
            const bool of_layer = dot != std::string::npos;
            const std::optional<std::size_t> color =
                color_of(of_layer ? channel.substr(dot + 1) : channel);
            places_.emplace_back();
            if (!color || of_layer != layered) continue;
            const std::string name = of_layer ? channel.substr(0, dot) : whole_;
            const auto known = std::ranges::find(header.names, name);
            const auto layer = static_cast<std::size_t>(known - header.names.begin());
            if (known == header.names.end()) header.names.push_back(name);
            places_.back() = ChannelPlace{layer, *color};
        }
    }
    bool begin(int width, int height, int channels, bool /*is_float*/) override {
        if (width < 1 || height < 1 || static_cast<std::size_t>(channels) != places_.size())
            return false;
        const auto values = static_cast<double>(width) * height * channels;
        if (values > static_cast<double>(most_values_)) return false;
        header.width = width;
        header.height = height;
        return sum_ != nullptr;
    }
    void take(int y, int count, const float* values) override {
        Rgb* to =
            &sum_->pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(header.width)];
        const auto pixels =
            static_cast<std::size_t>(count) * static_cast<std::size_t>(header.width);
        for (std::size_t c = 0; c < places_.size(); ++c) {
            if (!places_[c]) continue;
            const auto [layer, color] = *places_[c];
            const float factor = factors_[layer][color];
            if (factor == 0) continue;
            for (std::size_t i = 0; i < pixels; ++i)
                to[i][color] += factor * values[i * places_.size() + c];
        }
    }

    LayersHeader header;

  private:
    void find_lines(const std::string& comments) {
        for (std::size_t at = 0; at < comments.size();) {
            const std::size_t end = std::min(comments.find('\n', at), comments.size());
            const std::string line = comments.substr(at, end - at);
            if (const auto name = header_variable(line, kLayerVariable))
                whole_ = *name;
            else if (!line.empty())
                header.lines.push_back(line);
            at = end + 1;
        }
    }

    std::string whole_;
    std::size_t most_values_;
    std::vector<std::optional<ChannelPlace>> places_;  ///< of each channel; nothing: none
    Picture* sum_ = nullptr;
    std::span<const Rgb> factors_;
};

std::string stem_of(const std::string& path) {
    return std::filesystem::path(path).stem().string();
}

void decode_exr(std::string_view bytes, const std::string& path, LayerRows& rows) {
    if (!is_sound_exr(bytes))
        throw InputError({path, 0},
                         "damaged OpenEXR file, or one of tiles, parts or a preview, or of "
                         "more pixels than it can hold");
    std::string error;
    const auto decode =
        reinterpret_cast<DecodeImage>(load_from_module(kImageModule, kDecodeImageSymbol, error));
    if (!decode)
        throw InputError({path, 0}, "cannot decode: OpenImageIO's module does not load: " + error);
    decode(bytes, "openexr", rows, error = {});
    if (!error.empty())
        throw InputError({path, 0}, "damaged OpenEXR file: " + error.substr(0, error.find('\n')));
    if (rows.header.width == 0)
        throw InputError({path, 0},
                         "an OpenEXR file of no pixels, or of more than a file of this size holds");
    if (rows.header.names.empty())
        throw InputError({path, 0}, "no layers: expected channels R G B or NAME.R NAME.G NAME.B");
}

LayersHeader read_radiance_header(std::string_view bytes, const std::string& path) {
    const InfoHeader info = decode_header(bytes, path);
    std::string_view rest = bytes.substr(info.size);
    const PictureResolution size = take_resolution(rest, path);
    const double most = static_cast<double>(kLeastMostValues) +
                        static_cast<double>(kMostPixelsOfRgbeByte * bytes.size());
    if (static_cast<double>(size.width) * size.height > most)
        throw InputError({path, 0}, "a picture of more pixels than a file of this size holds");
    LayersHeader header{size.width, size.height, {stem_of(path)}, {}};
    for (const std::string& line : info.lines) {
        if (const auto name = header_variable(line, kLayerVariable))
            header.names.front() = *name;
        else if (!line.starts_with("#?") && !header_variable(line, "EXPOSURE") &&
                 !header_variable(line, "COLORCORR"))
            header.lines.push_back(line);
    }
    return header;
}

std::string encode_layers(const Picture& whole, std::span<const PictureLayer> layers,
                          std::span<const float> error, const PictureHeader& header) {
    std::vector<std::string> channels{"R", "G", "B"};
    std::vector<std::span<const Rgb>> pixels{whole.pixels};
    for (const PictureLayer& layer : layers) {
        for (const char* color : kColors) channels.push_back(layer.name + '.' + color);
        pixels.push_back(layer.pixels);
    }
    if (!error.empty()) channels.emplace_back("error");
    const auto width = static_cast<std::size_t>(whole.width);
    const auto row = [&](int y, float* to) {
        const std::size_t first = static_cast<std::size_t>(y) * width;
        for (std::size_t i = first; i < first + width; ++i) {
            for (const std::span<const Rgb> layer : pixels)
                for (std::size_t k = 0; k < 3; ++k) *to++ = layer[i][k];
            if (!error.empty()) *to++ = error[i];
        }
    };
    return encode_exr(whole.width, whole.height, channels, row, header);
}

}  // namespace

bool has_layer_place(const std::string& pattern) {
    return pattern.find("%s") != std::string::npos;
}

std::string layer_file_name(const std::string& pattern, const std::string& layer) {
    const std::size_t at = pattern.find("%s");
    if (at == std::string::npos) return pattern;
    if (pattern.find("%s", at + 2) != std::string::npos)
        throw UsageError("file name \"" + pattern + "\": more than one %s");
    std::string escaped;
    for (const char c : layer) escaped += c == '%' ? "%%" : std::string(1, c);
    return pattern.substr(0, at) + escaped + pattern.substr(at + 2);
}

void check_layers_name(const std::string& pattern) {
    const std::string name = layer_file_name(pattern, "layer");
    const bool exr = is_exr_picture(name);
    if (exr || (has_layer_place(pattern) && is_radiance_picture(name))) return;
    throw UsageError(
        "option -o: light groups are layers of radiance: expected FILE.exr, or with %s "
        "for the groups' names .hdr .pic or .exr");
}

void write_layers(const std::string& pattern, const Picture& whole,
                  std::span<const PictureLayer> layers, std::span<const float> error,
                  const PictureHeader& header,
                  const std::function<std::string(const std::string&)>& file) {
    assert(error.empty() || error.size() == whole.pixels.size());
    if (!has_layer_place(pattern))
        return write_file_atomically(file(pattern), encode_layers(whole, layers, error, header));
    for (const PictureLayer& layer : layers) {
        PictureHeader own = header;
        own.lines.push_back(std::string(kLayerVariable) + "= " + layer.name);
        const Picture picture{
            whole.width, whole.height, {layer.pixels.begin(), layer.pixels.end()}};
        write_picture(file(layer_file_name(pattern, layer.name)), picture, own, {});
    }
}

LayersHeader read_layers_header(std::string_view bytes, const std::string& path) {
    if (!is_exr_file(bytes)) return read_radiance_header(bytes, path);
    LayerRows rows(stem_of(path), bytes.size());
    decode_exr(bytes, path, rows);
    return rows.header;
}

void add_layers(std::string_view bytes, const std::string& path, std::span<const Rgb> factors,
                Picture& sum) {
    if (is_exr_file(bytes)) {
        LayerRows rows(stem_of(path), bytes.size());
        rows.add_to(sum, factors);
        return decode_exr(bytes, path, rows);
    }
    if (factors.front() == Rgb{}) return;
    const Picture layer = read_hdr(bytes, path);
    assert(layer.pixels.size() == sum.pixels.size());
    for (std::size_t i = 0; i < sum.pixels.size(); ++i)
        sum.pixels[i] += factors.front() * layer.pixels[i];
}

}  // namespace lightwalk
