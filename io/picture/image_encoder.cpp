#include "io/picture/image_encoder.h"

#include <dlfcn.h>

#include <filesystem>

#include "core/error.h"

namespace lightwalk {
namespace {

constexpr const char* kModule = "liblightwalk_openimageio.so";

/// Beside the program, in the installation's lib folder, or where it was built.
EncodeImage load_encoder(std::string& error) {
    std::error_code failed;
    const std::filesystem::path here =
        std::filesystem::read_symlink("/proc/self/exe", failed).parent_path();
    for (const std::filesystem::path& folder : {here, here / ".." / LIGHTWALK_LIBDIR / "lightwalk",
#ifdef LIGHTWALK_MODULE_DIR
                                                std::filesystem::path(LIGHTWALK_MODULE_DIR)
#endif
         }) {
        void* module = dlopen((folder / kModule).c_str(), RTLD_NOW | RTLD_LOCAL);
        if (!module) {
            // NOLINTNEXTLINE(concurrency-mt-unsafe): glibc keeps the text by thread.
            const char* text = dlerror();
            error = text ? text : "unknown error";
            continue;
        }
        // The module stays loaded: OpenImageIO's threads and tables live as long as the process.
        return reinterpret_cast<EncodeImage>(dlsym(module, kEncodeImageSymbol));
    }
    return nullptr;
}

}  // namespace

std::string encode_image(const ImageRequest& request) {
    const std::string failed = std::string("cannot encode ") + request.format + ": ";
    std::string error;
    const EncodeImage encode = load_encoder(error);
    if (!encode) throw InputError(failed + "OpenImageIO's module does not load: " + error);
    std::vector<unsigned char> bytes;
    encode(request, bytes, error = {});
    if (!error.empty()) throw InputError(failed + error);
    return {bytes.begin(), bytes.end()};
}

}  // namespace lightwalk
