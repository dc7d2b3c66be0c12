#include <utility>

#include "apps/session/compiled_scene.h"
#include "apps/session/lightwalk/picture.h"
#include "apps/session/lightwalk/renderer.h"
#include "apps/session/lightwalk/scene.h"
#include "core/cloud/cloud_frame.h"
#include "io/files/file_manifest.h"
#include "io/picture/picture.h"
#include "io/picture/tone.h"
#include "io/scene/freezing_resources.h"

namespace lightwalk {
namespace {

SceneSource source_of(const std::vector<std::string>& files) {
    SceneSource source;
    source.files = files;
    return source;
}

}  // namespace

LoadedScene::LoadedScene(const SceneSource& source, TakeWarning warn) {
    const std::shared_ptr<CompiledScene> made = read_compiled_scene(source, std::move(warn));
    made->compile();
    compiled_ = made;
}

LoadedScene::LoadedScene(const std::vector<std::string>& files, TakeWarning warn)
    : LoadedScene(source_of(files), std::move(warn)) {}

LoadedScene::Box LoadedScene::bounds() const {
    const Bounds bounds = compiled_->scene().geometry().bounds();
    return {bounds.lower, bounds.upper};
}

std::string LoadedScene::digest() const {
    return compiled_->files().digest();
}

void freeze_scene(const SceneSource& source, const std::string& path, TakeWarning warn) {
    if (source.files.empty()) throw InputError("a scene that is frozen consists of files");
    CallbackWarnings warnings(std::move(warn));
    const auto manifest = std::make_shared<ManifestRecorder>();
    CompiledScene scene(source, warnings, std::make_shared<FileRecorder>(manifest));
    if (scene.is_frozen()) throw InputError({source.files.front(), 0}, "is frozen already");
    FreezingResources library(scene.resources());
    scene.compile(library);
    std::vector<ManifestFile> files = manifest->files();
    if (scene.frozen() != nullptr) files = merged_manifest(scene.frozen()->manifest(), files);
    write_frozen_scene(path, scene.scene(), library, files);
}

void save_picture(const std::string& path, const RenderedPicture& picture,
                  const std::vector<std::string>& header) {
    write_picture(path, {picture.width, picture.height, picture.radiance}, {header}, {});
}

std::shared_ptr<const CloudOptions> default_reuse() {
    return std::make_shared<const CloudOptions>(
        CloudOptions{.audit = 0.01, .audit_limit = 0.1, .refine = 0.1});
}

}  // namespace lightwalk
