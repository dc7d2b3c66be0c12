#include "core/view/pixel_samples.h"

#include <bit>
#include <cmath>

#include "core/math/elementary.h"
#include "core/math/random.h"
#include "core/math/vec3.h"

namespace lightwalk {
namespace {

constexpr double kGoldenSection = 0.61803398874989484820;  // (sqrt 5 - 1) / 2
constexpr std::uint32_t kTurn = 0x7fffffff;  // number of a random stream that no sample uses

/// Columns of the grid that has `count` cells, at most twice as many rows as columns or the other
/// way round; 1: there is none.
int grid_columns(int count) {
    for (int columns = static_cast<int>(std::sqrt(count)); columns > 1; --columns) {
        if (count % columns == 0 && count / columns <= 2 * columns) return columns;
    }
    return 1;
}

double gaussian(double d) {
    const double x = d * (1 / kPixelFilterRadius);
    return elementary::exp(-x * x);
}

/// k(x) / 6 for B = C = 1/3.
double mitchell(double d) {
    const double x = std::abs(d);
    if (x < 1) return ((7 * x - 12) * x * x + 16.0 / 3) / 6;
    return (((-7.0 / 3 * x + 12) * x - 20) * x + 32.0 / 3) / 6;
}

}  // namespace

double pixel_filter(PixelFilter filter, double d) {
    const double reach = pixel_filter_reach(filter);
    if (!(d > -reach && d < reach)) return 0;
    return filter == PixelFilter::mitchell ? mitchell(d) : gaussian(d);
}

PixelOffset shared_sample(int sample, int count, const SequencePoint& at) {
    const int columns = std::has_single_bit(static_cast<unsigned>(count)) ? 1 : grid_columns(count);
    if (columns == 1) return {at.first - 0.5, at.second - 0.5};
    const int rows = count / columns;
    const int column = sample % columns, row = sample / columns;
    return {(column + at.first) / columns - 0.5, (row + at.second) / rows - 0.5};
}

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
