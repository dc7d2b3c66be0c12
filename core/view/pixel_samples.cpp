#include "core/view/pixel_samples.h"

#include <cmath>

#include "core/math/random.h"
#include "core/math/vec3.h"

namespace lightwalk {
namespace {

constexpr double kGoldenSection = 0.61803398874989484820;  // (sqrt 5 - 1) / 2
constexpr std::uint32_t kTurn = 0x7fffffff;  // number of a random stream that no sample uses

}  // namespace

PixelOffset pixel_sample(std::uint64_t seed, int x, int y, int sample, int count, double jitter) {
    const double turn = RandomStream::of_pixel(seed, static_cast<std::uint32_t>(x),
                                               static_cast<std::uint32_t>(y), kTurn)
                            .next();
    const double angle = 2 * kPi * (turn + kGoldenSection * sample);
    // The weight beyond radius r is exp(-(r / kPixelFilterRadius)²); solved for r. Written so that
    // the last ring's outermost sample does not round to infinity.
    const double beyond = (count - sample - jitter) / count;
    const double r = kPixelFilterRadius * std::sqrt(-std::log(beyond));
    return {r * std::cos(angle), r * std::sin(angle)};
}

}  // namespace lightwalk
