#pragma once
// Encodes images by OpenImageIO, which is loaded as a module when first needed: linked, it would
// load two hundred libraries (some 130 MB) into every process, also those that only write .hdr.
#include <functional>
#include <string>
#include <vector>

namespace lightwalk {

/// An image to encode. All pointers must outlive the call.
struct ImageRequest {
    const char* format = "png";  ///< OpenImageIO's name: openexr, png, jpeg
    int width = 0, height = 0;
    int channels = 3;                     ///< 3 for R G B, 1 for the depth Z
    bool is_float = false;                ///< true: samples are float; false: 8-bit sRGB
    const void* pixels = nullptr;         ///< row by row from the top
    const char* history = "";             ///< comment lines
    const char* date = "";                ///< value of CAPDATE, or empty
    int quality = 95;                     ///< quality of jpeg, 1 to 100
    std::vector<std::string> names = {};  ///< of the channels, where there are others
    /// In place of `pixels`: fills row y, from the top.
    std::function<void(int y, float* values)> row = nullptr;
};

/// The bytes of the image file. Throws InputError "cannot encode FORMAT: ..." when the format or
/// module is missing.
[[nodiscard]] std::string encode_image(const ImageRequest& request);

/// The type of the module's one function; it leaves `error` empty on success.
using EncodeImage = void (*)(const ImageRequest& request, std::vector<unsigned char>& bytes,
                             std::string& error);
/// The file of the module.
inline constexpr const char* kImageModule = "liblightwalk_openimageio.so";
inline constexpr const char* kEncodeImageSymbol = "lightwalk_encode_image";

}  // namespace lightwalk
