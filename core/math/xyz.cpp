#include "core/math/xyz.h"

#include <array>

namespace lightwalk {
namespace {

constexpr std::array<std::array<double, 3>, 3> kFromXyz{{{2.565312843, -1.166849616, -0.398463227},
                                                         {-1.022108172, 1.978286617, 0.043821555},
                                                         {0.074724377, -0.251939567, 1.177215190}}};

}  // namespace

Rgb to_xyz(const Rgb& c) {
    return kEfficacy * Rgb{0.514144621f * c.r + 0.323884480f * c.g + 0.161970899f * c.b,
                           brightness(c),
                           0.024100529f * c.r + 0.122852734f * c.g + 0.853046737f * c.b};
}

Rgb from_xyz(const Rgb& xyz) {
    const auto X = static_cast<double>(xyz.r), Y = static_cast<double>(xyz.g),
               Z = static_cast<double>(xyz.b);
    Rgb color;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::array<double, 3>& row = kFromXyz[i];
        color[i] = static_cast<float>((row[0] * X + row[1] * Y + row[2] * Z) /
                                      static_cast<double>(kEfficacy));
    }
    return color;
}

}  // namespace lightwalk
