#pragma once
// What a walk tells of the light where somebody points.
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "core/trace/light_sampler.h"
#include "core/view/view.h"
#include "io/net/walk_reply.h"
#include "io/net/walk_request.h"
#include "parallel/frame_options.h"
#include "parallel/walk/live_walk.h"

namespace lightwalk {

/// Asks rays of the same light as the pictures. Every number comes with its 95 % interval, which is
/// made of samples that share nothing (LightSampler): it holds the light itself, not only what a
/// cache of indirect light happens to say of it. For one thread.
class WalkAnswers {
  public:
    /// All must outlive this.
    /// @param groups  of emitters that may be dimmed; null: none
    WalkAnswers(const Tracer& tracer, WarningSink& warnings,
                std::shared_ptr<const LightGroups> groups = nullptr);

    /// Of the light groups in what follows.
    void mix(LightMixture mixture);

    /// What is seen at a place of a view, and how much light falls on it, from the side that is
    /// seen.
    /// @param pixel  width and height of one, of the picture's [0 ... 1]: the luminance is its mean
    [[nodiscard]] PickedReply pick(const PickRequest& request, const Camera& camera,
                                   const std::pair<double, double>& pixel);
    /// Mean luminance in a rectangle of a picture; pixels that it touches at their middle. What
    /// the picture has there is corrected by samples, see corrected_sum().
    /// @param view, options  of that picture, but for its size
    [[nodiscard]] MeanReply mean(const MeanRequest& request, const LivePicture& picture,
                                 const View& view, FrameOptions options);
    /// Light at all pins, and their luminances as seen from the eye. Each call adds samples to
    /// those of pins that are where they were, for so long, until all have enough [s].
    [[nodiscard]] ProbesReply measure(std::span<const ProbePlace> probes, const Vec3& eye,
                                      double seconds);
    /// What they were measured as last, in the mixture of now: nothing is traced.
    [[nodiscard]] ProbesReply known() const;

  private:
    struct Pin {
        Vec3 position, normal, eye;
        LightBatches falling;  ///< irradiance
        LightBatches seen;     ///< radiance to the eye
    };
    [[nodiscard]] LightSampler& sampler();
    /// [cd/m²] or [lx]
    [[nodiscard]] MeanInterval shown(const LightBatches& light) const;
    [[nodiscard]] MeanInterval pixel(const Camera& camera, double x, double y,
                                     const std::pair<double, double>& size);
    /// False: it has enough samples.
    [[nodiscard]] bool sample(Pin& pin);
    [[nodiscard]] RandomStream random_of(std::uint32_t kind, const LightBatches& light);

    const Tracer& tracer_;
    WarningSink& warnings_;
    std::shared_ptr<const LightGroups> groups_;
    std::optional<LightSampler> sampler_;  ///< nothing: nobody has asked yet
    LightMixture mixture_;
    std::map<std::uint32_t, Pin> pins_;  ///< by id
};

/// Height of the eye above what is below it; nothing where nothing is below [m].
[[nodiscard]] std::optional<double> height_above_ground(const Geometry& geometry, const Vec3& eye,
                                                        const Vec3& up);

}  // namespace lightwalk
