#include "io/generators/vertex_rows.h"

#include "io/generators/scene_writer.h"

namespace lightwalk {

void VertexRows::write(std::size_t i, Row& row) const {
    row.i = i;
    row.text.clear();
    row.begin.assign(1, 0);
    for (std::size_t j = 0; j <= grid_.n(); ++j) {
        append_vertex(grid_.point(i, j), row.text);
        row.begin.push_back(row.text.size());
    }
}

}  // namespace lightwalk
