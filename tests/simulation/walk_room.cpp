#include "tests/simulation/walk_room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace lightwalk::simulation {
namespace {

constexpr std::array<double, 3> kLow{-3, -5, 0}, kHigh{3, 5, 3};
constexpr double kScreenY = 1, kScreenLeft = -1.2, kScreenRight = 0.4, kScreenTop = 2;
constexpr std::uint32_t kNeverReused = 1, kGlossy = 5;  ///< walls; 5 is the floor

struct RoomHit {
    double t = kHuge;
    std::uint32_t surface = 0;  ///< 1 ... 6: walls, floor and ceiling; or kScreen
};

RoomHit hit_of(const Vec3& origin, const Vec3& direction) {
    const std::array<double, 3> from{origin.x, origin.y, origin.z},
        along{direction.x, direction.y, direction.z};
    RoomHit hit;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (along[axis] == 0) continue;
        const bool up = along[axis] > 0;
        const double t = ((up ? kHigh[axis] : kLow[axis]) - from[axis]) / along[axis];
        if (t < hit.t) hit = {t, static_cast<std::uint32_t>(1 + 2 * axis + (up ? 1 : 0))};
    }
    const double t = (kScreenY - origin.y) / direction.y;
    const double x = origin.x + t * direction.x, z = origin.z + t * direction.z;
    if (t > 0 && t < hit.t && x > kScreenLeft && x < kScreenRight && z < kScreenTop)
        hit = {t, kScreen};
    return hit;
}

/// 0 ... 1, in stripes.
float pattern_at(const Vec3& place) {
    const double wave = 0.5 + 0.25 * std::sin(3 * place.x + place.y) + 0.2 * std::sin(place.z);
    const bool dark = std::fmod(std::floor(place.x + place.y + place.z), 2) != 0;
    return static_cast<float>(dark ? 0.8 * wave : wave);
}

/// What each group brings.
std::array<Rgb, kRoomGroups> light_of(const WalkRoom& room, std::uint32_t surface,
                                      const Vec3& place) {
    const bool is_screen = (surface & kMaterialBits) == kScreen;
    const float pattern = is_screen ? static_cast<float>(room.screen % 8) / 8 : pattern_at(place);
    const float span = kBrightest - kDarkest, scale = scale_of(room);
    const float one = scale * (kDarkest + span * pattern);
    const float other = scale * (kBrightest - span * pattern * 0.5f);
    return {Rgb{one, scale * kDarkest, one}, Rgb{other, other, scale * kBrightest}};
}

FrameOptions options_of(const RoomCaster::Picture& picture) {
    FrameOptions options;
    options.width = picture.width;
    options.height = picture.height;
    options.pixels.spacing = 1;
    if (picture.use == FrameUse::passing) options.pixels.jitter = 0;
    return options;
}

}  // namespace

float scale_of(const WalkRoom& room) {
    return std::ldexp(1.0f, static_cast<int>(4 * (room.light % 4)));
}

RoomCaster::RoomCaster(const WalkRoom& room, const Picture& picture, int workers, Watch watch)
    : room_(room),
      picture_(picture),
      camera_(picture.view),
      options_(options_of(picture)),
      rays_(rays_of_sample(camera_, options_, 0)),
      watch_(std::move(watch)),
      scratch_(static_cast<std::size_t>(workers)) {}

PixelVisibility RoomCaster::look(const PixelRays& rays, const PixelPlace& place) const {
    const PixelRays::Place at = rays.place(place.x, place.y);
    const Camera::ViewRay ray = camera_.perspective_ray(at.h, at.v);
    const RoomHit hit = hit_of(ray.origin, ray.direction);
    PixelVisibility seen;
    seen.ray = true;
    seen.direction = ray.direction;
    seen.x = static_cast<float>(at.h * options_.width);
    seen.y = static_cast<float>(at.v * options_.height);
    seen.ahead.seen = true;
    seen.ahead.position = ray.origin + hit.t * ray.direction;
    seen.ahead.distance = static_cast<float>(hit.t);
    seen.ahead.surface = (hit.surface * 0x9e3779b9U & ~kMaterialBits) | hit.surface;
    if (hit.surface == kGlossy) {
        seen.ahead.kind = PointKind::glossy;
        seen.ahead.slope = 1.5f;
    }
    if (hit.surface == kNeverReused) seen.ahead.slope = kNeverReuse;
    return seen;
}

void RoomCaster::probe(std::span<const PixelPlace> places, const ProbeOptions& /*options*/,
                       std::span<PixelVisibility> visibility, int /*worker*/) {
    if (watch_.looks) watch_.looks();
    for (std::size_t i = 0; i < places.size(); ++i) visibility[i] = look(rays_, places[i]);
}

void RoomCaster::trace(std::span<const PixelPlace> places, std::span<TracedPixel> pixels,
                       int sample, int worker) {
    if (watch_.traces) watch_.traces(places, sample);
    Scratch& scratch = scratch_[static_cast<std::size_t>(worker)];
    scratch = {};
    traced_ += places.size();
    const PixelRays rays = rays_of_sample(camera_, options_, sample);
    for (std::size_t i = 0; i < places.size(); ++i) {
        TracedPixel& pixel = pixels[i];
        pixel.visibility = look(rays, places[i]);
        const PrimaryVisibility& seen = pixel.visibility.ahead;
        const auto light = light_of(room_, seen.surface, seen.position);
        pixel.radiance = light[0] + light[1];
        pixel.mirrored = {};
        pixel.distance = seen.distance;
        if (picture_.groups) scratch.whole.insert(scratch.whole.end(), light.begin(), light.end());
    }
    scratch.mirrored.resize(scratch.whole.size());
}

PixelGroups RoomCaster::groups(int worker) const {
    const Scratch& scratch = scratch_[static_cast<std::size_t>(worker)];
    return {scratch.whole, scratch.mirrored, picture_.groups ? &picture_.mixture : nullptr};
}

}  // namespace lightwalk::simulation
