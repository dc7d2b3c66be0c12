#include "core/ambient/derivatives.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/ambient/quadratic.h"

namespace lightwalk {
namespace {

constexpr double kFloor = 0.01;  ///< part of the value that geometry alone stands for

/// Symmetric 3x3 matrix.
struct Symmetric {
    double xx = 0, yy = 0, zz = 0, xy = 0, yz = 0, zx = 0;

    /// s (a bᵀ + b aᵀ)
    void add_outer(const Vec3& a, const Vec3& b, double s) {
        xx += 2 * s * a.x * b.x;
        yy += 2 * s * a.y * b.y;
        zz += 2 * s * a.z * b.z;
        xy += s * (a.x * b.y + a.y * b.x);
        yz += s * (a.y * b.z + a.z * b.y);
        zx += s * (a.z * b.x + a.x * b.z);
    }
    [[nodiscard]] double between(const Vec3& a, const Vec3& b) const {
        const Vec3 m{xx * b.x + xy * b.y + zx * b.z, xy * b.x + yy * b.y + yz * b.z,
                     zx * b.x + yz * b.y + zz * b.z};
        return dot(a, m);
    }
};

/// A sample's place, from the point, with its squared length and the inverse of that.
struct Corner {
    explicit Corner(const Vec3& place)
        : at(place), squared(length_squared(place)), inverse(1 / squared) {}
    Vec3 at;
    double squared, inverse;
};

/// First and second derivatives of a sum of triangles' form factors, edge by edge.
class EdgeSum {
  public:
    explicit EdgeSum(const Vec3& normal) : normal_(normal) {}

    /// The directed edge a -> b times `g`.
    void add(const Corner& from, const Corner& to, double g) {
        if (g == 0) return;
        const Vec3 &a = from.at, &b = to.at, e = b - a, c = cross(a, b);
        const double aa = from.squared, bb = to.squared, ee = length_squared(e),
                     cc = length_squared(c);
        if (!(cc > 0) || !(ee > 0)) return;
        const double ia = from.inverse, ib = to.inverse, ie = 1 / ee, ic = 0.5 / cc;
        const double ea = dot(e, a), eb = dot(e, b);
        const double i1 =
            std::acos(std::clamp(dot(a, b) / std::sqrt(aa * bb), -1.0, 1.0)) / std::sqrt(cc);
        const double i2 = (eb * ib - ea * ia + ee * i1) * ic;
        const double j2 = (0.5 * (ia - ib) - ea * i2) * ie;
        const double i3 = 0.5 * (eb * (ib * ib) - ea * (ia * ia) + 3 * ee * i2) * ic;
        const double j3 = 0.25 * (ia * ia - ib * ib) * ie - ea * i3 * ie;
        const double k3 = (i2 - aa * i3 - 2 * ea * j3) * ie;
        const Vec3 w = a * i2 + e * j2, ne = cross(normal_, e);
        const double nc = dot(normal_, c);
        if (!std::isfinite(i3 + j3 + k3 + w.x + w.y + w.z)) return;
        gradient += (ne * i1 + w * (2 * nc)) * (g / (2 * kPi));
        const double s = -g / kPi;
        hessian.add_outer(ne, w, s);
        hessian.add_outer(a, a, s * 2 * nc * i3);
        hessian.add_outer(e, e, s * 2 * nc * k3);
        hessian.add_outer(a, e, s * 4 * nc * j3);
        const double diagonal = -s * nc * i2;
        hessian.xx += diagonal;
        hessian.yy += diagonal;
        hessian.zz += diagonal;
    }

    Symmetric hessian;
    Vec3 gradient;

  private:
    Vec3 normal_;
};

/// Relative brightness of the cells: 1 on average, with a floor; 1 everywhere in the dark.
class Brightness {
  public:
    explicit Brightness(const Hemisphere& h) : h_(h) {
        const double total = static_cast<double>(mean(h.sum));
        dark = !(total > kEpsilon);
        scale_ = dark ? 0 : (1 - kFloor) * static_cast<double>(h.cells.size()) / total;
    }
    [[nodiscard]] double at(int i, int j) const {
        return dark ? 1 : scale_ * static_cast<double>(mean(h_.cell(i, j).value)) + kFloor;
    }
    bool dark = false;

