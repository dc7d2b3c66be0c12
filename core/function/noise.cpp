#include "core/function/noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace lightwalk {
namespace {

// Perlin's permutation (K. Perlin, "Improving Noise", SIGGRAPH 2002).
constexpr std::array<std::uint8_t, 256> kPermutation{
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225,  //
    140, 36,  103, 30,  69,  142, 8,   99,  37,  240, 21,  10,  23,  190, 6,   148,  //
    247, 120, 234, 75,  0,   26,  197, 62,  94,  252, 219, 203, 117, 35,  11,  32,   //
    57,  177, 33,  88,  237, 149, 56,  87,  174, 20,  125, 136, 171, 168, 68,  175,  //
    74,  165, 71,  134, 139, 48,  27,  166, 77,  146, 158, 231, 83,  111, 229, 122,  //
    60,  211, 133, 230, 220, 105, 92,  41,  55,  46,  245, 40,  244, 102, 143, 54,   //
    65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,  18,  169,  //
    200, 196, 135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,   //
    52,  217, 226, 250, 124, 123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212,  //
    207, 206, 59,  227, 47,  16,  58,  17,  182, 189, 28,  42,  223, 183, 170, 213,  //
    119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,    //
    129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104,  //
    218, 246, 97,  228, 251, 34,  242, 193, 238, 210, 144, 12,  191, 179, 162, 241,  //
    81,  51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,  181, 199, 106, 157,  //
    184, 84,  204, 176, 115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,   //
    222, 114, 67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180};

/// The permutation twice over, so that sums of two bytes need no mask.
constexpr std::array<std::uint8_t, 513> kTwice = [] {
    std::array<std::uint8_t, 513> twice{};
    for (std::size_t i = 0; i < twice.size(); ++i) twice[i] = kPermutation[i & 255];
    return twice;
}();

/// Perlin's gradients: twelve edges of a cube, four of them twice.
struct Gradient {
    double x, y, z;
};
constexpr std::array<Gradient, 16> kGradients{{{1, 1, 0},
                                               {-1, 1, 0},
                                               {1, -1, 0},
                                               {-1, -1, 0},
                                               {1, 0, 1},
                                               {-1, 0, 1},
                                               {1, 0, -1},
                                               {-1, 0, -1},
                                               {0, 1, 1},
                                               {0, -1, 1},
                                               {0, 1, -1},
                                               {0, -1, -1},
                                               {1, 1, 0},
                                               {0, -1, 1},
                                               {-1, 1, 0},
                                               {0, -1, -1}}};

double gradient(std::uint8_t hash, double x, double y, double z) {
    const Gradient& g = kGradients[hash & 15u];
    return g.x * x + g.y * y + g.z * z;
}
double fade(double t) {
    return t * t * t * (t * (t * 6 - 15) + 10);
}
double lerp(double s, double a, double b) {
    return a + s * (b - a);
}

bool within(double limit, double x, double y, double z) {
    return std::abs(x) < limit && std::abs(y) < limit && std::abs(z) < limit;
}

/// Cell of the lattice along one axis, and the place in it.
struct Cell {
    explicit Cell(double x) {
        const std::int32_t i = static_cast<std::int32_t>(x) - (x < 0 ? 1 : 0);
        t = x - i;
        index = static_cast<std::uint32_t>(i) & 255u;
    }
    double t;
    std::uint32_t index;
};

}  // namespace

