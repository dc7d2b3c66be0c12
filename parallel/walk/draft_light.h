#pragma once
// What indirect light adds to the pixels of a view, soon and roughly: shown until it is known.
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/cloud/progressive.h"
#include "core/trace/tracer.h"
#include "core/view/view.h"
#include "parallel/executor.h"
#include "parallel/frame_options.h"
#include "parallel/stop_flag.h"
#include "parallel/worker_contexts.h"

namespace lightwalk {

/// Ambient values are computed for a coarse grid of the picture's pixels. Then every pixel's ray is
/// followed without a look at light sources, and gets interpolated values, times what surfaces,
/// patterns and mirrors make of them: edges and patterns are as sharp as in the picture itself,
/// only the light is rough. At first that is done for every second pixel of every second row only.
class DraftLight {
  public:
    /// @param indirect, direct  tracers of one scene, with and without indirect light, the former
    ///                          with a cache; must outlive this
    /// @param groups  what each light group adds is kept; null: it is not
    DraftLight(const Tracer& indirect, const Tracer& direct,
               const std::shared_ptr<const LightGroups>& groups, int workers);

    /// The view whose draft is wanted; that of another one is forgotten.
    /// @param options  of the picture: one sample a pixel, no window
    /// @return  whether it is another one
    bool aim(const View& view, const FrameOptions& options);
    /// Work on it for about so many seconds, or until it is usable.
    void step(double seconds, Executor& executor, const StopFlag& stop);
    /// Whether the values of the coarse grid are known: the rest takes no long time.
    [[nodiscard]] bool filled() const {
        return stage_ != Stage::filling || to_fill_.places.empty();
    }
    /// Whether there is something for every pixel.
    [[nodiscard]] bool usable() const { return view_ && stage_ != Stage::filling; }
    /// Whether there is nothing left to do.
    [[nodiscard]] bool whole() const { return view_ && stage_ == Stage::whole; }
    /// Show another mixture of the light groups, where these are kept.
    void mix(const LightMixture& mixture);

    // Once it is usable, by pixel, row by row from the bottom:

    /// What indirect light adds to the radiance that `direct` finds, where the constant -av stands
    /// for it: less than 0 where there is less light than that [W/(m² sr)].
    [[nodiscard]] std::span<const Rgb> added() const { return added_; }
    /// Adds it to pixels that lack it, row by row from the top. Where light groups are not kept no
    /// pixel becomes darker than if all that it shows were the constant's light: what is guessed of
    /// a pixel may be of a darker surface than the one that this is calculated for, and would be
    /// black where there is less light than the constant.
    void add_to(std::span<Rgb> radiance) const;
    /// Of that, what each light group adds, by pixel, then group; empty: not kept.
    [[nodiscard]] std::span<const Rgb> groups() const { return groups_; }
    /// Number of rays that the last step took.
    [[nodiscard]] std::uint64_t rays() const { return rays_; }

  private:
    using Clock = std::chrono::steady_clock;
    enum class Stage { filling, sharpening, mending, whole };
    class Silence final : public WarningSink {  // pictures say what is to be said
        void warn(const std::string& /*message*/) override {}
    };
    class Difference;

    [[nodiscard]] bool fill(double seconds, Executor& executor, const StopFlag& stop);
    [[nodiscard]] bool look(Clock::time_point deadline, Executor& executor, const StopFlag& stop);
    void next_stage(Executor& executor);
    void choose_unknown(bool fill);
    void guess_rest(Executor& executor);
    [[nodiscard]] PixelPlace place_of(std::size_t pixel) const {
        const auto width = static_cast<std::size_t>(options_.width);
        return {static_cast<int>(pixel % width), static_cast<int>(pixel / width)};
    }

    Silence silence_;
    const Tracer &indirect_, &direct_;
    WorkerContexts contexts_, direct_contexts_;
    std::size_t group_count_;
    LightMixture mixture_;

    std::optional<View> view_;
    FrameOptions options_;
    Stage stage_ = Stage::whole;
    ProgressiveWork to_fill_;             ///< pixels whose values are computed
    std::vector<std::uint32_t> to_look_;  ///< pixels by number
    std::vector<std::uint8_t> known_;     ///< by pixel
    std::vector<Rgb> added_, groups_;
    std::vector<Rgb> constant_;  ///< what the constant adds; empty where light groups are kept
    std::uint64_t rays_ = 0;
};

}  // namespace lightwalk
