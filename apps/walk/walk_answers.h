#pragma once
// What a walk tells of the light where somebody points.
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/trace/tracer.h"
#include "core/transport/light_groups.h"
#include "core/view/view.h"
#include "io/net/walk_reply.h"
#include "io/net/walk_request.h"
#include "parallel/walk/live_walk.h"

namespace lightwalk {

/// Asks rays of the same light as the pictures.
class WalkAnswers {
  public:
    /// All must outlive this.
    /// @param groups  of emitters that may be dimmed; null: none
    WalkAnswers(const Tracer& tracer, WarningSink& warnings,
                std::shared_ptr<const LightGroups> groups = nullptr);

    /// Of the light groups in what follows.
    void mix(LightMixture mixture) { mixture_ = std::move(mixture); }

    /// What is seen at a place of a view, and how much light falls on it, from the side that is
    /// seen.
    /// @param pixel  width and height of one, of the picture's [0 ... 1]: the luminance is its mean
    [[nodiscard]] PickedReply pick(const PickRequest& request, const Camera& camera,
                                   const std::pair<double, double>& pixel);
    /// Mean luminance in a rectangle of a picture; pixels that it touches at their middle.
    [[nodiscard]] static MeanReply mean(const MeanRequest& request, const LivePicture& picture);
    /// Light at a pin; its luminance as seen from the eye.
    [[nodiscard]] ProbeValue measure(const ProbePlace& probe, const Vec3& eye);
    /// What it was measured as last, in the mixture of now: nothing is traced. Nothing where it was
    /// not measured.
    [[nodiscard]] std::optional<ProbeValue> mixed(const ProbePlace& probe) const;

  private:
    /// A radiance or an irradiance.
    struct Light {
        Rgb whole;
        std::vector<Rgb> groups;  ///< what each light group adds; empty: not kept
        void scale(float factor) {
            whole *= factor;
            for (Rgb& value : groups) value *= factor;
        }
    };
    struct Measured {
        Vec3 position, normal;
        Light falling, seen;
    };
    void look(const Vec3& origin, const Vec3& direction, double limit, int sample, Light& sum);
    /// Irradiance.
    [[nodiscard]] Light falling(const Vec3& point, const Vec3& normal);
    void add(const Rgb& value, Light& sum) const;
    /// [cd/m²] or [lx]
    [[nodiscard]] double shown(const Light& light) const;

    const Tracer& tracer_;
    TraceContext context_;
    std::unique_ptr<GroupSums> sums_;  ///< null: no light groups
    LightMixture mixture_;
    std::map<std::uint32_t, Measured> measured_;  ///< by the pin's id
};

/// Height of the eye above what is below it; nothing where nothing is below [m].
[[nodiscard]] std::optional<double> height_above_ground(const Geometry& geometry, const Vec3& eye,
                                                        const Vec3& up);

}  // namespace lightwalk
