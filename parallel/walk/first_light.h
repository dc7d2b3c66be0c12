#pragma once
// The drafts of indirect light that a view has before its pixels are traced: by rough values, then
// by those of the picture, as far as these come soon.
#include <memory>

#include "parallel/concurrent_cache.h"
#include "parallel/walk/draft_light.h"

namespace lightwalk {

/// Options for the first bounce only, with no more ambient values than rpict computes by default,
/// and a quarter of the rays for each.
[[nodiscard]] RenderOptions rough_options(RenderOptions options);

/// What there is for a view.
struct ViewDraft {
    const DraftLight* best = nullptr;  ///< usable; null: nothing yet
    bool last = true;                  ///< there will be no better one
};

class FirstLight {
  public:
    /// Parameters as those of DraftLight.
    /// @param indirect  the picture's
    FirstLight(const Tracer& indirect, const Tracer& direct,
               std::shared_ptr<const LightGroups> groups, int workers);

    /// Work on the drafts of a view for about so many seconds. They are there until those of
    /// another one are asked for.
    /// @param options  of the picture: one sample a pixel, no window
    [[nodiscard]] ViewDraft step(const View& view, const FrameOptions& options, double seconds,
                                 Executor& executor, const StopFlag& stop);
    /// Show another mixture of the light groups, where these are kept.
    void mix(const LightMixture& mixture);
    /// Number of rays that the last step took.
    [[nodiscard]] std::uint64_t rays() const { return rays_; }

  private:
    using Clock = std::chrono::steady_clock;
    class Silence final : public WarningSink {  // pictures say what is to be said
        void warn(const std::string& /*message*/) override {}
    };
    /// Values that nothing else finds; made when first needed.
    struct Rough {
        Rough(const FirstLight& light, const RenderOptions& options);
        Silence silence;
        Tracer tracer;
        ConcurrentCache cache;
        DraftLight draft;
    };

    [[nodiscard]] static bool is_rough(const RenderOptions& options);
    [[nodiscard]] DraftLight* next();

    const Tracer &indirect_, &direct_;
    std::shared_ptr<const LightGroups> groups_;
    int workers_;
    LightMixture mixture_;
    std::unique_ptr<DraftLight> fine_;  ///< null: its values have no cache
    std::unique_ptr<Rough> rough_;
    double fine_seconds_ = 0;  ///< that the picture's values have taken for the present view
    std::uint64_t rays_ = 0;
};

}  // namespace lightwalk
