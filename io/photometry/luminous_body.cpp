#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "io/photometry/ies_file.h"

namespace lightwalk {
namespace {

constexpr double kPointDiameter = 0.001;  ///< [m]
constexpr double kShortestEdge = 0.001;   ///< of a box, but for its height [m]
constexpr double kLeastHeight = 0.0005;   ///< [m]

/// What the signs of width, length and height mean.
struct BodyRule {
    enum class Body {
        point,
        box,
        box_along_width,  ///< whose width is the extent along x
        round_width,      ///< an upright cylinder whose diameter is the width
        round_length,
        round,  ///< a sphere when all sizes are equal, else a box
    };
    std::array<int, 3> signs;
    Body body;
};
using Body = BodyRule::Body;

constexpr std::array<BodyRule, 6> kAlways = {{{{0, 0, 0}, Body::point},
                                              {{1, 1, 0}, Body::box},
                                              {{1, 1, 1}, Body::box},
                                              {{0, 1, 1}, Body::box},
                                              {{1, 0, 1}, Body::box},
                                              {{-1, 0, 0}, Body::round_width}}};
constexpr std::array<BodyRule, 3> kUntil1991 = {{{{-1, 0, 1}, Body::round_width},
                                                 {{-1, 1, 0}, Body::round_width},
                                                 {{-1, 1, 1}, Body::box_along_width}}};
constexpr std::array<BodyRule, 7> kOf1995 = {{{{-1, 0, 1}, Body::round_width},
                                              {{0, 1, -1}, Body::box},
                                              {{1, 0, -1}, Body::box},
                                              {{-1, 1, -1}, Body::box},
                                              {{1, -1, -1}, Body::box},
                                              {{-1, 1, 1}, Body::round_width},
                                              {{1, -1, 1}, Body::round_width}}};
constexpr std::array<BodyRule, 6> kSince2002 = {{{{-1, -1, 0}, Body::round_length},
                                                 {{-1, -1, 1}, Body::round_length},
                                                 {{-1, -1, -1}, Body::round},
                                                 {{-1, 1, -1}, Body::box},
                                                 {{1, -1, -1}, Body::box},
                                                 {{0, -1, -1}, Body::box}}};

std::span<const BodyRule> rules_of(IesEdition edition) {
    if (edition == IesEdition::until_1991) return kUntil1991;
    if (edition == IesEdition::of_1995) return kOf1995;
    return kSince2002;
}

LuminousBody box(double x, double y, double z) {
    return {LuminousBody::Form::box, std::max(x, kShortestEdge), std::max(y, kShortestEdge),
            std::max(z, kLeastHeight)};
}
LuminousBody cylinder(double diameter, double height) {
    return {LuminousBody::Form::cylinder, diameter, diameter, std::max(height, kLeastHeight)};
}
LuminousBody sphere(double diameter) {
    return {LuminousBody::Form::sphere, diameter, diameter, diameter};
}

}  // namespace

std::optional<LuminousBody> luminous_body(IesEdition edition, double width, double length,
                                          double height) {
    const auto sign = [](double v) { return v > 0 ? 1 : v < 0 ? -1 : 0; };
    const std::array<int, 3> signs = {sign(width), sign(length), sign(height)};
    const double w = std::abs(width), l = std::abs(length), h = std::abs(height);
    const auto body_of = [&](std::span<const BodyRule> rules) -> std::optional<LuminousBody> {
        const auto rule =
            std::ranges::find_if(rules, [&](const BodyRule& r) { return r.signs == signs; });
        if (rule == rules.end()) return std::nullopt;
        switch (rule->body) {
            case Body::point:
                return sphere(kPointDiameter);
            case Body::box:
                return box(l, w, h);
            case Body::box_along_width:
                return box(w, l, h);
            case Body::round_width:
                return cylinder(w, h);
            case Body::round_length:
                return cylinder(l, h);
            case Body::round:
                return w == l && l == h ? sphere(w) : box(l, w, h);
        }
        return std::nullopt;
    };
    if (std::optional<LuminousBody> body = body_of(kAlways)) return body;
    return body_of(rules_of(edition));
}

}  // namespace lightwalk
