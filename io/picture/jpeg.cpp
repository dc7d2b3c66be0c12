#include "io/picture/jpeg.h"

#include <turbojpeg.h>

#include <algorithm>
#include <cassert>
#include <string>

#include "core/error.h"

namespace lightwalk {
namespace {

constexpr int kLargestSide = 65535;  // limit of the JPEG format [pixels]

[[noreturn]] void fail(const std::string& why) {
    throw InputError("cannot encode jpeg: " + why);
}

}  // namespace

void JpegCompressor::Release::operator()(void* handle) const noexcept {
    (void)tjDestroy(handle);
}

JpegCompressor::JpegCompressor() : handle_(tjInitCompress()) {
    if (!handle_) fail(tjGetErrorStr2(nullptr));
}
JpegCompressor::~JpegCompressor() = default;
JpegCompressor::JpegCompressor(JpegCompressor&&) noexcept = default;
JpegCompressor& JpegCompressor::operator=(JpegCompressor&&) noexcept = default;

std::span<const std::uint8_t> JpegCompressor::compress(const PixelRows& rows, int quality) {
    const bool full = quality >= kJpegFullColour;
    return encode(rows, quality, TJPF_RGB, full ? TJSAMP_444 : TJSAMP_420);
}

std::span<const std::uint8_t> JpegCompressor::compress_grey(const PixelRows& rows, int quality) {
    return encode(rows, quality, TJPF_GRAY, TJSAMP_GRAY);
}

std::span<const std::uint8_t> JpegCompressor::encode(const PixelRows& rows, int quality,
                                                     int pixel_format, int sampling) {
    assert(quality >= 1 && quality <= 100);
    if (rows.width < 1 || rows.height < 1 || std::max(rows.width, rows.height) > kLargestSide) {
        fail("picture of " + std::to_string(rows.width) + " x " + std::to_string(rows.height) +
             " pixels");
    }
    assert(rows.stride >= static_cast<std::size_t>(tjPixelSize[pixel_format] * rows.width));
    // The fast cosine transform is off by a grey level or two, which shows at high quality alone.
    const bool exact = quality >= kJpegFullColour;
    const int flags = TJFLAG_NOREALLOC | (exact ? TJFLAG_ACCURATEDCT : TJFLAG_FASTDCT);
    const std::size_t most = tjBufSize(rows.width, rows.height, sampling);
    if (bytes_.size() < most) bytes_.resize(most);
    unsigned char* to = bytes_.data();
    unsigned long size = bytes_.size();
    if (tjCompress2(handle_.get(), rows.first, rows.width, static_cast<int>(rows.stride),
                    rows.height, pixel_format, &to, &size, sampling, quality, flags) != 0) {
        fail(tjGetErrorStr2(handle_.get()));
    }
    return std::span(bytes_).first(size);
}

}  // namespace lightwalk
