#include "io/generators/rounded_box.h"

#include <cmath>

namespace lightwalk {
namespace {

/// Adds pieces in the outward sense, turning them where the box is seen from inside.
class Builder {
  public:
    explicit Builder(const RoundedBox& box) : box_(box) {}

    /// Vertices counterclockwise as seen from outside; `normals` are the outward ones.
    void add(std::span<const Vec3> corners, std::span<const Vec3> normals) {
        PolygonMesh::Face face;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            face.vertex[face.corners++] = static_cast<std::uint32_t>(mesh_.positions.size());
            // Inward: the reflection in the box's centre, which turns the sense of every face. The
            // outward normal there is -n, the inward one n.
            mesh_.positions.push_back(box_.inward ? box_.size - corners[i] : corners[i]);
            if (box_.smooth) mesh_.normals.push_back(normals[i]);
        }
        mesh_.faces.push_back(face);
    }

    void add_faces();
    void add_edges(const std::vector<double>& sines);
    void add_corners(int levels);
    [[nodiscard]] PolygonMesh release() { return std::move(mesh_); }

  private:
    /// Centre of the rounding at the corner whose sides are given by `high`.
    [[nodiscard]] Vec3 center(const std::array<bool, 3>& high) const {
        Vec3 p;
        for (std::size_t i = 0; i < 3; ++i) {
            p[i] = high[i] ? box_.size[i] - box_.radius : box_.radius;
        }
        return p;
    }
    void add_strip(const std::array<Vec3, 2>& low, const std::array<Vec3, 2>& high,
                   const std::array<Vec3, 2>& n);
    void split(const Vec3& middle, const std::array<Vec3, 3>& n, int levels);

    const RoundedBox& box_;
    PolygonMesh mesh_;
};

void Builder::add_faces() {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t u = (axis + 1) % 3;
        const std::size_t v = (axis + 2) % 3;
        for (const bool high : {false, true}) {
            std::array<Vec3, 4> corners;
            Vec3 n;
            n[axis] = high ? 1 : -1;
            for (std::size_t i = 0; i < 4; ++i) {
                std::array<bool, 3> side{};
                side[axis] = high;
                side[u] = i == 1 || i == 2;
                side[v] = i >= 2;
                corners[high ? i : 3 - i] = center(side) + n * box_.radius;
            }
            add(corners, std::array{n, n, n, n});
        }
    }
}

/// A quadrilateral between the lines low[0] high[0] and low[1] high[1], whose outward normals are
/// n.
void Builder::add_strip(const std::array<Vec3, 2>& low, const std::array<Vec3, 2>& high,
                        const std::array<Vec3, 2>& n) {
    std::array<Vec3, 4> p = {low[0], high[0], high[1], low[1]};
    std::array<Vec3, 4> normal = {n[0], n[0], n[1], n[1]};
    if (dot(cross(p[1] - p[0], p[3] - p[0]), n[0] + n[1]) < 0) {
        std::swap(p[1], p[3]);
        std::swap(normal[1], normal[3]);
    }
    if (!box_.smooth) return add(p, normal);
    add(std::array{p[0], p[1], p[2]}, std::array{normal[0], normal[1], normal[2]});
    add(std::array{p[2], p[3], p[0]}, std::array{normal[2], normal[3], normal[0]});
}

void Builder::add_edges(const std::vector<double>& sines) {
    const std::size_t last = sines.size() - 1;
    for (std::size_t edge = 0; edge < 12; ++edge) {
        const std::size_t axis = edge / 4;
        const std::size_t u = (axis + 1) % 3;
        const std::size_t v = (axis + 2) % 3;
        std::array<bool, 3> side{};
        side[u] = (edge & 1U) != 0;
        side[v] = (edge & 2U) != 0;
        const Vec3 low = center(side);
        side[axis] = true;
        const Vec3 high = center(side);
        const auto normal = [&](std::size_t j) {
            Vec3 n;
            n[u] = side[u] ? sines[last - j] : -sines[last - j];
            n[v] = side[v] ? sines[j] : -sines[j];
            return n;
        };
        for (std::size_t j = 0; j < last; ++j) {
            const std::array n = {normal(j), normal(j + 1)};
            add_strip({low + n[0] * box_.radius, low + n[1] * box_.radius},
                      {high + n[0] * box_.radius, high + n[1] * box_.radius}, n);
        }
    }
}

void Builder::split(const Vec3& middle, const std::array<Vec3, 3>& n, int levels) {
    if (levels == 0) {
        const double r = box_.radius;
        return add(std::array{middle + n[0] * r, middle + n[1] * r, middle + n[2] * r}, n);
    }
    const Vec3 a = normalize(n[0] + n[1]);
    const Vec3 b = normalize(n[1] + n[2]);
    const Vec3 c = normalize(n[2] + n[0]);
    split(middle, {n[0], a, c}, levels - 1);
    split(middle, {a, n[1], b}, levels - 1);
    split(middle, {c, b, n[2]}, levels - 1);
    split(middle, {a, b, c}, levels - 1);
}

void Builder::add_corners(int levels) {
    for (unsigned code = 0; code < 8; ++code) {
        std::array<bool, 3> side{};
        std::array<Vec3, 3> n;
        bool mirrored = true;
        for (unsigned i = 0; i < 3; ++i) {
            side[i] = (code >> i & 1U) != 0;
            n[i][i] = side[i] ? 1 : -1;
            mirrored ^= side[i];
        }
        if (mirrored) std::swap(n[1], n[2]);
        split(center(side), n, levels);
    }
}

}  // namespace

PolygonMesh rounded_box(const RoundedBox& box) {
    int levels = 0;
    while (std::size_t{1} << levels < box.segments) ++levels;
    const std::size_t segments = std::size_t{1} << levels;
    std::vector<double> sines(segments + 1, 1);
    for (std::size_t j = 0; j < segments; ++j) {
        sines[j] = std::sin(kPi / 2 * static_cast<double>(j) / static_cast<double>(segments));
    }
    Builder builder(box);
    builder.add_faces();
    builder.add_edges(sines);
    builder.add_corners(levels);
    return builder.release();
}

bool write_smoothing(std::string_view modifier, std::span<const Vec3> corners,
                     std::span<const Vec3> normals, SceneWriter& out) {
    const Vec3 area = cross(corners[1] - corners[0], corners[2] - corners[0]);
    std::size_t axis = 0;
    for (std::size_t i = 1; i < 3; ++i) {
        if (std::abs(area[i]) > std::abs(area[axis])) axis = i;
    }
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    const double determinant = area[axis];
    if (determinant == 0) return false;
    // n(u, v) = a u + b v + c through the three vertices, by Cramer's rule.
    const Vec3 d1 = corners[1] - corners[0];
    const Vec3 d2 = corners[2] - corners[0];
    std::array<double, 10> reals{static_cast<double>(axis)};
    for (std::size_t k = 0; k < 3; ++k) {
        const double n1 = normals[1][k] - normals[0][k];
        const double n2 = normals[2][k] - normals[0][k];
        const double a = (n1 * d2[v] - n2 * d1[v]) / determinant;
        const double b = (n2 * d1[u] - n1 * d2[u]) / determinant;
        reals[3 * k + 1] = a;
        reals[3 * k + 2] = b;
        reals[3 * k + 3] = normals[0][k] - a * corners[0][u] - b * corners[0][v];
    }
    const std::array<std::string, 4> strings = {"dx", "dy", "dz", "tmesh.cal"};
    out.write(modifier, "texfunc", "Phong", reals, strings);
    return true;
}

}  // namespace lightwalk
