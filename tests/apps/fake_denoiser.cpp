// Stands for Open Image Denoise in tests, as a library of that name: every pixel becomes the
// picture's mean. With FAKE_DENOISER=fail it fails, as the real one does where memory is short.
#include <cstddef>
#include <cstdlib>
#include <cstring>

namespace {

struct Fake {
    const float* color = nullptr;
    float* output = nullptr;
    std::size_t pixels = 0;
    bool hdr = false, failed = false;
    bool (*monitor)(void* user, double done) = nullptr;
    void* user = nullptr;
};

Fake fake;

}  // namespace

extern "C" {

void* oidnNewDevice(int type) {
    return type == 1 ? &fake : nullptr;
}
void oidnCommitDevice(void*) {}
void oidnReleaseDevice(void*) {}
int oidnGetDeviceError(void*, const char** message) {
    *message = "no memory";
    return fake.failed ? 4 : 0;
}
void* oidnNewFilter(void*, const char* type) {
    return std::strcmp(type, "RT") == 0 ? &fake : nullptr;
}
void oidnSetSharedFilterImage(void*, const char* name, void* pixels, int format, std::size_t width,
                              std::size_t height, std::size_t, std::size_t, std::size_t) {
    if (format != 3) return;
    fake.pixels = width * height;
    if (std::strcmp(name, "color") == 0) fake.color = static_cast<const float*>(pixels);
    if (std::strcmp(name, "output") == 0) fake.output = static_cast<float*>(pixels);
}
void oidnSetFilter1b(void*, const char* name, bool value) {  // that of version 1
    if (std::strcmp(name, "hdr") == 0) fake.hdr = value;
}
void oidnSetFilterProgressMonitorFunction(void*, bool (*monitor)(void* user, double done),
                                          void* user) {
    fake.monitor = monitor;
    fake.user = user;
}
void oidnCommitFilter(void*) {}
void oidnExecuteFilter(void*) {
    fake.failed = !fake.hdr || std::getenv("FAKE_DENOISER") != nullptr;
    if (fake.monitor != nullptr && !fake.monitor(fake.user, 0.5)) fake.failed = true;  // cancelled
    for (std::size_t k = 0; !fake.failed && k < 3; ++k) {
        double sum = 0;
        for (std::size_t i = 0; i < fake.pixels; ++i)
            sum += static_cast<double>(fake.color[3 * i + k]);
        for (std::size_t i = 0; i < fake.pixels; ++i)
            fake.output[3 * i + k] = static_cast<float>(sum / static_cast<double>(fake.pixels));
    }
}
void oidnReleaseFilter(void*) {
    fake.monitor = nullptr;
}

}  // extern "C"
