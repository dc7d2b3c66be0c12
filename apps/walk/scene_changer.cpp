#include "apps/walk/scene_changer.h"

#include <memory>
#include <utility>

namespace lightwalk {

std::function<const SceneSession&(ModelChange change)> scene_changer(RenderBackend& backend) {
    return [&backend](ModelChange change) -> const SceneSession& {
        const std::shared_ptr<const CompiledScene> now = backend.session().shared_compiled();
        backend.change(
            std::make_shared<const CompiledScene>(now, std::move(change), now->warnings()));
        return backend.session();
    };
}

}  // namespace lightwalk
