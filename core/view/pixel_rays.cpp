#include "core/view/pixel_rays.h"

#include <algorithm>
#include <cmath>

namespace lightwalk {
namespace {

/// Length of the vector that a view's ray direction was made from, per unit of direction: positions
/// at the same multiple of it lie in one plane (perspective), cylinder or sphere.
double slant(const Camera& camera, const Vec3& direction) {
    if (camera.view().type == 'v') return 1 / dot(direction, camera.forward());
    if (camera.view().type == 'c') {
        const double up = dot(direction, camera.upward());
        return 1 / std::sqrt(std::max(1 - up * up, kEpsilon * kEpsilon));
    }
    return 1;
}

}  // namespace

PixelRays::PixelRays(const Camera& camera, const Camera* previous, int width, int height,
                     const PixelOptions& options, std::uint64_t seed, int step, SampleUse use)
    : camera_(camera),
      previous_(previous),
      width_(width),
      height_(height),
      options_(options),
      seed_(seed),
      step_(step),
      shared_(use == SampleUse::shared && options.samples > 1) {}

bool PixelRays::pinhole() const {
    return options_.aperture <= kEpsilon && (previous_ == nullptr || options_.motion <= kEpsilon);
}

PixelOffset PixelRays::filter_offset(int x, int y, int sample, RandomStream& random) const {
    return pixel_sample(seed_, x, y, sample, options_.samples, random.next());
}

PixelRays::Place PixelRays::shared_place(int x, int y, int sample) const {
    const int around = reached_pixels(options_.filter);
    const auto beside = [around](int at) { return static_cast<std::uint32_t>(at + around); };
    Place place{
        0, 0,
        RandomStream::of_samples(seed_, beside(x), beside(y), static_cast<std::uint32_t>(sample),
                                 static_cast<std::uint32_t>(options_.samples))};
    const PixelOffset off = shared_sample(sample, options_.samples, place.random.next_pair());
    place.h = (x + (0.5 + off.x)) / width_;
    place.v = (y + (0.5 + off.y)) / height_;
    return place;
}

PixelRay PixelRays::operator()(int x, int y, int sample) const {
    const Place at = place(x, y, sample);
    const double h = at.h, v = at.v;
    PixelRay pixel{camera_.ray(h, v), at.random, h, v};
    if (!pixel.ray) return pixel;
    if (previous_ != nullptr && options_.motion > kEpsilon)
        pixel.ray = blur_motion(*pixel.ray, h, v, pixel.random);
    if (options_.aperture > kEpsilon) pixel.ray = through_lens(*pixel.ray, pixel.random);
    return pixel;
}

Camera::ViewRay PixelRays::blur_motion(const Camera::ViewRay& now, double h, double v,
                                       RandomStream& random) const {
    const double back = options_.motion * (0.5 - random.next());
    const std::optional<Camera::ViewRay> before = previous_->ray(h, v);
    if (!before) return now;
    Camera::ViewRay ray;
    ray.origin = (1 - back) * now.origin + back * before->origin;
    ray.direction = normalize((1 - back) * slant(camera_, now.direction) * now.direction +
                              back * slant(*previous_, before->direction) * before->direction);
    ray.limit = (1 - back) * now.limit + back * before->limit;
    return ray;
}

Camera::ViewRay PixelRays::through_lens(const Camera::ViewRay& ray, RandomStream& random) const {
    const View& view = camera_.view();
    const double focus = length(view.direction);
    const Vec3 forward = camera_.forward();
    const auto [outwards, around] = random.next_pair();
    const double radius = 0.5 * options_.aperture * std::sqrt(outwards);
    const double angle = 2 * kPi * around;
    const bool parallel = view.type == 'l';
    const bool flat = parallel || view.type == 'v';
    const Vec3 centre = parallel ? ray.origin - view.fore * forward : view.position;
    Vec3 lens =
        centre + radius * (std::cos(angle) * camera_.right() + std::sin(angle) * camera_.upward());
    if (!flat) lens += kPi / 4 * options_.aperture * (0.5 - random.next()) * forward;
    const Vec3 target =
        centre + focus * (view.type == 'v' ? slant(camera_, ray.direction) : 1.0) * ray.direction;
    Camera::ViewRay bent{lens, normalize(target - lens), ray.limit};
    if (view.fore > kEpsilon) {
        const double along =
            view.type == 'v' ? view.fore / dot(bent.direction, forward) : view.fore;
        bent.origin += along * bent.direction;
    }
    return bent;
}

}  // namespace lightwalk
