#pragma once
// Ids: indices into a Scene's tables, the same on every rank.
#include <cstdint>

namespace lightwalk {

enum class ModifierId : std::int32_t {};  ///< into Scene modifiers; kVoid is the modifier `void`
enum class SurfaceId : std::int32_t {};   ///< into Scene surfaces
enum class InstanceId : std::int32_t {
};  ///< of an instance: a path of nested placements (see InstancePaths)

inline constexpr ModifierId kVoid{-1};
inline constexpr SurfaceId kNoSurface{-1};
inline constexpr InstanceId kWorld{-1};

template <class Id>
[[nodiscard]] constexpr std::int32_t index(Id id) {
    return static_cast<std::int32_t>(id);
}

}  // namespace lightwalk
