#pragma once
// Virtual sources: where lights appear in flat mirrors and through prisms, so that their light can
// be sampled. Source: Ward, "The RADIANCE lighting simulation and rendering system", SIGGRAPH 1994
// ("virtual light source calculation"); the -dr and -dp options of rpict(1).
#include <vector>

#include "core/light/light_sources.h"
#include "core/virtual_source/projection.h"
#include "core/virtual_source/redirecting_modifier.h"

namespace lightwalk {

inline constexpr std::size_t kMaxVirtualSources = std::size_t{1} << 18;
inline constexpr int kMaxRedirections = 64;  ///< upper limit of the option -dr

/// Appends to the list of light sources, for every source and every flat mirror or prism, its
/// virtual sources; and the virtual sources of those, up to the depth of -dr.
class VirtualSourceBuilder {
  public:
    VirtualSourceBuilder(LightSources& lights, const LightTransport& tracer, WarningSink& warnings);

    /// Throws InputError when more than kMaxVirtualSources would be made.
    void build();

  private:
    /// A mirror, or a prism with its material.
    struct RedirectingSurface {
        SurfaceId surface = kNoSurface;
        Plane plane;
        RedirectingDisk disk;
        const RedirectingModifier* prism = nullptr;  ///< null: mirror
        int branches = 1;
    };
    void collect_redirecting_surfaces(WarningSink& warnings);
    void add_virtual_sources(std::int32_t parent, int depth);
    void try_virtual_source(std::int32_t parent, const RedirectingSurface& surface, int branch,
                            int depth);
    [[nodiscard]] std::optional<Projection> projection(const LightSource& source,
                                                       const RedirectingSurface& surface,
                                                       int branch);
    [[nodiscard]] bool lights_disk(const LightSource& source,
                                   const RedirectingSurface& surface) const;

    enum class Pretest { discard, follow, direct };
    [[nodiscard]] Pretest pretest(std::int32_t parent, const RedirectingSurface& surface,
                                  const RedirectingDisk& disk);
    [[nodiscard]] int pretest_samples(const LightSource& parent, const RedirectingDisk& disk) const;
    [[nodiscard]] float light_at(const Vec3& point, const Vec3& direction, std::int32_t source,
                                 bool alone);

    LightSources& lights_;
    const LightTransport& tracer_;
    TraceContext context_;
    std::vector<RedirectingSurface> redirecting_surfaces_;
};

}  // namespace lightwalk
