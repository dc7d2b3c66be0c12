#include "apps/session/resident_scene.h"

#include <utility>

#include "apps/session/light_memo.h"
#include "parallel/executor.h"

namespace lightwalk {

ResidentScene::ResidentScene(SceneSource source)
    : source_(std::move(source)),
      premises_(std::make_shared<ScenePremises>()),
      used_(std::make_shared<Use>()) {
    source_.threads = 1;
    // While it is there oneTBB, which builds search trees, starts no threads.
    used_->alone = make_executor(ExecutorKind::tbb, 1);
    const auto warn = [used = used_](const std::string& message) {
        if (used->take)
            used->take(message);
        else
            used->warnings.push_back(message);
    };
    const std::shared_ptr<CompiledScene> scene =
        read_compiled_scene(source_, warn, std::make_shared<FileRecorder>(premises_));
    scene->compile();
    scene->set_light_memo(make_shared_light_memo());
    if (scene->frozen() != nullptr)
        throw InputError({source_.files.front(), 0},
                         "is a frozen scene, which is mapped rather than read: expected an octree");
    if (!premises_->can_hold())
        throw InputError({source_.files.front(), 0},
                         "comes in part from commands, which may say something else each time");
    scene_ = scene;
}

std::shared_ptr<const CompiledScene> ResidentScene::answer(const RendererRequest& request) const {
    const SceneSource& asked = request.source;
    const bool same = asked.files == source_.files && asked.bytes.empty() &&
                      asked.primitives.empty() && asked.library == source_.library &&
                      asked.allow_commands == source_.allow_commands &&
                      asked.allow_stale == source_.allow_stale &&
                      asked.ablation == source_.ablation && !request.when_read;
    if (!same || !premises_->answers_hold()) return nullptr;
    if (request.options.threads != 1) used_->alone.reset();
    used_->take = request.options.warn ? request.options.warn : [](const std::string&) {};
    for (const std::string& message : used_->warnings) used_->take(message);
    return scene_;
}

}  // namespace lightwalk