double noise3(double x, double y, double z) {
    if (!within(2147483647.0, x, y, z)) return 0;
    const Cell cx(x), cy(y), cz(z);
    const std::uint32_t a = kTwice[cx.index] + cy.index;
    const std::uint32_t b = kTwice[cx.index + 1] + cy.index;
    const std::uint32_t aa = kTwice[a] + cz.index, ab = kTwice[a + 1] + cz.index;
    const std::uint32_t ba = kTwice[b] + cz.index, bb = kTwice[b + 1] + cz.index;
    const double tx = cx.t, ty = cy.t, tz = cz.t;
    const double u = fade(tx), v = fade(ty), w = fade(tz);
    const double near = lerp(
        v, lerp(u, gradient(kTwice[aa], tx, ty, tz), gradient(kTwice[ba], tx - 1, ty, tz)),
        lerp(u, gradient(kTwice[ab], tx, ty - 1, tz), gradient(kTwice[bb], tx - 1, ty - 1, tz)));
    const double far = lerp(v,
                            lerp(u, gradient(kTwice[aa + 1], tx, ty, tz - 1),
                                 gradient(kTwice[ba + 1], tx - 1, ty, tz - 1)),
                            lerp(u, gradient(kTwice[ab + 1], tx, ty - 1, tz - 1),
                                 gradient(kTwice[bb + 1], tx - 1, ty - 1, tz - 1)));
    return lerp(w, near, far);
}

namespace function {

double noise3_difference(int axis, double x, double y, double z, NoiseMemory& memory) {
    const double before =
        lightwalk::noise3(axis == 0 ? x - kNoiseStep : x, axis == 1 ? y - kNoiseStep : y,
                          axis == 2 ? z - kNoiseStep : z);
    return (noise3(x, y, z, memory) - before) / kNoiseStep;
}

}  // namespace function

namespace {

// fnoise3 halves a cube of kCellUnits units ten times; the last half is nothing.
constexpr std::int32_t kCellUnits = 2000;
// The hash of lattice point (i, j, k) begins with this sum of its coordinates.
constexpr std::uint32_t kStrideX = 17, kStrideY = 23, kStrideZ = 29;
constexpr std::uint32_t kDiagonal = kStrideX + kStrideY + kStrideZ;

using Octet = std::array<double, 8>;

/// Uniform in (-1, 1] times `scale` for each of eight lattice points, given their sums of
/// coordinates: base,
/// + dx, + dy, + dz, + dy + dz, + dx + dz, + dx + dy, + all three.
///
/// Loops of eight equal steps, which any compiler makes its machine's vectors of. No vectors of
/// GCC's own kind: version 12.2 compiles those of 64 bytes for AVX-512 to something else. Inline,
/// and not unrolled before they become vectors: otherwise fnoise3 takes 5 to 20 % longer.
[[gnu::always_inline]] inline void hash(std::uint32_t base, std::uint32_t dx, std::uint32_t dy,
                                        std::uint32_t dz, double scale, Octet& values) {
    constexpr std::uint32_t kAll = 0xffffffffu;
    constexpr std::array<std::uint32_t, 8> kX{0, kAll, 0, 0, 0, kAll, kAll, kAll};
    constexpr std::array<std::uint32_t, 8> kY{0, 0, kAll, 0, kAll, 0, kAll, kAll};
    constexpr std::array<std::uint32_t, 8> kZ{0, 0, 0, kAll, kAll, kAll, 0, kAll};
    std::array<std::int32_t, 8> bits{};
#pragma GCC unroll 1
    for (std::size_t k = 0; k < bits.size(); ++k) {
        std::uint32_t n = base + (dx & kX[k]) + (dy & kY[k]) + (dz & kZ[k]);
        n = (n << 13) ^ n;
        bits[k] =
            static_cast<std::int32_t>((n * (n * n * 15731u + 789221u) + 1376312589u) & 0x7fffffffu);
    }
#pragma GCC unroll 1
    for (std::size_t k = 0; k < bits.size(); ++k) {
        values[k] = (1.0 - bits[k] * (1 / 1073741824.0)) * scale;
    }
}

/// One axis: the unit that holds x, counted from the corner of the present cube.
struct Descent {
    std::int64_t cell;
    std::int32_t offset;
    explicit Descent(double x)
        : cell(static_cast<std::int64_t>(std::floor(x))),
          offset(static_cast<std::int32_t>(static_cast<std::int64_t>(kCellUnits * x) -
                                           kCellUnits * cell)) {}
    /// Of the cell [units].
    [[nodiscard]] std::uint32_t corner() const {
        return static_cast<std::uint32_t>(kCellUnits * cell);
    }
    /// Descend to the half, of size `half`, that contains x. Returns all ones for the upper half,
    /// else 0. Branchless, as the outcome is unpredictable.
    std::uint32_t step(std::int32_t half) {
        const auto upper = static_cast<std::uint32_t>((half - offset) >> 31);
        offset -= static_cast<std::int32_t>(static_cast<std::uint32_t>(half) & upper);
        return upper;
    }
};

double mean(const Octet& f) {
    return (f[0] + f[1] + f[2] + f[3] + f[4] + f[5] + f[6] + f[7]) * 0.125;
}

/// Values at the corners of octant `o`, from those of its parent `f` and the displacements `h` of
/// the centers of the cube, its faces and its edges.
void subdivide(const Octet& f, std::size_t o, const Octet& h, Octet& g) {
    // The corners on the octant's side of the cube, across each axis in turn.
    const double* x = &f[o & 1u];
    const double* y = &f[o & 2u];
    const double* z = &f[o & 4u];
    g[o] = f[o];
    g[o ^ 7u] = mean(f) + h[0];
    g[o ^ 6u] = 0.25 * (x[0] + x[2] + x[4] + x[6]) + h[1];
    g[o ^ 5u] = 0.25 * (y[0] + y[1] + y[4] + y[5]) + h[2];
    g[o ^ 3u] = 0.25 * (z[0] + z[1] + z[2] + z[3]) + h[3];
    g[o ^ 1u] = 0.5 * (f[o] + f[o ^ 1u]) + h[4];
    g[o ^ 2u] = 0.5 * (f[o] + f[o ^ 2u]) + h[5];
    g[o ^ 4u] = 0.5 * (f[o] + f[o ^ 4u]) + h[6];
}

}  // namespace

