#include "io/generators/vertex_rows.h"

#include <doctest/doctest.h>

#include <optional>
#include <string>

namespace lightwalk {

TEST_CASE("points are written as polygons list them, in whichever order two rows are asked for") {
    const SurfaceGrid grid(3, 2, false, [](double s, double t) -> std::optional<Vec3> {
        return Vec3{3 * s, -2 * t, s / 3};
    });
    VertexRows rows(grid);
    CHECK(rows.text(0, 0) == "\n0 -0 0");
    CHECK(rows.text(1, 2) == "\n1 -2 0.111111111111");
    CHECK(rows.text(0, 1) == "\n0 -1 0");
    CHECK(rows.text(2, 0) == "\n2 -0 0.222222222222");
    CHECK(rows.text(1, 1) == "\n1 -1 0.111111111111");
    CHECK(rows.text(3, 2) == "\n3 -2 0.333333333333");
}

}  // namespace lightwalk
