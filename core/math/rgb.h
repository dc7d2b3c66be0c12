#pragma once
// Three-channel radiometric values in single precision.
#include <algorithm>
#include <cstddef>

namespace lightwalk {

struct Rgb {
    float r = 0, g = 0, b = 0;

    constexpr Rgb() = default;
    constexpr Rgb(float red, float green, float blue) : r(red), g(green), b(blue) {}
    [[nodiscard]] static constexpr Rgb grey(float v) { return {v, v, v}; }

    constexpr float& operator[](std::size_t i) { return i == 0 ? r : i == 1 ? g : b; }
    constexpr float operator[](std::size_t i) const { return i == 0 ? r : i == 1 ? g : b; }
    constexpr Rgb& operator+=(const Rgb& c) { return *this = {r + c.r, g + c.g, b + c.b}; }
    constexpr Rgb& operator-=(const Rgb& c) { return *this = {r - c.r, g - c.g, b - c.b}; }
    constexpr Rgb& operator*=(const Rgb& c) { return *this = {r * c.r, g * c.g, b * c.b}; }
    constexpr Rgb& operator*=(float s) { return *this = {r * s, g * s, b * s}; }
    friend constexpr bool operator==(const Rgb&, const Rgb&) = default;
};

[[nodiscard]] constexpr Rgb operator+(Rgb a, const Rgb& b) {
    return a += b;
}
[[nodiscard]] constexpr Rgb operator-(Rgb a, const Rgb& b) {
    return a -= b;
}
[[nodiscard]] constexpr Rgb operator*(Rgb a, const Rgb& b) {
    return a *= b;
}
[[nodiscard]] constexpr Rgb operator*(Rgb a, float s) {
    return a *= s;
}
[[nodiscard]] constexpr Rgb operator*(float s, Rgb a) {
    return a *= s;
}

/// Photopic brightness of a colour in Radiance's standard primaries (R .640 .330, G .290 .600, B
/// .150 .060, equal-energy white); times 179 lm/W it is a luminance [cd/m²]. Source: Ward Larson &
/// Shakespeare, "Rendering with Radiance" (1998), ch. 10 (weights follow from the primaries).
[[nodiscard]] constexpr float brightness(const Rgb& c) {
    return 0.26510582f * c.r + 0.67010582f * c.g + 0.06478836f * c.b;
}
[[nodiscard]] constexpr float max_component(const Rgb& c) {
    return std::max(c.r, std::max(c.g, c.b));
}
[[nodiscard]] constexpr float min_component(const Rgb& c) {
    return std::min(c.r, std::min(c.g, c.b));
}
/// Zero in place of what is below it.
[[nodiscard]] constexpr Rgb positive_part(const Rgb& c) {
    return {std::max(c.r, 0.0f), std::max(c.g, 0.0f), std::max(c.b, 0.0f)};
}
[[nodiscard]] constexpr float mean(const Rgb& c) {
    return (c.r + c.g + c.b) * (1.0f / 3.0f);
}

}  // namespace lightwalk
