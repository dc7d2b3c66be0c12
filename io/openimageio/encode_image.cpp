// The module that holds OpenImageIO; see io/picture/image_encoder.h.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>

#include "io/picture/image_encoder.h"

namespace {

OIIO::ImageSpec describe(const lightwalk::ImageRequest& request) {
    OIIO::ImageSpec spec(request.width, request.height, request.channels,
                         request.is_float ? OIIO::TypeFloat : OIIO::TypeUInt8);
    if (request.channels == 1) {
        spec.channelnames = {"Z"};
        spec.z_channel = 0;
        return spec;
    }
    if (!request.is_float) {
        spec.attribute("oiio:ColorSpace", "sRGB");
        if (std::string(request.format) == "jpeg")
            spec.attribute("CompressionQuality", request.quality);
        return spec;
    }
    constexpr std::array<float, 8> kPrimaries{0.64f, 0.33f, 0.29f,    0.6f,
                                              0.15f, 0.06f, 1 / 3.0f, 1 / 3.0f};
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), kPrimaries.data());
    if (*request.date != '\0')
        spec.attribute("DateTime", std::string(request.date));  // else it writes its own
    spec.attribute("comments", std::string(request.history));
    if (!request.names.empty()) spec.channelnames = request.names;
    return spec;
}

bool write_pixels(OIIO::ImageOutput& output, const OIIO::ImageSpec& spec,
                  const lightwalk::ImageRequest& request) {
    if (!request.row) return output.write_image(spec.format, request.pixels);
    constexpr int kRows = 64;  // OpenEXR compresses some together
    const auto size =
        static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.nchannels);
    std::vector<float> values(size * kRows);
    for (int y = 0; y < spec.height; y += kRows) {
        const int end = std::min(y + kRows, spec.height);
        for (int i = y; i < end; ++i)
            request.row(i, values.data() + size * static_cast<std::size_t>(i - y));
        if (!output.write_scanlines(y, end, 0, OIIO::TypeFloat, values.data())) return false;
    }
    return true;
}

}  // namespace

extern "C" void lightwalk_encode_image(const lightwalk::ImageRequest& request,
                                       std::vector<unsigned char>& bytes, std::string& error) {
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(request.format);
    if (!output) {
        error = OIIO::geterror();
        return;
    }
    // One picture needs no pools of threads, which would outlive it.
    OIIO::attribute("threads", 1);
    OIIO::attribute("exr_threads", -1);
    const OIIO::ImageSpec spec = describe(request);
    const bool written = output->set_ioproxy(&memory) && output->open(request.format, spec) &&
                         write_pixels(*output, spec, request) && output->close();
    if (!written) error = output->geterror();
    if (!written && error.empty()) error = "unknown error";
}