double fnoise3(double x, double y, double z) {
    function::FractalMemory memory;
    return function::fnoise3(x, y, z, memory);
}

double function::fnoise3(double x, double y, double z, FractalMemory& memory) {
    if (!within(1e15, x, y, z)) return 0;
    Descent ax(x), ay(y), az(z);
    std::uint32_t base = kStrideX * ax.corner() + kStrideY * ay.corner() + kStrideZ * az.corner();
    const std::array<std::int64_t, 3> cell{ax.cell, ay.cell, az.cell};
    bool known = cell == memory.cell;
    if (!known) {
        constexpr std::uint32_t kSize = kCellUnits;
        Octet h;
        hash(base, kStrideX * kSize, kStrideY * kSize, kStrideZ * kSize, 1, h);
        // From the order of hash() to the one in which bit a stands for axis a.
        memory.corners[0] = {h[0], h[1], h[2], h[6], h[3], h[5], h[4], h[7]};
        memory.cell = cell;
    }
    std::uint32_t size = kCellUnits;
    for (std::size_t level = 0; level < FractalMemory::kLevels; ++level) {
        size /= 2;
        const auto half = static_cast<std::int32_t>(size);
        const std::uint32_t ux = ax.step(half), uy = ay.step(half), uz = az.step(half);
        const std::uint32_t sx = kStrideX * size, sy = kStrideY * size, sz = kStrideZ * size;
        const std::uint32_t octant = (ux & 1u) | (uy & 2u) | (uz & 4u);
        known = known && memory.octants[level] == octant;
        if (!known) {
            Octet h;
            // Outwards, to the octant's own faces: up or down.
            hash(base + kDiagonal * size, (sx ^ ~ux) - ~ux, (sy ^ ~uy) - ~uy, (sz ^ ~uz) - ~uz,
                 half * kNoiseStep, h);
            subdivide(memory.corners[level], octant, h, memory.corners[level + 1]);
            memory.octants[level] = octant;
        }
        base += (sx & ux) + (sy & uy) + (sz & uz);
    }
    return mean(memory.corners[FractalMemory::kLevels]);
}

}  // namespace lightwalk
