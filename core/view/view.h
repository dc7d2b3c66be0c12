#pragma once
// Views: image position <-> ray for Radiance's six view types. See the manual page rpict(1), "-vt".
#include <array>
#include <optional>
#include <string>

#include "core/math/vec3.h"

namespace lightwalk {

struct View {
    char type = 'v';            ///< v perspective, l parallel, c cylindrical, h hemispherical, a angular, s stereographic
    Vec3 position;              ///< -vp [m]
    Vec3 direction{0, 1, 0};    ///< -vd; its length is the focus distance
    Vec3 up{0, 0, 1};           ///< -vu
    double horizontal = 45;     ///< -vh [degrees], or width [m] for parallel views
    double vertical = 45;       ///< -vv
    double fore = 0;            ///< -vo [m]
    double aft = 0;             ///< -va [m], 0: none
    double shift = 0, lift = 0; ///< -vs, -vl [picture widths, heights]
    friend bool operator==(const View&, const View&) = default;
};

/// A validated view with its derived axes. Image positions (h, v): h to the right, v up, (0,0) lower left.
class Camera {
  public:
    /// The problem, or nothing: ready to use. Texts follow Radiance ("zero view direction", ...).
    static std::optional<std::string> problem(const View& view);
    explicit Camera(const View& view);  ///< throws InputError with problem()

    struct ViewRay {
        Vec3 origin, direction;  ///< direction is unit
        double limit = 0;        ///< aft clipping distance from origin, 0: none [m]
    };
    /// Nothing outside the view's domain (black pixels).
    [[nodiscard]] std::optional<ViewRay> ray(double h, double v) const;

    struct ImagePosition {
        double h = 0, v = 0, distance = 0;  ///< distance from the fore plane [m]
        bool in_front = true;
    };
    [[nodiscard]] ImagePosition locate(const Vec3& point) const;

    [[nodiscard]] const View& view() const { return view_; }
    [[nodiscard]] double aspect() const;  ///< natural height / width of the image
    [[nodiscard]] Vec3 right() const { return hvec_; }
    [[nodiscard]] Vec3 upward() const { return vvec_; }

  private:
    View view_;
    Vec3 hvec_, vvec_;
    double hn2_ = 0, vn2_ = 0;
};

/// Width and height so that the picture of aspect `view_aspect` (height / width) has pixels of `pixel_aspect`
/// (height / width) inside at most x by y; pixel_aspect 0: exactly x by y (then it is set to what results).
struct PictureSize {
    int width = 512, height = 512;
    double pixel_aspect = 1;
};
[[nodiscard]] PictureSize fit_picture(int x, int y, double view_aspect, double pixel_aspect);

}  // namespace lightwalk
