#pragma once
// Numbers by which the points of a walk know surfaces: they stay while a scene's list of surfaces
// is edited, where ids do not.
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lightwalk {

/// Of a scene that was read once each surface's key is its id.
class SurfaceKeys {
  public:
    /// @param id  any, also none (-1)
    [[nodiscard]] std::uint32_t operator()(std::int32_t id) const {
        return pieces_.empty() || id < 0 ? static_cast<std::uint32_t>(id) : find(id);
    }
    /// The keys after surfaces were replaced by others, which get keys that none had before.
    /// @param first  id of the first one
    /// @param gone   how many are replaced
    /// @param come   by how many
    [[nodiscard]] SurfaceKeys replaced(std::size_t first, std::size_t gone, std::size_t come) const;
    /// Edits make them longer, and slower to look up.
    [[nodiscard]] std::size_t pieces() const { return pieces_.size(); }

  private:
    /// Ids from `first` on, up to the next piece's: they follow each other from `key` on.
    struct Piece {
        std::int32_t first;
        std::uint32_t key;
    };
    [[nodiscard]] std::uint32_t find(std::int32_t id) const;
    void add(Piece piece);

    std::vector<Piece> pieces_;                    ///< by `first`; none: all keys are ids
    std::uint32_t next_ = std::uint32_t{1} << 31;  ///< that none has had
};

}  // namespace lightwalk
