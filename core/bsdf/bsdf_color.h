#pragma once
// Colours of BSDF data: CIE XYZ, and the sharpened responses in which the least of many colours is
// found.
#include <array>
#include <cstddef>

#include "core/spectrum/spectrum_color.h"

namespace lightwalk {

using Xyz = std::array<double, 3>;

/// XYZ of luminance 1 from CIE 1976 u', v'. Source: CIE 15, section 8.2.
[[nodiscard]] inline Xyz xyz_of_uv(double u, double v) {
    if (!(v > 1e-6)) return {1, 1, 1};
    return {2.25 * u / v, 1, (3 - 0.75 * u - 5 * v) / v};
}

/// The least of colours in each sharpened response (von Kries' adaptation, as Radiance sharpens
/// it), which is what all of them have in common.
class LeastColor {
  public:
    void add(const Xyz& xyz) {
        for (std::size_t i = 0; i < 3; ++i) {
            const double v = kSharp[i][0] * xyz[0] + kSharp[i][1] * xyz[1] + kSharp[i][2] * xyz[2];
            if (!(v >= least_[i])) least_[i] = v > 0 ? v : 0;
        }
    }
    [[nodiscard]] Xyz xyz() const {
        // Cramer's rule: rows a, b, c of kSharp give the inverse by their cross products.
        const auto cross = [](const Xyz& a, const Xyz& b) {
            return Xyz{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                       a[0] * b[1] - a[1] * b[0]};
        };
        const Xyz bc = cross(kSharp[1], kSharp[2]), ca = cross(kSharp[2], kSharp[0]),
                  ab = cross(kSharp[0], kSharp[1]);
        const double determinant =
            kSharp[0][0] * bc[0] + kSharp[0][1] * bc[1] + kSharp[0][2] * bc[2];
        Xyz xyz{};
        for (std::size_t i = 0; i < 3; ++i)
            xyz[i] = (bc[i] * least_[0] + ca[i] * least_[1] + ab[i] * least_[2]) / determinant;
        return xyz;
    }

  private:
    static constexpr std::array<Xyz, 3> kSharp{
        {{1.2694, -.0988, -.1706}, {-.8364, 1.8006, .0357}, {.0297, -.0315, 1.0018}}};
    std::array<double, 3> least_{1e30, 1e30, 1e30};
};

/// A colour over its brightness; white where that is 0.
[[nodiscard]] inline Rgb tint_of(const Rgb& color) {
    const float y = brightness(color);
    return y > 0 ? color * (1 / y) : Rgb{1, 1, 1};
}

/// a - b, not below 0.
[[nodiscard]] inline Rgb without(const Rgb& a, const Rgb& b) {
    return {std::max(0.0f, a.r - b.r), std::max(0.0f, a.g - b.g), std::max(0.0f, a.b - b.b)};
}

}  // namespace lightwalk
