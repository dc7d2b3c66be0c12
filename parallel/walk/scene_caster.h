#pragma once
// The cloud's rays, cast into a scene by the tracer.
#include <span>
#include <vector>

#include "core/cloud/sparse_hits.h"
#include "core/cloud/visibility_probe.h"
#include "core/view/pixel_rays.h"
#include "parallel/frame_options.h"
#include "parallel/pixel_tracer.h"
#include "parallel/stop_flag.h"
#include "parallel/walk/frame_caster.h"
#include "parallel/worker_contexts.h"

namespace lightwalk {

/// The rays of a picture's sample: of sample 0 its own, of the others those of pictures with other
/// seeds; jittered even where the picture is not, or they would all be the same. The camera and the
/// options' `previous` must outlive them.
[[nodiscard]] PixelRays rays_of_sample(const Camera& camera, const FrameOptions& options,
                                       int sample);

/// What frames are for.
enum class FrameUse {
    picture,  ///< each is as true as the cloud can make it
    resting,  ///< of a walk that somebody steers, whose view rests: its points will be shown from
              ///< elsewhere, and traced pixels tell their patterns (VisibilityProbe::Needs)
    passing,  ///< of such a walk, seen for a moment only: rays are not jittered either, as jagged
              ///< edges that change from frame to frame crawl
};

/// @param budget  see CloudOptions: only frames of a steered walk have one [s]
[[nodiscard]] constexpr FrameUse use_of_frame(double budget, bool rests) {
    if (!(budget > 0)) return FrameUse::picture;
    return rests ? FrameUse::resting : FrameUse::passing;
}

/// The camera of one frame, and its rays: those that a picture with the same options has, to the
/// bit, or for a frame that is seen for a moment those through the middles of pixels.
class SceneCaster final : public FrameCaster {
  public:
    /// All but the camera must outlive this.
    /// @param mixture  of the contexts' light groups, where they have some
    SceneCaster(const Tracer& tracer, const VisibilityProbe& visibility, const Camera& camera,
                const FrameOptions& options, WorkerContexts& contexts, const StopFlag& stop,
                FrameUse use = FrameUse::picture, const LightMixture* mixture = nullptr);
    SceneCaster(const SceneCaster&) = delete;
    SceneCaster& operator=(const SceneCaster&) = delete;

    /// What the pixels' first rays see.
    void probe(std::span<const PixelPlace> places, const ProbeOptions& options,
               std::span<PixelVisibility> visibility, int worker) override;
    void trace(std::span<const PixelPlace> places, std::span<TracedPixel> pixels, int sample,
               int worker) override;
    [[nodiscard]] PixelGroups groups(int worker) const override;
    [[nodiscard]] const Camera& camera() const override { return camera_; }
    [[nodiscard]] std::uint64_t traced() const override { return contexts_.rays().total(); }

  private:
    /// Of one worker.
    struct Scratch {
        std::vector<PixelPlace> places;
        std::vector<RaySegment> segments;
        std::vector<Hit> hits;
        SparseHits sparse;
        VisibilityProbe::Scratch ways;
        std::vector<PixelVisibility> visibility;
        std::vector<PixelValue> values;
        std::vector<PixelHit> pixel_hits;
        std::vector<Rgb> groups, mirrored_groups;  ///< by pixel, then light group
    };

    /// The rays of pixels: of perspective views that nothing blurs, which is faster, and of all.
    void set_out_plainly(const PixelRays& rays, std::span<const PixelPlace> places,
                         std::span<RaySegment> segments,
                         std::span<PixelVisibility> visibility) const;
    void set_out_anyhow(const PixelRays& rays, std::span<const PixelPlace> places,
                        std::span<RaySegment> segments,
                        std::span<PixelVisibility> visibility) const;
    void find_hits(const PixelRays& rays, int spacing, std::span<const PixelPlace> places,
                   std::span<PixelVisibility> visibility, Scratch& scratch) const;
    void probe_along(const PixelRays& rays, int spacing, const VisibilityProbe::Needs& needs,
                     std::span<const PixelPlace> places, std::span<PixelVisibility> visibility,
                     Scratch& scratch) const;

    const Tracer& tracer_;
    const VisibilityProbe& probe_;
    Camera camera_;
    FrameOptions options_;
    PixelRays rays_;  ///< of sample 0
    WorkerContexts& contexts_;
    const StopFlag& stop_;
    bool steered_;  ///< not FrameUse::picture
    const LightMixture* mixture_;
    std::vector<Scratch> scratch_;
};

}  // namespace lightwalk
