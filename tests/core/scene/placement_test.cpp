// Instances that a scene places, whoever shares out the work.
#include <doctest/doctest.h>

#include <memory>
#include <string>

#include "tests/test_scene.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

/// Runs the parts from the last to the first.
class BackwardTeam final : public Team {
  public:
    void run(std::size_t count, FunctionRef<void(std::size_t part)> part) const override {
        while (count-- > 0) part(count);
    }
};

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
                                       BackwardTeam());
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
