#include "apps/session/cloud_pictures.h"

namespace lightwalk {

std::unique_ptr<LiveFrames> CloudPictures::make_frames(const FrameOptions& options) {
    return std::make_unique<LocalFrames>(workers_.session.tracer(), nullptr, this->options(),
                                         options, workers_.executor, warnings_);
}

/// The first frame fills the ambient cache for all; a deterministic walk has each do so, whose rays
/// find the cache frozen. False: stopped.
bool CloudPictures::prepare(const PictureRequest& request, bool first) {
    const SceneSession& session = workers_.session;
    if (!session.freezable || (!first && prepass_ != CachePrepass::deterministic)) return true;
    const CachePrepassResult filled = fill_ambient_cache(
        session.tracer(), request.camera, request.options, prepass_, *session.freezable,
        workers_.executor, workers_.contexts, workers_.stop, [](const FrameProgress&) {});
    workers_.statistics.rays += filled.rays;
    workers_.statistics.ambient += filled.ambient;
    return filled.complete;
}

}  // namespace lightwalk
