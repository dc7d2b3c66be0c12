#pragma once
// What is measured of a scene's light sources, kept for whoever asks for the same options.
#include <memory>
#include <optional>

#include "core/light/light_sources.h"
#include "core/transport/options.h"

namespace lightwalk {

class LightMemo {
  public:
    virtual ~LightMemo() = default;
    /// For exactly these options.
    [[nodiscard]] virtual std::optional<LightMeasures> find(const RenderNumbers& options) const = 0;
    virtual void keep(const RenderNumbers& options, const LightMeasures& measures) = 0;
};

/// In memory that this process shares with those that it forks: what one of them keeps, the next
/// one finds. Few options, and not of scenes with very many sources. Null where the system has no
/// such memory.
[[nodiscard]] std::shared_ptr<LightMemo> make_shared_light_memo();

}  // namespace lightwalk
