#include "apps/walk/scene_changer.h"

#include <memory>

namespace lightwalk {

std::function<const SceneSession&(const ModelChange& change)> scene_changer(
    RenderBackend& backend) {
    return [&backend](const ModelChange& change) -> const SceneSession& {
        const std::shared_ptr<const CompiledScene> now = backend.session().shared_compiled();
        backend.change(std::make_shared<const CompiledScene>(now, change, now->warnings()));
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
