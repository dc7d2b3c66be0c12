#pragma once
// A parametric surface sampled on a grid of its parameters: points, normals and cells.
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/math/function_ref.h"
#include "core/math/vec3.h"

namespace lightwalk {

/// (m+1) x (n+1) points at the parameters (i/m, j/n); with a border also the points one step
/// outside.
class SurfaceGrid {
  public:
    using PointAt = FunctionRef<std::optional<Vec3>(double s, double t)>;

    /// `point_at` returns nothing where the surface is not valid.
    SurfaceGrid(std::size_t m, std::size_t n, bool border, PointAt point_at);

    [[nodiscard]] std::size_t m() const { return m_; }
    [[nodiscard]] std::size_t n() const { return n_; }
    /// A point of the grid, i from 0 to m and j from 0 to n; (0, 0, 0) where the surface is not
    /// valid.
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

/// The corners of a cell, which is divided into the triangles p0 p1 p2 and p2 p1 p3.
struct SurfaceCell {
    struct Corner {
        std::size_t i = 0, j = 0;
    };
    std::array<Corner, 4> p;
};

/// The cell between (i, j) and (i+1, j+1). It is divided along a diagonal whose points are valid;
/// if both are, diagonals alternate.
[[nodiscard]] SurfaceCell surface_cell(const SurfaceGrid& grid, std::size_t i, std::size_t j);

/// The bilinear interpolation n(u, v) = c1 uv + c2 u + c3 v + c4 of four corners' normals, where u
/// and v are the two coordinates that follow `axis`.
struct NormalFit {
    std::size_t axis = 0;  ///< the dominant axis of the sum of the normals
    std::array<Vec3, 4> c;
};

/// Fit the interpolation to four corners; nothing when they do not determine its coefficients.
[[nodiscard]] std::optional<NormalFit> fit_normals(const std::array<Vec3, 4>& points,
                                                   const std::array<Vec3, 4>& normals);

}  // namespace lightwalk
