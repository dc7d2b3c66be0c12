#pragma once
// Scenes of files in a folder, read with what they refer to and ready to trace.
#include <array>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "io/scene/file_resources.h"
#include "io/scene/scene_reader.h"
#include "tests/temporary_folder.h"
#include "tests/test_scene.h"

namespace lightwalk::test {

/// A scene file in a folder, read and ready to trace.
class FolderScene {
  public:
    FolderScene(const TemporaryFolder& folder, const std::vector<std::string>& files,
                const RenderOptions& options = TestScene::exact())
        : library_(LibraryPath({LIGHTWALK_SOURCE "/io/library", "."}).relative_to(folder.path())),
          resources_(library_, false, warnings),
          scene_(read_scene(files, {library_, false, folder.path(), {}}, warnings),
                 modifier_factory, resources_, warnings),
          tracer_(scene_, options, warnings),
          context_(tracer_, warnings) {}

    Rgb value(const std::array<double, 6>& r) {
        Ray ray = tracer_.primary({r[0], r[1], r[2]}, normalize(Vec3{r[3], r[4], r[5]}), 0,
                                  RandomStream::of_pixel(7, 0, 0, 0));
        tracer_.trace(ray, context_);
        return ray.value;
    }

    Silence warnings;

  private:
    LibraryPath library_;
    FileResources resources_;
    Scene scene_;
    Tracer tracer_;
    TraceContext context_;
};

}  // namespace lightwalk::test
