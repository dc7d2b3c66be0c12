#include "core/function/ray_functions.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/function/library.h"

namespace lightwalk::function {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

double value(const ChannelValues& channels, Channel c) {
    return channels[static_cast<std::size_t>(c)];
}

double positive(double x) {
    return x > 0 ? x : 0;
}

void require(std::span<const double> reals, std::size_t n, int kind, const SourceLocation& where) {
    if (reals.size() >= n) return;
    throw InputError(where, "bad call to source_corr(v," + std::to_string(kind) + "): it needs " +
                                std::to_string(n) + " real arguments, there are " +
                                std::to_string(reals.size()));
}

}  // namespace

double real_argument(std::span<const double> reals, double n, const SourceLocation& where) {
    const int k = rounded_index(n);
    if (k < 1) return static_cast<double>(reals.size());
    if (static_cast<std::size_t>(k) <= reals.size()) return reals[static_cast<std::size_t>(k) - 1];
    throw InputError(where, "bad call to arg(" + std::to_string(k) + "): there are " +
                                std::to_string(reals.size()) + " real arguments");
}

double source_theta(const ChannelValues& channels) {
    const double dz = value(channels, Channel::Dz);
    if (dz >= 1) return 0;
    if (dz <= -1) return 180;
    return kDegrees * std::acos(dz);
}

double source_phi(const ChannelValues& channels, double symmetry, const SourceLocation& where) {
    double phi =
        kDegrees * std::atan2(-value(channels, Channel::Dy), -value(channels, Channel::Dx));
    if (phi < 0) phi += 360;
    switch (rounded_index(symmetry)) {
        case 360:
            return phi;
        case 180:
            return phi < 180 ? phi : 360 - phi;
        case 90:
            if (phi >= 180) phi -= 180;
            return phi < 90 ? phi : 180 - phi;
        default:
            throw InputError(where, "illegal symmetry in source_phi(), expected 90, 180 or 360");
    }
}

double source_corr(const ChannelValues& channels, std::span<const double> reals, double v,
                   double kind, const SourceLocation& where) {
    double a = v;
    if (reals.size() > 1) a *= reals[0];
    if (!(a > 0)) return std::isnan(a) ? a : 0;
    const double dx = value(channels, Channel::Dx), dy = value(channels, Channel::Dy),
                 dz = value(channels, Channel::Dz);
    const int k = rounded_index(kind);
    switch (k) {
        case 0:
            return a;
        case 1:
            return a / value(channels, Channel::Rdot);
        case 2:
            require(reals, 4, k, where);
            return a / (std::abs(dx) * reals[2] * reals[3] + std::abs(dy) * reals[1] * reals[3] +
                        std::abs(dz) * reals[1] * reals[2]);
        case 3: {
            require(reals, 4, k, where);
            const double ts = value(channels, Channel::Ts);
            const double x = std::abs(value(channels, Channel::Px) - dx * ts) - reals[1] / 2;
            const double y = std::abs(value(channels, Channel::Py) - dy * ts) - reals[2] / 2;
            const double z = std::abs(value(channels, Channel::Pz) - dz * ts) - reals[3] / 2;
            return a * ts /
                   (positive(x) * reals[2] * reals[3] + positive(y) * reals[1] * reals[3] +
                    positive(z) * reals[1] * reals[2]);
        }
        case 4: {
            require(reals, 3, k, where);
            const double d = std::min(dz, 1 - 1e-6);
            return a / (reals[1] * reals[2] * std::sqrt(1 - d * d) +
                        std::numbers::pi / 4 * reals[1] * reals[1] * std::abs(d));
        }
        default:
            throw InputError(where, "illegal correction in source_corr(), expected 0 to 4");
    }
}

}  // namespace lightwalk::function
