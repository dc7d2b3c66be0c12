#include "io/picture/image_encoder.h"

#include "core/error.h"
#include "io/files/module.h"

namespace lightwalk {

std::string encode_image(const ImageRequest& request) {
    const std::string failed = std::string("cannot encode ") + request.format + ": ";
    std::string error;
    const auto encode =
        reinterpret_cast<EncodeImage>(load_from_module(kImageModule, kEncodeImageSymbol, error));
    if (!encode) throw InputError(failed + "OpenImageIO's module does not load: " + error);
    std::vector<unsigned char> bytes;
    encode(request, bytes, error = {});
    if (!error.empty()) throw InputError(failed + error);
    return {bytes.begin(), bytes.end()};
}

}  // namespace lightwalk
