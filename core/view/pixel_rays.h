#pragma once
// From a pixel to its primary ray: jitter, aperture and motion blur.
#include <algorithm>
#include <cstdint>
#include <optional>

#include "core/math/random.h"
#include "core/view/pixel_options.h"
#include "core/view/pixel_samples.h"
#include "core/view/view.h"

namespace lightwalk {

/// A pixel's primary ray, and the random numbers for tracing it.
struct PixelRay {
    std::optional<Camera::ViewRay> ray;  ///< nothing outside the view's domain
    RandomStream random;
    double h = 0, v = 0;  ///< image position, see Camera::ray
};

/// What the samples of pixels with several of them are for.
enum class SampleUse {
    own,     ///< a pixel is the plain mean of its own: pixel_sample() of core/view
    shared,  ///< neighbouring pixels share them, and weigh them by their filter: shared_sample()
};

/// Generates the primary ray of each pixel: a pure function of the pixel and sample.
class PixelRays {
  public:
    /// @param previous  the view of the frame before, for motion blur; null: none
    /// The cameras must outlive this.
    /// @param step      1, or more: (x, y) stands for a pixel in the middle of step x step of them
    PixelRays(const Camera& camera, const Camera* previous, int width, int height,
              const PixelOptions& options, std::uint64_t seed, int step = 1,
              SampleUse use = SampleUse::own);

    /// Pixel (x, y), y from the bottom, goes through ((x + j1) / width, (y + j2) / height), j
    /// uniform in ½ ± jitter / 2. Source: Radiance manual page rpict(1), -pj, -pd and -pm.
    /// With several samples a pixel their places are those of their use instead, and jitter is not
    /// used. Lens and motion as with one sample. Where pixels share samples these are stratified
    /// together over the whole picture, with all that is drawn for them (RandomStream::of_samples),
    /// and those of pixels beside the picture are asked for, too, as far as their filter reaches.
    /// @param sample  0 ... samples - 1; of pixels' own samples 0 is nearest to the pixel's centre
    [[nodiscard]] PixelRay operator()(int x, int y, int sample = 0) const;

    /// The image position (see Camera::ray) of a pixel's ray, and the random numbers that remain.
    struct Place {
        double h = 0, v = 0;
        RandomStream random;
    };
    [[nodiscard]] Place place(int x, int y, int sample = 0) const;

    [[nodiscard]] int samples() const { return options_.samples; }  ///< rays a pixel

    /// Whether rays start in one point or plane and go through their pixel's place exactly when not
    /// jittered: neither lens nor motion moves them.
    [[nodiscard]] bool pinhole() const;

  private:
    [[nodiscard]] Place shared_place(int x, int y, int sample) const;
    [[nodiscard]] PixelOffset offset(int x, int y, int sample, RandomStream& random) const;
    [[nodiscard]] PixelOffset filter_offset(int x, int y, int sample, RandomStream& random) const;
    [[nodiscard]] Camera::ViewRay blur_motion(const Camera::ViewRay& now, double h, double v,
                                              RandomStream& random) const;
    [[nodiscard]] Camera::ViewRay through_lens(const Camera::ViewRay& ray,
                                               RandomStream& random) const;

    const Camera& camera_;
    const Camera* previous_;
    int width_, height_;
    PixelOptions options_;
    std::uint64_t seed_;
    int step_;
    bool shared_;
};

inline PixelOffset PixelRays::offset(int x, int y, int sample, RandomStream& random) const {
    if (options_.samples > 1) return filter_offset(x, y, sample, random);
    PixelOffset offset;
    if (options_.jitter > 0) {
        offset.x = options_.jitter * (0.5 - random.next());
        offset.y = options_.jitter * (0.5 - random.next());
    }
    return offset;
}

inline PixelRays::Place PixelRays::place(int x, int y, int sample) const {
    if (shared_) return shared_place(x, y, sample);
    x = std::min(x * step_ + step_ / 2, width_ - 1);
    y = std::min(y * step_ + step_ / 2, height_ - 1);
    Place place{
        0, 0,
        RandomStream::of_pixel(seed_, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                               static_cast<std::uint32_t>(sample))};
    const PixelOffset off = offset(x, y, sample, place.random);
    place.h = (x + (0.5 + off.x)) / width_;
    place.v = (y + (0.5 + off.y)) / height_;
    return place;
}

}  // namespace lightwalk
