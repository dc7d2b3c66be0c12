#include "core/view/view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "core/error.h"

namespace lightwalk {
namespace {

constexpr double radians(double degrees) {
    return degrees * (kPi / 180);
}
constexpr double degrees(double radians) {
    return radians * (180 / kPi);
}

/// Upper limits of -vh and -vv [degrees], and whether the limit itself is excluded. See rpict(1),
/// "-vt".
struct SizeLimits {
    double horizontal = HUGE_VAL, vertical = HUGE_VAL;
    bool horizontal_open = true, vertical_open = true;
};

SizeLimits size_limits(char type) {
    switch (type) {
        case 'v':
            return {180, 180, true, true};
        case 'h':
            return {180, 180, false, false};
        case 'c':
            return {360, 180, false, true};
        case 'a':
            return {360, 360, false, false};
        case 's':
            return {360, 360, true, true};
        default:
            return {};
    }
}

bool legal_size(double size, double limit, bool open) {
    if (!(size > kEpsilon)) return false;
    return open ? size < limit - kEpsilon : size <= limit + kEpsilon;
}

bool finite(const Vec3& a) {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

bool finite(const View& view) {
    const std::array<double, 6> numbers{view.horizontal, view.vertical, view.fore,
                                        view.aft,        view.shift,    view.lift};
    return finite(view.position) && finite(view.direction) && finite(view.up) &&
           std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
}

/// Unit vector along `a`, also where the squares of its components would overflow or vanish.
Vec3 unit(const Vec3& a) {
    const double largest = std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
    // Normalised twice, as Radiance sets up views twice: the last bits of view rays decide on which
    // side of a lattice plane a pattern is evaluated.
    if (largest > 1e-100 && largest < 1e100) return normalize(normalize(a));
    return largest > 0 ? normalize({a.x / largest, a.y / largest, a.z / largest}) : Vec3{};
}

/// Extent of the image at unit distance for a horizontal or vertical size of the view; `straight`:
/// projected onto a plane even where the other axis is wound around a cylinder.
double image_extent(char type, double size, bool straight) {
    switch (type) {
        case 'v':
            return 2 * std::tan(radians(size) / 2);
        case 'h':
            return 2 * std::sin(std::min(radians(size), kPi) / 2);
        case 's':
            return 2 * std::tan(radians(size) / 4);
        case 'c':
            return straight ? 2 * std::tan(radians(size) / 2) : radians(size);
        case 'a':
            return radians(size);
        default:
            return size;
    }
}

/// The size that shows `part` of the extent that `size` shows. Nothing when no such size exists.
std::optional<double> cropped_size(char type, double size, double part, bool straight) {
    switch (type) {
        case 'v':
            return degrees(2 * std::atan(part * std::tan(radians(size) / 2)));
        case 'h': {
            const double sine = part * std::sin(radians(size) / 2);
            if (sine > 1) return std::nullopt;
            return degrees(2 * std::asin(sine));
        }
        case 's':
            return degrees(4 * std::atan(part * std::tan(radians(size) / 4)));
        case 'c':
            if (straight) return cropped_size('v', size, part, straight);
            return part * size;
        default:
            return part * size;
    }
}

}  // namespace

std::optional<std::string> Camera::problem(const View& view) {
    if (!finite(view)) return "view parameter is not a finite number";
    if (view.fore < -kEpsilon || view.aft < -kEpsilon ||
        (view.aft > kEpsilon && view.aft <= view.fore)) {
        return "illegal fore/aft clipping plane";
    }
    const Vec3 forward = unit(view.direction), up = unit(view.up);
    if (forward == Vec3{}) return "zero view direction";
    if (up == Vec3{}) return "zero view up vector";
    if (!(length_squared(cross(forward, up)) > 0)) return "view up parallel to view direction";
    const SizeLimits limits = size_limits(view.type);
    if (!legal_size(view.horizontal, limits.horizontal, limits.horizontal_open)) {
        return "illegal horizontal view size";
    }
    if (!legal_size(view.vertical, limits.vertical, limits.vertical_open)) {
        return "illegal vertical view size";
    }
    if (std::string_view("vlchas").find(view.type) == std::string_view::npos) {
        return std::string("unknown view type '") + view.type + "'";
    }
    return std::nullopt;
}

Camera::Camera(const View& view) : view_(view) {
    if (const std::optional<std::string> wrong = problem(view)) throw InputError(*wrong);
    forward_ = unit(view.direction);
    right_ = unit(cross(forward_, unit(view.up)));
    upward_ = cross(right_, forward_);
    width_ = image_extent(view.type, view.horizontal, false);
    height_ = image_extent(view.type, view.vertical, true);
}

std::optional<Camera::ViewRay> Camera::ray(double h, double v) const {
    const double x = (h - 0.5 + view_.shift) * width_;
    const double y = (v - 0.5 + view_.lift) * height_;
    const Vec3 across = x * right_ + y * upward_;
    Vec3 q;
    switch (view_.type) {
        case 'l':
            return ViewRay{view_.position + view_.fore * forward_ + across, forward_,
                           view_.aft > kEpsilon ? view_.aft - view_.fore : 0};
        case 'h': {
            const double z2 = 1 - x * x - y * y;
            if (!(z2 >= 0)) return std::nullopt;
            q = std::sqrt(z2) * forward_ + across;
            break;
        }
        case 'c':
            q = std::cos(x) * forward_ + std::sin(x) * right_ + y * upward_;
            break;
        case 'a': {
            const double angle = std::sqrt(x * x + y * y);
            if (!(angle <= kPi)) return std::nullopt;
            q = std::cos(angle) * forward_ + (angle > 0 ? std::sin(angle) / angle : 1) * across;
            break;
        }
        case 's': {
            const double e = x * x + y * y;
            const double z = (1 - e) / (1 + e);
            q = z * forward_ + (1 + z) * across;
            break;
        }
        default:
            return perspective_ray(h, v);
    }
    return ray_through(q);
}

Camera::ImagePosition Camera::locate(const Vec3& point) const {
    constexpr ImagePosition kNowhere{-1, -1, 0, false, false};
    const Vec3 w = point - view_.position;
    const double ahead = dot(w, forward_), x = dot(w, right_), y = dot(w, upward_);
    const double far = length(w);
    double scale_x = 0, scale_y = 0, distance = 0;  // image coordinates: x * scale_x, y * scale_y
    double depth = 0;                               // what the aft distance limits
    std::optional<double> angle;                    // replaces x * scale_x
    switch (view_.type) {
        case 'v':
            if (!(std::abs(ahead) > kEpsilon)) return kNowhere;
            scale_x = scale_y = 1 / std::abs(ahead);
            distance = std::copysign(far, ahead) * (1 - view_.fore / ahead);
            depth = ahead;
            break;
        case 'l':
            scale_x = scale_y = 1;
            distance = ahead - view_.fore;
            depth = ahead;
            break;
        case 'c': {
            const double radius = std::sqrt(ahead * ahead + x * x);
            if (!(radius > kEpsilon)) return kNowhere;
            angle = std::atan2(x, ahead);
            scale_y = 1 / radius;
            distance = far * (1 - view_.fore / radius);
            depth = radius;
            break;
        }
        default: {
            if (!(far > 0)) return kNowhere;
            const double sideways = std::sqrt(x * x + y * y);
            if (view_.type == 'a') {
                const double psi = std::atan2(sideways, ahead);
                if (sideways > 0)
                    scale_x = scale_y = psi / sideways;
                else
                    angle = psi;
            } else if (view_.type == 's') {
                if (!(ahead / far > kEpsilon - 1)) return kNowhere;
                scale_x = scale_y = 1 / (far + ahead);
            } else {
                scale_x = scale_y = 1 / far;
            }
            depth = view_.type == 'h' ? std::copysign(far, ahead) : far;
            distance = depth - view_.fore;
        }
    }
    ImagePosition at;
    at.h = angle.value_or(x * scale_x) / width_ + 0.5 - view_.shift;
    at.v = y * scale_y / height_ + 0.5 - view_.lift;
    at.distance = distance;
    at.in_front = distance > 0;
    at.beyond_aft = view_.aft > kEpsilon && depth >= view_.aft;
    return at;
}

std::optional<View> crop_view(const View& view, double h0, double v0, double h1, double v1) {
    const double wide = h1 - h0, high = v1 - v0;
    if (!(wide > 0 && high > 0)) return std::nullopt;
    const std::optional<double> horizontal = cropped_size(view.type, view.horizontal, wide, false);
    const std::optional<double> vertical = cropped_size(view.type, view.vertical, high, true);
    if (!horizontal || !vertical) return std::nullopt;
    View part = view;
    part.horizontal = *horizontal;
    part.vertical = *vertical;
    part.shift = ((h0 + h1) / 2 - 0.5 + view.shift) / wide;
    part.lift = ((v0 + v1) / 2 - 0.5 + view.lift) / high;
    return part;
}

PictureSize fit_picture(int x, int y, double view_aspect, double pixel_aspect) {
    PictureSize size{std::max(x, 0), std::max(y, 0), pixel_aspect};
    if (size.width == 0 || size.height == 0) return size;
    if (!(pixel_aspect > kEpsilon)) {
        size.pixel_aspect = view_aspect * x / y;
    } else if (view_aspect * x > pixel_aspect * y) {
        size.width = static_cast<int>(std::floor(y / view_aspect * pixel_aspect + 0.5));
    } else {
        size.height = static_cast<int>(std::floor(x * view_aspect / pixel_aspect + 0.5));
    }
    return size;
}

}  // namespace lightwalk
