#include "apps/renderer_request.h"

namespace lightwalk {

SceneSource scene_source(const CommonOptions& common) {
    SceneSource source;
    source.files = common.scene_files;
    source.allow_commands = common.allow_commands;
    source.allow_stale = common.stale_allowed;
    source.threads = common.workers;
    source.ablation = common.ablation;
    source.trim_heap = true;  // the process is all ours
    return source;
}

RendererRequest renderer_request(const CommonOptions& common, const RenderSettings& settings,
                                 const std::string& history, StderrWarnings& warnings) {
    RendererRequest request;
    request.source = scene_source(common);
    request.scene_from = common.ranks.scene_from;
    request.history = history;
    RendererOptions& options = request.options;
    options.light = settings.light;
    options.ambient_file = settings.ambient_file;
    options.threads = common.workers;
    options.executor = common.executor;
    options.stop = &interrupt_flag();
    options.warn = [&warnings](const std::string& message) { warnings.warn(message); };
    return request;
}

RendererRequest renderer_request(const RenderCommand& command, StderrWarnings& warnings) {
    RendererRequest request =
        renderer_request(command.common, command.settings, command.history, warnings);
    RendererOptions& options = request.options;
    options.pixels = command.pixels;
    options.use_distances = !command.depth.empty();
    options.cache_prepass = command.prepass;
    options.deterministic = command.deterministic;
    if (command.walk && command.walk->reuse) {
        CloudOptions cloud = command.walk->cloud;
        if (command.serve) {
            cloud.budget = 1 / command.walk->rate;
            cloud.samples = command.serve->edge_samples;
        } else {
            options.frames = walk_length(*command.walk);
        }
        options.reuse = std::make_shared<const CloudOptions>(cloud);
        request.projectors = command.walk->projectors;
    }
    options.steered = command.serve.has_value();
    return request;
}

}  // namespace lightwalk
