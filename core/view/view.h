#pragma once
// Views: image position <-> ray for Radiance's six view types. See the manual page rpict(1), "-vt".
#include <cmath>
#include <optional>
#include <string>

#include "core/math/vec3.h"

namespace lightwalk {

struct View {
    /// -vt: v perspective, l parallel, c cylindrical, h hemispherical, a angular, s stereographic
    char type = 'v';
    Vec3 position;               ///< -vp [m]
    Vec3 direction{0, 1, 0};     ///< -vd; its length is the focus distance
    Vec3 up{0, 0, 1};            ///< -vu
    double horizontal = 45;      ///< -vh [degrees], or width [m] for parallel views
    double vertical = 45;        ///< -vv
    double fore = 0;             ///< -vo [m]
    double aft = 0;              ///< -va [m], 0: none
    double shift = 0, lift = 0;  ///< -vs, -vl [picture widths, heights]
    friend bool operator==(const View&, const View&) = default;
};

/// A validated view with its derived axes. Image positions (h, v): h to the right, v up, (0,0)
/// lower left, (1,1) upper right. Fore and aft are distances from the view point to planes (types
/// v, l), cylinders (c) or spheres (h, a, s).
class Camera {
  public:
    /// What is wrong with a view, in Radiance's words ("zero view direction", ...); nothing for a
    /// valid one.
    static std::optional<std::string> problem(const View& view);
    explicit Camera(const View& view);  ///< throws InputError with problem()

    struct ViewRay {
        Vec3 origin;       ///< on the fore clipping surface
        Vec3 direction;    ///< unit
        double limit = 0;  ///< aft clipping distance from origin, 0: none [m]
    };
    /// The ray of an image position; nothing outside the view's domain, where pixels are black.
    [[nodiscard]] std::optional<ViewRay> ray(double h, double v) const;
    /// The ray of an image position of a perspective view (type v), in which every position has
    /// one.
    [[nodiscard]] ViewRay perspective_ray(double h, double v) const;

    /// The image of a point. A point without an image (the view point itself, a point in a
    /// perspective's view plane, the axis of a cylinder, the pole of a stereographic view) has
    /// in_front false, h = v = -1.
    struct ImagePosition {
        double h = 0, v = 0;
        double distance = 0;      ///< along the ray of (h, v), from its origin [m]
        bool in_front = true;     ///< else before the fore surface, or mirrored at the view point
        bool beyond_aft = false;  ///< clipped by the aft surface
        /// Whether the point lies inside the picture, whether or not something hides it.
        [[nodiscard]] bool visible() const {
            return in_front && !beyond_aft && h > 0 && h < 1 && v > 0 && v < 1;
        }
    };
    /// The image position of a point: the inverse of ray().
    [[nodiscard]] ImagePosition locate(const Vec3& point) const;

    [[nodiscard]] const View& view() const { return view_; }
    /// Natural height / width of the image.
    [[nodiscard]] double aspect() const { return height_ / width_; }
    [[nodiscard]] Vec3 forward() const { return forward_; }  ///< unit
    [[nodiscard]] Vec3 right() const { return right_; }      ///< unit
    [[nodiscard]] Vec3 upward() const {
        return upward_;
    }  ///< unit, perpendicular to forward() and right()

  private:
    /// @param q  from the view point to the place at unit distance
    [[nodiscard]] ViewRay ray_through(const Vec3& q) const;

    View view_;
    Vec3 forward_, right_, upward_;
    double width_ = 0, height_ = 0;  ///< of the image at unit distance, on the type's image surface
};

// Fused multiply-adds, and the axes scaled first: this gives the bits that released builds of
// Radiance compute.
inline Camera::ViewRay Camera::perspective_ray(double h, double v) const {
    const Vec3 q = fused_advance(fused_advance(forward_, right_ * width_, h + (view_.shift - 0.5)),
                                 upward_ * height_, v + (view_.lift - 0.5));
    return ray_through(q);
}

inline Camera::ViewRay Camera::ray_through(const Vec3& q) const {
    const double stretch = std::sqrt(fused_dot(q, q));
    return {view_.position + view_.fore * q, q * (1 / stretch),
            view_.aft > kEpsilon ? (view_.aft - view_.fore) * stretch : 0};
}

/// The part [h0, h1] x [v0, v1] of a view, as a view of the same type. Nothing when the part is
/// empty or would need a hemispherical view beyond 180 degrees.
[[nodiscard]] std::optional<View> crop_view(const View& view, double h0, double v0, double h1,
                                            double v1);

/// Size of a picture in pixels.
struct PictureSize {
    int width = 512, height = 512;
    double pixel_aspect = 1;
};
/// The largest size of at most x by y pixels for a picture of aspect `view_aspect` (height / width)
/// with pixels of aspect `pixel_aspect` (height / width). pixel_aspect 0: exactly x by y, and the
/// resulting pixel aspect is returned.
[[nodiscard]] PictureSize fit_picture(int x, int y, double view_aspect, double pixel_aspect);

}  // namespace lightwalk
