#include "apps/session/replications.h"

#include <utility>

#include "apps/session/local_backend.h"
#include "core/math/replication_seed.h"

namespace lightwalk {

RendererOptions replication_options(RendererOptions options, int replication) {
    if (!options.ambient_file.empty())
        throw InputError(
            "answers that share an ambient file are not independent of each other, and have no "
            "interval");
    options.light.seed = replication_seed(options.light.seed, replication);
    if (replication > 0) options.warn = {};
    return options;
}

std::vector<Renderer> open_replications(const std::shared_ptr<const CompiledScene>& scene,
                                        const RendererOptions& options, int count) {
    std::vector<Renderer> renderers;
    renderers.reserve(static_cast<std::size_t>(count));
    for (int k = 0; k < count; ++k)
        renderers.emplace_back(
            std::make_unique<LocalBackend>(scene, replication_options(options, k)));
    return renderers;
}

std::optional<std::vector<RayBytes>> answer_by_all(std::span<Renderer> renderers,
                                                   const RayTask& rays) {
    std::vector<RayBytes> answers;
    for (Renderer& renderer : renderers) {
        std::optional<RayBytes> answer = renderer.finish(renderer.start(rays));
        if (!answer) return std::nullopt;
        answers.push_back(std::move(*answer));
    }
    return answers;
}

}  // namespace lightwalk
