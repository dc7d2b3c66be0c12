// The cloud without our renderer: a walk through a signed-distance field. Whoever can cast rays
// and tell what they meet can keep points, as the paper suggests.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "parallel/walk/cloud_frames.h"
#include "tests/one_thread.h"

using namespace lightwalk;
using lightwalk::test::one_thread;

namespace {

enum Body : std::uint32_t { kGround = 1, kBall = 2, kPost = 3 };

struct Field {
    double distance = 0;
    Body body = kGround;
};

/// A ball of radius 1 that floats over the ground, and an upright cylinder.
Field field_at(const Vec3& p) {
    const double ground = p.z;
    const double ball = length(p - Vec3{0, 4, 1.5}) - 1;
    const double post = std::hypot(p.x - 1.4, p.y - 2.5) - 0.15;
    if (ball < ground && ball < post) return {ball, kBall};
    return post < ground ? Field{post, kPost} : Field{ground, kGround};
}

/// Lambert's law under a light from the right, and a pattern on the ground.
Rgb shade(const Vec3& p, Body body) {
    constexpr double h = 1e-4;
    const double d = field_at(p).distance;
    const Vec3 n = normalize({field_at(p + Vec3{h, 0, 0}).distance - d,
                              field_at(p + Vec3{0, h, 0}).distance - d,
                              field_at(p + Vec3{0, 0, h}).distance - d});
    const double light = 0.2 + std::max(0.0, dot(n, normalize({0.5, -0.6, 0.7})));
    const double pattern = body == kGround ? 1 + 0.1 * std::sin(p.x) * std::sin(p.y) : 1;
    return Rgb::grey(static_cast<float>(light * pattern));
}

constexpr int kFieldWidth = 96, kFieldHeight = 64;

/// A ray caster of thirty lines.
class FieldCaster final : public PixelCaster {
  public:
    explicit FieldCaster(const Camera& eye) : camera(eye) {}
    const Camera& camera;

    /// @param aside  from the pixel's centre, to the right and up [pixels]
    [[nodiscard]] TracedPixel cast(const PixelPlace& place, double aside = 0) const {
        TracedPixel pixel;
        PixelVisibility& visibility = pixel.visibility;
        const double x = place.x + 0.5 + aside, y = place.y + 0.5 + aside;
        visibility.x = static_cast<float>(x);
        visibility.y = static_cast<float>(y);
        const auto ray = camera.ray(x / kFieldWidth, y / kFieldHeight);
        visibility.ray = true;
        visibility.direction = ray->direction;
        visibility.ahead.seen = true;
        double t = 0;
        for (int i = 0; i < 300; ++i) {
            const Field field = field_at(ray->origin + ray->direction * t);
            if (field.distance < 1e-5 * t) {
                visibility.ahead.surface = field.body;
                break;
            }
            t += field.distance;
            if (t > 100) break;
        }
        if (visibility.ahead.surface == 0) t = kHuge;
        visibility.ahead.position = ray->origin + ray->direction * t;
        visibility.ahead.distance = pixel.distance = static_cast<float>(t);
        pixel.radiance = visibility.ahead.surface == 0
                             ? Rgb::grey(0.5f)
                             : shade(visibility.ahead.position, Body{visibility.ahead.surface});
        return pixel;
    }

    void probe(std::span<const PixelPlace> places, const ProbeOptions&,
               std::span<PixelVisibility> visibility, int) override {
        for (std::size_t i = 0; i < places.size(); ++i) visibility[i] = cast(places[i]).visibility;
    }
    void trace(std::span<const PixelPlace> places, std::span<TracedPixel> pixels, int,
               int) override {
        for (std::size_t i = 0; i < places.size(); ++i) pixels[i] = cast(places[i]);
    }
};

View step(int i, bool turns) {
    View view;
    view.position = {0, turns ? -2 : -2 - 0.05 * i, 1.2};
    const double angle = turns ? 0.01 * i : 0;
    view.direction = {std::sin(angle), std::cos(angle), 0};
    view.horizontal = 60;
    view.vertical = 42;
    return view;
}

}  // namespace

TEST_CASE("cloud: another ray caster's frames are true, turning and walking backwards" *
          one_thread) {
    const auto executor = make_executor(ExecutorKind::serial, 1);
    for (const bool turns : {true, false}) {
        CAPTURE(turns);
        CloudFrames frames(kFieldWidth, kFieldHeight, {});
        for (int i = 0; i < 12; ++i) {
            CAPTURE(i);
            const Camera camera(step(i, turns));
            FieldCaster caster(camera);
            const CloudFrame frame = frames.draw(camera, caster, *executor, StopFlag());
            CHECK(frame.complete);
            int wrong = 0, floor = 0;  // of the frame, and of one moved by half a pixel
            for (int y = 0; y < kFieldHeight; ++y) {
                for (int x = 0; x < kFieldWidth; ++x) {
                    const float is =
                        frame.radiance[static_cast<std::size_t>(y * kFieldWidth + x)].g;
                    const float should = caster.cast({x, y}).radiance.g;
                    const float moved = caster.cast({x, y}, 0.5).radiance.g;
                    wrong += std::abs(is - should) > 0.1f * should;
                    floor += std::abs(moved - should) > 0.1f * should;
                }
            }
            // On the ball's limb, and on the post, light changes by a tenth within a pixel.
            CHECK(wrong <= floor + kFieldWidth * kFieldHeight / 200);
            if (i == 0)
                CHECK(frame.report.reused == 0);
            else
                CHECK(frame.report.reused > frame.report.pixels * 8 / 10);
        }
    }
}