  private:
    const Hemisphere& h_;
    double scale_ = 0;
};

struct CellIndex {
    int i = 0, j = 0;
};

/// A triangle shows what its farthest corner sees: what is nearer hides it.
double shown(const Hemisphere& h, const Brightness& g, CellIndex a, CellIndex b, CellIndex c) {
    const CellIndex first = h.cell(b.i, b.j).nearness < h.cell(a.i, a.j).nearness ? b : a;
    const CellIndex farthest =
        h.cell(c.i, c.j).nearness < h.cell(first.i, first.j).nearness ? c : first;
    return g.at(farthest.i, farthest.j);
}

/// All edges of the samples' triangles; each is visited once, with the difference of its two
/// triangles.
EdgeSum sum_edges(const Hemisphere& h, const Brightness& g) {
    EdgeSum sum(h.normal);
    const int n = h.divisions, m = n - 1;
    const auto at = [m](int i, int j) {
        return static_cast<std::size_t>(i) * static_cast<std::size_t>(m) +
               static_cast<std::size_t>(j);
    };
    std::vector<double> lower(static_cast<std::size_t>(m) * static_cast<std::size_t>(m)),
        upper(lower.size());
    for (int i = 0; i < m; ++i) {
        for (int j = 0; j < m; ++j) {
            lower[at(i, j)] = shown(h, g, {i, j}, {i, j + 1}, {i + 1, j});
            upper[at(i, j)] = shown(h, g, {i + 1, j + 1}, {i + 1, j}, {i, j + 1});
        }
    }
    std::vector<Corner> corners;
    corners.reserve(h.cells.size());
    for (const HemisphereCell& cell : h.cells) corners.emplace_back(cell.vertex);
    const auto corner = [&](int i, int j) -> const Corner& {
        return corners[static_cast<std::size_t>(i) * static_cast<std::size_t>(n) +
                       static_cast<std::size_t>(j)];
    };
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            const bool right = j < m, down = i < m;
            if (right) {
                const double difference =
                    (down ? lower[at(i, j)] : 0) - (i > 0 ? upper[at(i - 1, j)] : 0);
                sum.add(corner(i, j), corner(i, j + 1), difference);
            }
            if (down) {
                const double difference =
                    (j > 0 ? upper[at(i, j - 1)] : 0) - (right ? lower[at(i, j)] : 0);
                sum.add(corner(i, j), corner(i + 1, j), difference);
            }
            if (right && down)
                sum.add(corner(i, j + 1), corner(i + 1, j), lower[at(i, j)] - upper[at(i, j)]);
        }
    }
    return sum;
}

struct Axes {
    Vec3 u, v;
    double r0 = 0, r1 = 0;
};

/// Radii from the eigenvalues of the Hessian in the tangent plane; axes along its eigenvectors.
Axes principal_axes(const Hemisphere& h, const Symmetric& hessian, double most) {
    const double h00 = hessian.between(h.u, h.u), h01 = hessian.between(h.u, h.v),
                 h11 = hessian.between(h.v, h.v);
    const Roots roots = solve_quadratic(1, -(h00 + h11), h00 * h11 - h01 * h01);
    const double a = std::abs(roots.root[0]), b = std::abs(roots.root[1]);
    if (roots.count == 0 || std::min(a, b) <= kEpsilon * kEpsilon) return {h.u, h.v, most, most};
    const double larger = std::max(a, b), smaller = std::min(a, b);
    Axes axes{h.u, h.v, std::pow(4 / larger, 0.25), std::pow(4 / smaller, 0.25)};
    if (std::abs(h01) <= kEpsilon) return axes;
    // As Radiance has it: the magnitude of the smaller eigenvalue, whatever its sign.
    const double slope = (smaller - h00) / h01, scale = 1 / std::sqrt(1 + slope * slope);
    axes.v = (h.u + h.v * slope) * scale;
    axes.u = (h.u * slope - h.v) * scale;
    return axes;
}

