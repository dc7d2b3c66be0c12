#include "io/picture/denoiser.h"

#include <dlfcn.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "core/error.h"
#include "io/files/module.h"

namespace lightwalk {
namespace {

constexpr const char* kMissing = "option --denoise: Open Image Denoise is not installed: ";
constexpr int kCpu = 1, kFloat3 = 3;  // OIDN_DEVICE_TYPE_CPU, OIDN_FORMAT_FLOAT3

/// Its state is kept until the process ends: it has threads of its own.
void* open_library() {
    for (const char* name : {"libOpenImageDenoise.so.2", "libOpenImageDenoise.so.1",
                             "libOpenImageDenoise.so.0", "libOpenImageDenoise.so"})
        if (void* found = dlopen(name, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE)) return found;
    throw InputError(kMissing + loading_error());
}

}  // namespace

/// Its C interface: "Open Image Denoise API", openimagedenoise.org/documentation.html. Handles are
/// pointers.
struct Denoiser::Library {
    Library() : library(open_library()) {
        find(new_device, "oidnNewDevice");
        find(commit_device, "oidnCommitDevice");
        find(release_device, "oidnReleaseDevice");
        find(device_error, "oidnGetDeviceError");
        find(new_filter, "oidnNewFilter");
        find(set_image, "oidnSetSharedFilterImage");
        find(commit_filter, "oidnCommitFilter");
        find(execute, "oidnExecuteFilter");
        find(release_filter, "oidnReleaseFilter");
        set_flag = reinterpret_cast<SetFlag>(dlsym(library, "oidnSetFilterBool"));
        if (set_flag == nullptr) find(set_flag, "oidnSetFilter1b");  // of version 1
        // Of version 1 on; without it what was begun goes on to its end.
        set_monitor =
            reinterpret_cast<SetMonitor>(dlsym(library, "oidnSetFilterProgressMonitorFunction"));
        device = new_device(kCpu);
        if (device == nullptr) throw InputError(std::string(kMissing) + "it finds no device");
        commit_device(device);
        check();
    }
    ~Library() {
        if (device != nullptr) release_device(device);
    }
    Library(const Library&) = delete;
    Library& operator=(const Library&) = delete;

    template <class Function>
    void find(Function& function, const char* name) const {
        function = reinterpret_cast<Function>(dlsym(library, name));
        if (function == nullptr) throw InputError(kMissing + loading_error());
    }

    void check() const {
        const char* why = nullptr;
        if (device_error(device, &why) != 0)
            throw InputError(std::string("Open Image Denoise: ") +
                             (why != nullptr ? why : "failed"));
    }

    /// False: `goes_on` has said so.
    [[nodiscard]] bool filter(const Rgb* noisy, Rgb* clean, std::size_t width, std::size_t height,
                              const std::function<bool()>& goes_on) const {
        struct Watch {
            const std::function<bool()>& goes_on;
            std::atomic<bool> given_up = false;
        } watch{goes_on};
        const auto monitor = [](void* user, double /*done*/) {
            auto& watched = *static_cast<Watch*>(user);
            if (!watched.goes_on()) watched.given_up = true;
            return !watched.given_up;
        };
        void* made = new_filter(device, "RT");
        if (made == nullptr) {
            check();
            throw InputError("Open Image Denoise: it makes no filter");
        }
        set_image(made, "color", const_cast<Rgb*>(noisy), kFloat3, width, height, 0, 0, 0);
        set_image(made, "output", clean, kFloat3, width, height, 0, 0, 0);
        set_flag(made, "hdr", true);
        if (goes_on && set_monitor != nullptr) set_monitor(made, monitor, &watch);
        commit_filter(made);
        execute(made);
        release_filter(made);
        // To give up is an error to the library, too, which it would tell next time.
        const char* told = nullptr;
        if (watch.given_up)
            (void)device_error(device, &told);
        else
            check();
        return !watch.given_up;
    }

    using SetFlag = void (*)(void* filter, const char* name, bool value);
    using SetMonitor = void (*)(void* filter, bool (*monitor)(void* user, double done), void* user);
    void* library;
    void* device = nullptr;
    void* (*new_device)(int type) = nullptr;
    void (*commit_device)(void* device) = nullptr;
    void (*release_device)(void* device) = nullptr;
    int (*device_error)(void* device, const char** message) = nullptr;
    void* (*new_filter)(void* device, const char* type) = nullptr;
    void (*set_image)(void* filter, const char* name, void* pixels, int format, std::size_t width,
                      std::size_t height, std::size_t offset, std::size_t pixel_stride,
                      std::size_t row_stride) = nullptr;
    SetFlag set_flag = nullptr;
    SetMonitor set_monitor = nullptr;
    void (*commit_filter)(void* filter) = nullptr;
    void (*execute)(void* filter) = nullptr;
    void (*release_filter)(void* filter) = nullptr;
};

Denoiser::Denoiser() : library_(std::make_unique<Library>()) {}
Denoiser::~Denoiser() = default;
Denoiser::Denoiser(Denoiser&&) noexcept = default;
Denoiser& Denoiser::operator=(Denoiser&&) noexcept = default;

void Denoiser::operator()(Picture& picture) {
    (void)(*this)(picture, nullptr);
}

bool Denoiser::operator()(Picture& picture, const std::function<bool()>& goes_on) {
    if (picture.pixels.empty()) return true;
    std::vector<Rgb> clean(picture.pixels.size());
    if (!library_->filter(picture.pixels.data(), clean.data(),
                          static_cast<std::size_t>(picture.width),
                          static_cast<std::size_t>(picture.height), goes_on))
        return false;
    picture.pixels = std::move(clean);
    return true;
}

Denoiser::Errors Denoiser::errors(const Picture& picture, std::span<const Rgb> half,
                                  const DisplayTone& tone) {
    Picture one{picture.width, picture.height, {half.begin(), half.end()}};
    Picture other = picture;
    for (std::size_t i = 0; i < half.size(); ++i) other.pixels[i] = 2 * picture.pixels[i] - half[i];
    const auto of_one = display_pixels(one, tone), of_other = display_pixels(other, tone);
    (*this)(one);
    const auto of_clean = display_pixels(one, tone);
    double noise = 0, apart = 0;
    for (std::size_t i = 0; i < of_one.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            noise += std::pow((of_one[i][k] - of_other[i][k]) / 255.0, 2);
            apart += std::pow((of_clean[i][k] - of_other[i][k]) / 255.0, 2);
        }
    }
    const double count = 3 * std::max(static_cast<double>(of_one.size()), 1.0);
    // A half has half of the squared difference of both, their mean a quarter.
    return {std::sqrt(noise / 4 / count), std::sqrt(std::max(apart - noise / 2, 0.0) / count)};
}

}  // namespace lightwalk
