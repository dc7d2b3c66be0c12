#pragma once
// Panes of BSDF data: seen from other directions they look the same only within a cell of the data.
#include <cstdint>
#include <vector>

#include "core/bsdf/bsdf.h"
#include "core/scene/scene.h"

namespace lightwalk {

/// Tells the cells apart in which panes of data (aBSDF) are seen. Immutable.
class DataCells {
  public:
    /// The scene must outlive this.
    explicit DataCells(const Scene& scene);
    /// @param direction  of the ray that meets the pane, a unit vector
    /// @return  a number of the cell; 0 where the surface is no pane of data
    [[nodiscard]] std::uint32_t find(const Hit& hit, const Vec3& direction) const;

  private:
    struct Pane {
        const Bsdf* data = nullptr;
        Vec3 up;
    };
    const Scene& scene_;
    std::vector<Pane> panes_;  ///< by modifier; empty where the scene has none
};

}  // namespace lightwalk