/// Azimuths towards which something near the horizon is closer than the record's ellipse.
std::uint32_t corral_of(const Hemisphere& h, const Axes& axes, double r0, double r1,
                        const RadiusLimits& limits) {
    const int n = h.divisions;
    if (n < 8) return 0;
    const double most_nearness = 1 / (limits.least * limits.accuracy + 0.001);
    double overhead = 0;
    for (int i = n / 4; i < 3 * n / 4; ++i) {
        for (int j = n / 4; j < 3 * n / 4; ++j) overhead += h.cell(i, j).nearness;
    }
    overhead *= 4.0 / (static_cast<double>(n) * n);
    if (overhead * r0 >= 1 || overhead >= most_nearness) return 0;
    // The 1.01 makes the last step end before the reach does; Radiance's, as its values show it.
    const double reach = kPi / (2 * n), step = reach / (std::floor(16 * reach / kPi) + 1.01);
    std::uint32_t flags = 0;
    const auto add = [&](int i, int j) {
        const HemisphereCell& c = h.cell(i, j);
        if (c.nearness <= kEpsilon || c.nearness >= most_nearness) return;
        const double a = dot(c.vertex, axes.u), b = dot(c.vertex, axes.v);
        if ((r0 * r0 * a * a + r1 * r1 * b * b) * c.nearness * c.nearness <= a * a + b * b) return;
        const double azimuth = std::atan2(b, a);
        for (double angle = azimuth - reach; angle <= azimuth + reach; angle += step) {
            const double turned = angle < 0 ? angle + 2 * kPi : angle;
            flags |= 1U << (static_cast<unsigned>(turned * 16 / kPi) & 31U);
        }
    };
    for (int k = 0; k < n; ++k) {
        add(0, k);
        add(n - 1, k);
        if (k > 0 && k < n - 1) add(k, 0), add(k, n - 1);
    }
    return flags;
}

std::array<double, 2> rotation_about(const Hemisphere& h, const Brightness& g, const Vec3& u,
                                     const Vec3& v) {
    double about_u = 0, about_v = 0;
    for (int i = 0; i < h.divisions; ++i) {
        for (int j = 0; j < h.divisions; ++j) {
            const Vec3& d = h.cell(i, j).vertex;
            const double up = dot(h.normal, d);
            if (!(up > 0)) continue;
            about_u -= g.at(i, j) * dot(v, d) / up;
            about_v += g.at(i, j) * dot(u, d) / up;
        }
    }
    const double share = 1 / (static_cast<double>(h.divisions) * h.divisions);
    return {about_u * share, about_v * share};
}

}  // namespace

AmbientDerivatives derive(const Hemisphere& h, const RadiusLimits& limits) {
    const Brightness g(h);
    const EdgeSum sum = sum_edges(h, g);
    const Axes axes = principal_axes(h, sum.hessian, limits.most);
    double r0 = axes.r0, r1 = axes.r1;
    double p0 = dot(sum.gradient, axes.u), p1 = dot(sum.gradient, axes.v);
    if (!g.dark) {
        if (r0 * std::abs(p0) > 1) r0 = 1 / std::abs(p0);
        if (r1 * std::abs(p1) > 1) r1 = 1 / std::abs(p1);
        r0 = std::min(r0, r1);
    }
    if (r0 < limits.least) {
        r0 = limits.least;
        r1 = std::max(r1, limits.least);
    }
    const double growth = 1 / std::sqrt(limits.weight);
    r0 *= growth;
    r1 = std::min(r1 * growth, 2 * r0);
    if (r1 > limits.most) {
        r1 = limits.most;
        r0 = std::min(r0, limits.most);
    }
    AmbientDerivatives result;
    result.u = axes.u;
    result.radius = {r0, r1};
    if (g.dark) return result;
    result.corral = corral_of(h, axes, limits.accuracy * r0, limits.accuracy * r1, limits);
    const double change = p0 * p0 * r0 * r0 + p1 * p1 * r1 * r1;
    if (change > 1) {
        p0 /= std::sqrt(change);
        p1 /= std::sqrt(change);
    }
    result.translation = {p0, p1};
    result.rotation = rotation_about(h, g, axes.u, axes.v);
    return result;
}

std::array<double, 2> rotation_gradient(const Hemisphere& hemisphere) {
    const Brightness g(hemisphere);
    return g.dark ? std::array<double, 2>{}
                  : rotation_about(hemisphere, g, hemisphere.u, hemisphere.v);
}

}  // namespace lightwalk
