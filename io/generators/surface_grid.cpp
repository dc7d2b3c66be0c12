#include "io/generators/surface_grid.h"

#include <cmath>
#include <utility>

namespace lightwalk {
namespace {

/// Solve rows x = right by Gauss-Jordan elimination with row exchanges; false when a pivot
/// vanishes.
bool solve(std::array<std::array<double, 4>, 4>& rows, std::array<Vec3, 4>& right) {
    for (std::size_t k = 0; k < 4; ++k) {
        std::size_t best = k;
        for (std::size_t i = k + 1; i < 4; ++i) {
            if (std::abs(rows[i][k]) > std::abs(rows[best][k])) best = i;
        }
        if (!(std::abs(rows[best][k]) > kEpsilon)) return false;
        std::swap(rows[k], rows[best]);
        std::swap(right[k], right[best]);
        const double pivot = rows[k][k];
        for (double& value : rows[k]) value /= pivot;
        right[k] = {right[k].x / pivot, right[k].y / pivot, right[k].z / pivot};
        for (std::size_t i = 0; i < 4; ++i) {
            if (i == k) continue;
            const double factor = rows[i][k];
            for (std::size_t j = 0; j < 4; ++j) rows[i][j] -= factor * rows[k][j];
            right[i] -= right[k] * factor;
        }
    }
    return true;
}

}  // namespace

SurfaceGrid::SurfaceGrid(std::size_t m, std::size_t n, bool border, PointAt point_at)
    : m_(m), n_(n), border_(border ? 1 : 0) {
    const std::size_t rows = m + 1 + 2 * border_;
    const std::size_t columns = n + 1 + 2 * border_;
    points_.reserve(rows * columns);
    valid_.reserve(rows * columns);
    const auto parameter = [this](std::size_t at, std::size_t count) {
        return (static_cast<double>(at) - static_cast<double>(border_)) /
               static_cast<double>(count);
    };
    for (std::size_t i = 0; i < rows; ++i) {
        for (std::size_t j = 0; j < columns; ++j) {
            const std::optional<Vec3> p = point_at(parameter(i, m), parameter(j, n));
            points_.push_back(p.value_or(Vec3{}));
            valid_.push_back(p ? 1 : 0);
        }
    }
}

Vec3 SurfaceGrid::difference(std::size_t before, std::size_t at, std::size_t after) const {
    const std::size_t from = valid_[before] != 0 ? before : at;
    const std::size_t to = valid_[after] != 0 ? after : at;
    return points_[to] - points_[from];
}

std::vector<Vec3> SurfaceGrid::normals() const {
    std::vector<Vec3> result((m_ + 1) * (n_ + 1));
    for (std::size_t i = 0; i <= m_; ++i) {
        for (std::size_t j = 0; j <= n_; ++j) {
            Vec3& normal = result[i * (n_ + 1) + j];
            if (!valid(i, j)) {
                if (i >= 3) normal = result[(i - 3) * (n_ + 1) + j];
                continue;
            }
            const std::size_t at = index(i + 1, j + 1);
            const Vec3 ds = difference(index(i, j + 1), at, index(i + 2, j + 1));
            const Vec3 dt = difference(index(i + 1, j), at, index(i + 1, j + 2));
            normal = normalize(cross(ds, dt));
        }
    }
    return result;
}

SurfaceCell surface_cell(const SurfaceGrid& grid, std::size_t i, std::size_t j) {
    const SurfaceCell::Corner a{i, j};
    const SurfaceCell::Corner b{i + 1, j};
    const SurfaceCell::Corner c{i, j + 1};
    const SurfaceCell::Corner e{i + 1, j + 1};
    const auto valid = [&grid](const SurfaceCell::Corner& corner) {
        return grid.valid(corner.i, corner.j);
    };
    if (!valid(a) || !valid(e)) return {{a, b, c, e}};
    if (!valid(b) || !valid(c) || j % 2 == 0) return {{b, e, a, c}};
    return {{a, b, c, e}};
}

std::optional<NormalFit> fit_normals(const std::array<Vec3, 4>& points,
                                     const std::array<Vec3, 4>& normals) {
    const Vec3 sum = normals[0] + normals[1] + normals[2] + normals[3];
    NormalFit fit;
    fit.axis = std::abs(sum.x) > std::abs(sum.y) ? 0 : 1;
    if (!(std::abs(sum[fit.axis]) > std::abs(sum.z))) fit.axis = 2;
    std::array<std::array<double, 4>, 4> rows{};
    for (std::size_t k = 0; k < 4; ++k) {
        const double u = points[k][(fit.axis + 1) % 3];
        const double v = points[k][(fit.axis + 2) % 3];
        rows[k] = {u * v, u, v, 1};
    }
    fit.c = normals;
    if (!solve(rows, fit.c)) return std::nullopt;
    return fit;
}

}  // namespace lightwalk
