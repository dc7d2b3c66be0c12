#include "apps/walk/scene_changer.h"

namespace lightwalk {

std::function<const SceneSession&(const ModelChange& change)> scene_changer(
    RenderBackend& backend) {
    return [&backend](const ModelChange& change) -> const SceneSession& {
        backend.change_model(change);
        return backend.session();
    };
}

std::function<const SceneSession&(const std::shared_ptr<const CompiledScene>& scene)>
scene_replacer(RenderBackend& backend) {
    return [&backend](const std::shared_ptr<const CompiledScene>& scene) -> const SceneSession& {
        backend.change(scene);
        return backend.session();
    };
}

}  // namespace lightwalk
