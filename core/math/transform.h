#pragma once
// Affine transforms on row vectors: p' = [x y z 1] M, v' = [x y z 0] M; operations apply left to
// right.
#include <array>

#include "core/math/vec3.h"

namespace lightwalk {

/// 4x3 affine matrix: rows 0-2 are the images of the axes, row 3 the translation.
struct Matrix {
    std::array<Vec3, 4> row{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{0, 0, 0}};

    [[nodiscard]] Vec3 vector(const Vec3& v) const {
        return row[0] * v.x + row[1] * v.y + row[2] * v.z;
    }
    [[nodiscard]] Vec3 point(const Vec3& p) const { return vector(p) + row[3]; }
    friend bool operator==(const Matrix&, const Matrix&) = default;
};

/// First `a`, then `b`.
[[nodiscard]] inline Matrix operator*(const Matrix& a, const Matrix& b) {
    return {{b.vector(a.row[0]), b.vector(a.row[1]), b.vector(a.row[2]), b.point(a.row[3])}};
}

/// A similarity with its inverse; `scale` is signed (negative: mirrored), its size is what lengths
/// grow by.
struct Transform {
    Matrix forward, inverse;
    double scale = 1;

    [[nodiscard]] double size() const { return scale < 0 ? -scale : scale; }
    [[nodiscard]] bool is_identity() const { return forward == Matrix{}; }
};

/// First `a`, then `b`.
[[nodiscard]] inline Transform operator*(const Transform& a, const Transform& b) {
    return {a.forward * b.forward, b.inverse * a.inverse, a.scale * b.scale};
}

}  // namespace lightwalk
