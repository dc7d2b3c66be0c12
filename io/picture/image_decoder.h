#pragma once
// Decodes images that are no Radiance pictures (PNG, JPEG, TIFF, WebP, TGA, BMP) by OpenImageIO,
// which is loaded as a module when first needed; see image_encoder.h.
#include <string>
#include <string_view>
#include <vector>

#include "core/model/resources.h"

namespace lightwalk {

/// Which of an image's values a picture is made of.
enum class ImageChannels {
    color,    ///< red, green and blue, linear: sRGB is undone where samples are integers
    alpha,    ///< how opaque it is, as grey; without such a channel its colour as it is stored
    numbers,  ///< what is stored, from 0 to 1
};

/// Whether these bytes begin as a PNG, JPEG, TIFF, WebP, TGA or BMP file does.
[[nodiscard]] bool is_image(std::string_view bytes);

/// Decode an image to a table whose shorter side has length 1, as decode_picture does. Throws
/// InputError "name: ..." for damaged files, and for more pixels than a file of this size can hold.
/// Source of sRGB: IEC 61966-2-1.
[[nodiscard]] PictureData decode_image(std::string_view bytes, const std::string& name,
                                       ImageChannels channels);

/// Width by height of an image, or of a Radiance picture. Throws InputError.
[[nodiscard]] double image_aspect(std::string_view bytes, const std::string& name);

/// Receives an image from the module.
class ImageRows {
  public:
    virtual ~ImageRows() = default;
    [[nodiscard]] virtual int most_channels() const { return 4; }
    /// Comes first: the names of all channels, and the comment that the file holds.
    virtual void named(const std::vector<std::string>& /*channels*/,
                       const std::string& /*comments*/) {}
    /// @param channels  of each pixel, at least 1; those behind the most are left out
    /// @return  whether the pixels are wanted
    virtual bool begin(int width, int height, int channels, bool is_float) = 0;
    /// Rows from y on, each of width * channels values; integers are divided by the largest.
    virtual void take(int y, int count, const float* values) = 0;
};

/// The type of the module's function; it leaves `error` empty on success.
using DecodeImage = void (*)(std::string_view bytes, const char* format, ImageRows& rows,
                             std::string& error);
inline constexpr const char* kDecodeImageSymbol = "lightwalk_decode_image";

}  // namespace lightwalk
