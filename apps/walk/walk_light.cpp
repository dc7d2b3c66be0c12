#include "apps/walk/walk_light.h"

#include "apps/picture_series.h"

namespace lightwalk {

CloudOptions walk_cloud_options(const RenderCommand& command) {
    CloudOptions options = command.walk->cloud;
    options.budget = 1 / command.walk->rate;
    options.samples = command.serve->edge_samples;
    return options;
}

FrameOptions walk_picture_options(const RenderCommand& command) {
    FrameOptions options = frame_options(command, {});
    options.pixels.spacing = 1;
    return options;
}

std::unique_ptr<const Tracer> without_indirect(const SceneSession& session, WarningSink& warnings) {
    RenderOptions options = session.tracer().options();
    if (options.ambient_bounces == 0) return nullptr;
    options.ambient_bounces = 0;
    return std::make_unique<const Tracer>(session.scene(), options, warnings);
}

}  // namespace lightwalk
