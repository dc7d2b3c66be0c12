#include <algorithm>
#include <cmath>

#include "io/wavefront/obj_file.h"

namespace lightwalk {
namespace {

/// For each corner of a face: of more tests, as spirals need them, the time would have no bound.
constexpr std::size_t kMostEarTests = 16;

/// Cuts the ears of a polygon in its plane (Meisters, "Polygons have ears", 1975).
class EarCutter {
  public:
    EarCutter(const ObjFile& file, const ObjFile::Face& face) {
        for (const ObjFile::Corner& corner : file.corners_of(face))
            points_.push_back(file.positions[corner.position]);
        for (std::uint32_t i = 0; i < face.count; ++i) ring_.push_back(i);
        for (std::size_t i = 1; i + 1 < points_.size(); ++i)  // Newell's normal
            normal_ += cross(points_[i] - points_[0], points_[i + 1] - points_[0]);
    }

    /// Around the polygon every second corner that is an ear is cut, beginning with `at`.
    std::vector<ObjTriangle> cut(std::size_t at) {
        std::size_t tests = kMostEarTests * ring_.size();
        while (ring_.size() > 3) {
            std::size_t ear = at;  // where there is no ear, the polygon crosses itself
            for (std::size_t i = 0; i < ring_.size() && tests > 0; ++i, --tests) {
                if (!is_ear((at + i) % ring_.size())) continue;
                ear = (at + i) % ring_.size();
                break;
            }
            add(ear);
            ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(ear));
            at = (ear % ring_.size() + 1) % ring_.size();
        }
        add(1);
        return std::move(triangles_);
    }

  private:
    /// Twice the area of a triangle as the polygon's normal sees it; negative for the other way
    /// round.
    [[nodiscard]] double area(const Vec3& a, const Vec3& b, const Vec3& c) const {
        return dot(cross(b - a, c - a), normal_);
    }

    [[nodiscard]] std::uint32_t before(std::size_t at) const {
        return ring_[(at + ring_.size() - 1) % ring_.size()];
    }
    [[nodiscard]] std::uint32_t after(std::size_t at) const {
        return ring_[(at + 1) % ring_.size()];
    }

    [[nodiscard]] bool is_ear(std::size_t at) const {
        const std::array<std::uint32_t, 3> ear = {before(at), ring_[at], after(at)};
        const Vec3 &a = points_[ear[0]], &b = points_[ear[1]], &c = points_[ear[2]];
        if (area(a, b, c) <= 0) return false;
        return std::ranges::none_of(ring_, [&](std::uint32_t other) {
            if (std::ranges::find(ear, other) != ear.end()) return false;
            const Vec3& p = points_[other];
            if (p == a || p == b || p == c) return false;
            return area(a, b, p) >= 0 && area(b, c, p) >= 0 && area(c, a, p) >= 0;
        });
    }

    void add(std::size_t at) {
        const ObjTriangle triangle = {before(at), ring_[at], after(at)};
        const Vec3 &a = points_[triangle[0]], &b = points_[triangle[1]], &c = points_[triangle[2]];
        if (cross(b - a, c - a) == Vec3{}) return;
        triangles_.push_back(triangle);
    }

    std::vector<Vec3> points_;
    Vec3 normal_;
    std::vector<std::uint32_t> ring_;
    std::vector<ObjTriangle> triangles_;
};

}  // namespace

std::vector<ObjTriangle> triangulate(const ObjFile& file, const ObjFile::Face& face,
                                     std::size_t first) {
    return EarCutter(file, face).cut(first);
}

}  // namespace lightwalk
