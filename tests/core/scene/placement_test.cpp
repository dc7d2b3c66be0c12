// Instances that a scene places, whoever shares out the work.
#include <doctest/doctest.h>

#include <memory>
#include <string>

#include "tests/backward_task_runner.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

/// Scenes that place one ball of 1 m.
struct Row {
    explicit Row(const std::string& text) {
        const SceneReadOptions nothing_read{LibraryPath(std::vector<std::string>{}), false};
        resources.octrees["ball.oct"] =
            parse_scene("void sphere s 0 0 4 0 0 0 1\n", "ball.rad", nothing_read, warnings);
        model = parse_scene(text, "row.rad", nothing_read, warnings);
    }
    [[nodiscard]] std::unique_ptr<Scene> build() {
        return std::make_unique<Scene>(model, modifier_factory, resources, warnings,
                                       BackwardTaskRunner());
    }
    Silence warnings;
    MemoryResources resources;
    std::shared_ptr<const Model> model;
};

}  // namespace

TEST_CASE("thousands of instances stand where their words say") {
    constexpr int kBalls = 3000;
    std::string text;
    for (int i = 0; i < kBalls; ++i)
        text += "void instance b 5 ball.oct -t " + std::to_string(3 * i) + " 0 0 0 0\n";
    Row row(text);
    const std::unique_ptr<Scene> scene = row.build();
    for (int i = 0; i < kBalls; i += 7) {
        const Hit hit = scene->geometry().intersect({{3.0 * i, -5, 0}, {0, 1, 0}, 100});
        CHECK(hit.t == doctest::Approx(4));
        const Hit between = scene->geometry().intersect({{3.0 * i + 1.5, -5, 0}, {0, 1, 0}, 100});
        CHECK_FALSE(between.exists());
    }
}

TEST_CASE("of many wrong transforms the first is told") {
    std::string text;
    for (int i = 1; i <= 3000; ++i) {
        const bool wrong = i == 700 || i == 705 || i == 2900;
        text += std::string("void instance b 5 ball.oct -t ") + (wrong ? "x" : "1") + " 0 0 0 0\n";
    }
    Row row(text);
    CHECK_THROWS_WITH_AS(static_cast<void>(row.build()),
                         doctest::Contains("row.rad:700: instance \"b\": bad transform at \"-t\""),
                         InputError);
}

/// Remembers what it is told to prepare.
class PreparedResources final : public Resources {
  public:
    explicit PreparedResources(MemoryResources& source) : source_(source) {}
    std::string function_file(const std::string& name) override {
        return source_.function_file(name);
    }
    std::shared_ptr<const DataArray> data(const std::string& name) override {
        return source_.data(name);
    }
    std::shared_ptr<const PictureData> picture(const std::string& name) override {
        return source_.picture(name);
    }
    std::shared_ptr<const SpectralPicture> spectral_picture(const std::string& name) override {
        return source_.spectral_picture(name);
    }
    std::shared_ptr<const Bsdf> bsdf(const std::string& name) override {
        return source_.bsdf(name);
    }
    std::shared_ptr<const Font> font(const std::string& name) override {
        return source_.font(name);
    }
    std::vector<std::string> text_lines(const std::string& name) override {
        return source_.text_lines(name);
    }
    std::shared_ptr<const Model> octree(const std::string& name) override {
        asked.push_back(name);
        return source_.octree(name);
    }
    std::shared_ptr<const MeshModel> mesh(const std::string& name) override {
        return source_.mesh(name);
    }
    void prepare(std::span<const NamedFile> files, const TaskRunner&) override {
        for (const NamedFile& file : files) asked.push_back("soon " + file.name);
    }
    std::vector<std::string> asked;  ///< octrees, and all that is to be prepared

  private:
    MemoryResources& source_;
};

TEST_CASE("a scene tells which files it will ask for, each once, before it asks") {
    Row row(
        "void instance a 1 ball.oct 0 0\n"
        "void instance b 1 other.oct 0 0\n"
        "void instance c 1 ball.oct 0 0\n"
        "void colorpict unused 7 red green blue unused.hdr . u v 0 0\n");
    row.resources.octrees["other.oct"] = row.resources.octrees["ball.oct"];
    PreparedResources resources(row.resources);
    const Scene scene(row.model, modifier_factory, resources, row.warnings);
    CHECK(resources.asked ==
          std::vector<std::string>{"soon ball.oct", "soon other.oct", "ball.oct", "other.oct"});
}
