// The module that holds OpenImageIO: decoding; see io/picture/image_decoder.h.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstddef>
#include <exception>

#include "io/picture/image_decoder.h"

namespace {

/// Of rows that are read together: what is allocated for each part costs more than its pixels where
/// these are few.
constexpr int kValuesTogether = 1 << 18;

/// A file in memory, at whose offsets a reader may look that stand in the file itself: OpenImageIO
/// 2.4 takes any, and reads before and behind the bytes.
class BoundedMemory final : public OIIO::Filesystem::IOMemReader {
  public:
    using IOMemReader::IOMemReader;
    bool seek(int64_t offset) override { return holds(offset) && IOMemReader::seek(offset); }
    std::size_t pread(void* to, std::size_t size, int64_t offset) override {
        return holds(offset) ? IOMemReader::pread(to, size, offset) : 0;
    }

  private:
    [[nodiscard]] bool holds(int64_t offset) const {
        return offset >= 0 && static_cast<std::size_t>(offset) <= size();
    }
};

/// Whether colours are multiplied by alpha, though that was not wanted: OpenImageIO 2.4 does it to
/// WebP.
bool multiplies(std::string_view format, const OIIO::ImageSpec& spec) {
    return format == "webp" && spec.alpha_channel == spec.nchannels - 1 &&
           spec.get_int_attribute("oiio:UnassociatedAlpha") == 0;
}

/// Divides colours by the alpha of their pixels again, but where nothing is left of them.
void divide_by_alpha(std::vector<float>& values, std::size_t channels) {
    for (std::size_t pixel = 0; pixel + channels <= values.size(); pixel += channels) {
        const float alpha = values[pixel + channels - 1];
        if (!(alpha > 0)) continue;
        for (std::size_t c = pixel; c + 1 < pixel + channels; ++c)
            values[c] = std::min(1.0f, values[c] / alpha);
    }
}

void read_rows(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, lightwalk::ImageRows& rows,
               std::string& error) {
    const int channels = std::min(spec.nchannels, rows.most_channels());
    const bool is_float = spec.format.is_floating_point();
    if (spec.depth > 1 || channels < 1) {
        error = "not a flat image";
        return;
    }
    rows.named(spec.channelnames, std::string(spec.get_string_attribute("ImageDescription")));
    if (!rows.begin(spec.width, spec.height, channels, is_float)) return;
    const bool tiled = spec.tile_width > 0;
    const int step = tiled ? spec.tile_height
                           : std::max(1, kValuesTogether / channels / std::max(1, spec.width));
    std::vector<float> values(static_cast<std::size_t>(std::min(step, spec.height)) *
                              static_cast<std::size_t>(spec.width) *
                              static_cast<std::size_t>(channels));
    for (int y = 0; y < spec.height; y += step) {
        const int end = std::min(y + step, spec.height);
        const int x0 = spec.x, y0 = spec.y;
        const bool read =
            tiled ? input.read_tiles(0, 0, x0, x0 + spec.width, y0 + y, y0 + end, spec.z,
                                     spec.z + 1, 0, channels, OIIO::TypeFloat, values.data())
                  : input.read_scanlines(0, 0, y0 + y, y0 + end, spec.z, 0, channels,
                                         OIIO::TypeFloat, values.data());
        if (!read) {
            error = input.geterror();
            if (error.empty()) error = "unknown error";
            return;
        }
        if (multiplies(input.format_name(), spec))
            divide_by_alpha(values, static_cast<std::size_t>(channels));
        rows.take(y, end - y, values.data());
    }
}

}  // namespace

extern "C" void lightwalk_decode_image(std::string_view bytes, const char* format,
                                       lightwalk::ImageRows& rows, std::string& error) {
    try {
        OIIO::attribute("threads", 1);  // they would outlive the image
        OIIO::attribute("exr_threads", -1);
        BoundedMemory memory(bytes.data(), bytes.size());
        const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(format);
        if (!input) {
            error = OIIO::geterror();
            return;
        }
        OIIO::ImageSpec spec, wanted;
        wanted.attribute("oiio:UnassociatedAlpha", 1);  // colours are not multiplied by it
        if (!input->set_ioproxy(&memory) || !input->open(format, spec, wanted)) {
            error = input->geterror();
            if (error.empty()) error = "it cannot be opened";
            return;
        }
        read_rows(*input, spec, rows, error);
    } catch (const std::exception& failed) {
        error = failed.what();
    }
}
