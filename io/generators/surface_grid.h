#pragma once
// Points of a parametric surface on a grid of its parameters, their normals, and the cells between
// them.
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/math/function_ref.h"
#include "core/math/vec3.h"

namespace lightwalk {

/// (m+1) x (n+1) points at (i/m, j/n), and with a border the points one step outside, too.
class SurfaceGrid {
  public:
    using PointAt = FunctionRef<std::optional<Vec3>(double s, double t)>;

    /// `point_at` gives nothing where the surface is not valid.
    SurfaceGrid(std::size_t m, std::size_t n, bool border, PointAt point_at);

    [[nodiscard]] std::size_t m() const { return m_; }
    [[nodiscard]] std::size_t n() const { return n_; }
    /// Inside, i from 0 to m and j from 0 to n; (0, 0, 0) where the surface is not valid.
    [[nodiscard]] const Vec3& point(std::size_t i, std::size_t j) const {
        return points_[index(i + border_, j + border_)];
    }
    [[nodiscard]] bool valid(std::size_t i, std::size_t j) const {
        return valid_[index(i + border_, j + border_)] != 0;
    }
    /// Unit normals of all (m+1) x (n+1) points, j fastest, from central differences; one-sided
    /// where a neighbour is not valid. Needs the border. A point that is not valid has the normal
    /// of the point three rows before it, if any: this is what gensurf's smoothing sees.
    [[nodiscard]] std::vector<Vec3> normals() const;

  private:
    [[nodiscard]] std::size_t index(std::size_t i, std::size_t j) const {
        return i * (n_ + 1 + 2 * border_) + j;
    }
    [[nodiscard]] Vec3 difference(std::size_t before, std::size_t at, std::size_t after) const;

    std::size_t m_, n_, border_;
    std::vector<Vec3> points_;
    std::vector<std::uint8_t> valid_;
};

/// One cell's corners: how it is cut into the triangles p0 p1 p2 and p2 p1 p3.
struct SurfaceCell {
    struct Corner {
        std::size_t i = 0, j = 0;
    };
    std::array<Corner, 4> p;
};

/// The cell between (i, j) and (i+1, j+1), cut along a diagonal of valid points, else alternately.
[[nodiscard]] SurfaceCell surface_cell(const SurfaceGrid& grid, std::size_t i, std::size_t j);

/// The interpolation n(u, v) = c1 uv + c2 u + c3 v + c4 of four corners' normals over the plane of
/// the two coordinates that follow `axis`.
struct NormalFit {
    std::size_t axis = 0;  ///< the dominant one of the normals' sum
    std::array<Vec3, 4> c;
};

/// Nothing when the corners do not determine the coefficients.
[[nodiscard]] std::optional<NormalFit> fit_normals(const std::array<Vec3, 4>& points,
                                                   const std::array<Vec3, 4>& normals);

}  // namespace lightwalk
