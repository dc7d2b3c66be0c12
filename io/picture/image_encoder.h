#pragma once
// Images of foreign formats, by OpenImageIO in a module of its own: linking it would load two
// hundred libraries (some 130 MB) into every process, also into those that only write .hdr.
#include <string>
#include <vector>

namespace lightwalk {

/// What to encode. All pointers must outlive the call.
struct ImageRequest {
    const char* format = "png";  ///< OpenImageIO's name: openexr, png, jpeg
    int width = 0, height = 0;
    int channels = 3;              ///< 3: R G B; 1: the depth Z
    bool is_float = false;         ///< samples are float, else 8-bit sRGB
    const void* pixels = nullptr;  ///< row by row from the top
    const char* history = "";      ///< comment lines
    const char* date = "";         ///< CAPDATE, or empty
    int quality = 95;              ///< of jpeg, 1 to 100
};

/// The bytes of the image file. Throws InputError "cannot encode FORMAT: ..." when the format or
/// module is missing.
[[nodiscard]] std::string encode_image(const ImageRequest& request);

/// The module's one function: empty `error` when it worked.
using EncodeImage = void (*)(const ImageRequest& request, std::vector<unsigned char>& bytes,
                             std::string& error);
inline constexpr const char* kEncodeImageSymbol = "lightwalk_encode_image";

}  // namespace lightwalk
