#pragma once
// Scenes in memory for tests, made from text and ready to trace.
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/material/modifier_factories.h"
#include "core/scene/scene.h"
#include "core/trace/tracer.h"
#include "io/scene/scene_reader.h"

namespace lightwalk::test {

/// A WarningSink that stores warnings.
class Silence final : public WarningSink {
  public:
    void warn(const std::string& message) override { messages.push_back(message); }
    std::vector<std::string> messages;
};

/// Library files that a test supplies; everything else is missing.
class MemoryResources final : public Resources {
  public:
    std::map<std::string, std::string> functions;
    std::map<std::string, std::shared_ptr<const DataArray>> tables;
    std::map<std::string, std::shared_ptr<const PictureData>> pictures;
    std::map<std::string, std::shared_ptr<const SpectralPicture>> spectral_pictures;
    std::map<std::string, std::shared_ptr<const Bsdf>> bsdfs;
    std::map<std::string, std::shared_ptr<const Font>> fonts;
    std::map<std::string, std::shared_ptr<const Model>> octrees;
    std::map<std::string, std::shared_ptr<const MeshModel>> meshes;

    std::string function_file(const std::string& name) override { return find(functions, name); }
    std::shared_ptr<const DataArray> data(const std::string& name) override {
        return find(tables, name);
    }
    std::shared_ptr<const PictureData> picture(const std::string& name) override {
        return find(pictures, name);
    }
    std::shared_ptr<const SpectralPicture> spectral_picture(const std::string& name) override {
        return find(spectral_pictures, name);
    }
    std::shared_ptr<const Bsdf> bsdf(const std::string& name) override { return find(bsdfs, name); }
    std::shared_ptr<const Font> font(const std::string& name) override { return find(fonts, name); }
    std::vector<std::string> text_lines(const std::string& name) override { throw missing(name); }
    std::shared_ptr<const Model> octree(const std::string& name) override {
        return find(octrees, name);
    }
    std::shared_ptr<const MeshModel> mesh(const std::string& name) override {
        return find(meshes, name);
    }

  private:
    static MissingFile missing(const std::string& name) {
        return MissingFile("cannot find file \"" + name + "\"");
    }
    template <class Value>
    static Value find(const std::map<std::string, Value>& files, const std::string& name) {
        const auto at = files.find(name);
        if (at == files.end()) throw missing(name);
        return at->second;
    }
};

/// A scene from text, ready to trace.
struct TestScene {
    explicit TestScene(const std::string& text, RenderOptions options = exact(),
                       MemoryResources files = {})
        : resources(std::move(files)),
          scene(parse_scene(text, "test.rad", {LibraryPath(std::vector<std::string>{}), false},
                            warnings),
                modifier_factory, resources, warnings),
          tracer(scene, options, warnings),
          context(tracer, warnings) {}

    /// Options with which every light is tested for shadows and there is no sampling noise.
    static RenderOptions exact() {
        RenderOptions options;
        options.shadow_threshold = 0;
        options.source_subdivision = 0;
        options.specular_samples = 0;
        options.virtual_source_pretest = 0;
        return options;
    }

    Ray trace(const Vec3& origin, const Vec3& direction, std::uint32_t sample = 0) {
        Ray ray = tracer.primary(origin, direction, 0, RandomStream::of_pixel(7, sample, 0, 0));
        tracer.trace(ray, context);
        return ray;
    }

    Silence warnings;
    MemoryResources resources;
    Scene scene;
    Tracer tracer;
    TraceContext context;
};

}  // namespace lightwalk::test
