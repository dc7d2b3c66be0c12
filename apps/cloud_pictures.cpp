#include "apps/cloud_pictures.h"

#include "apps/interrupt.h"

namespace lightwalk {

std::unique_ptr<LiveFrames> CloudPictures::make_frames(const FrameOptions& options) {
    return std::make_unique<LocalFrames>(session_.tracer(), nullptr, this->options(), options,
                                         executor_, warnings());
}

/// The first frame fills the ambient cache for all; with --deterministic each frame does, whose
/// rays find the cache frozen. False: interrupted.
bool CloudPictures::prepare(const PictureRequest& request, bool first) {
    if (!session_.freezable || (!first && prepass_ != CachePrepass::deterministic)) return true;
    const CachePrepassResult played = fill_ambient_cache(
        session_.tracer(), request.camera, request.options, prepass_, *session_.freezable,
        executor_, contexts_, interrupt_flag(), [](const FrameProgress&) {});
    statistics().rays += played.rays;
    statistics().ambient += played.ambient;
    return played.complete;
}

}  // namespace lightwalk
