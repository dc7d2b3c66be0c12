#pragma once
// Removes the noise of pictures that are looked at.
#include <functional>
#include <memory>
#include <span>

#include "io/picture/picture.h"
#include "io/picture/tone.h"

namespace lightwalk {

/// Open Image Denoise (openimagedenoise.org), loaded when it is first needed: libOpenImageDenoise
/// of version 1 or 2, found as the system finds shared libraries (LD_LIBRARY_PATH, ld.so.conf). It
/// guesses what is behind the noise, by a network that has learned from other pictures: for the
/// eye, never for numbers. It expects noise that differs from pixel to pixel: each has samples of
/// its own, which its filter has placed (SampleUse::own of core/view).
class Denoiser {
  public:
    /// Throws InputError: the library is not there, lacks a function, or finds no processor that
    /// it supports.
    Denoiser();
    ~Denoiser();
    Denoiser(Denoiser&&) noexcept;
    Denoiser& operator=(Denoiser&&) noexcept;

    /// Replace the picture's radiance. The result may depend on the processor and the library's
    /// version. Throws InputError with the library's reason.
    void operator()(Picture& picture);
    /// The same, but given up as soon as `goes_on` says so: it is asked now and then, by whichever
    /// thread. False: given up, and the picture is as it was.
    [[nodiscard]] bool operator()(Picture& picture, const std::function<bool()>& goes_on);

    /// Errors of what the screen shows, as shares of its white: roots of mean squares over all
    /// channels.
    struct Errors {
        double noisy = 0;     ///< of the picture
        double denoised = 0;  ///< of half of its samples, denoised: of all of them it is less
    };
    /// Estimated from halves of the samples: what one of them, denoised, differs from the other,
    /// less the other's noise. The idea is that of Rousselle, Knaus & Zwicker, "Adaptive rendering
    /// with non-local means filtering", ACM Transactions on Graphics 31(6), 2012.
    /// @param half  of the samples, which the picture is the mean of; as many pixels
    /// @param tone  with which both are shown
    [[nodiscard]] Errors errors(const Picture& picture, std::span<const Rgb> half,
                                const DisplayTone& tone);

  private:
    struct Library;
    std::unique_ptr<Library> library_;
};

}  // namespace lightwalk
