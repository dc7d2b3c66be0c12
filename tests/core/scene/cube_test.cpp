// The scene's cube: what ambient resolution and virtual sources are measured by.
#include <doctest/doctest.h>

#include "core/model/model_builder.h"
#include "tests/test_scene.h"
#include "tests/tolerance.h"

namespace lightwalk::test {
namespace {

const std::string kBall = "void plastic p 0 0 5 .5 .5 .5 0 0\np sphere s 0 0 4 0 0 0 1\n";

std::shared_ptr<const Model> model_in_cube(const ModelCube& cube) {
    Primitive paint{PrimitiveType::plastic, kVoidIndex, "p", {}, {.5, .5, .5, 0, 0}, {}, {}};
    ModelBuilder builder;
    Primitive ball{PrimitiveType::sphere, builder.add(paint), "s", {}, {0, 0, 0, 1}, {}, {}};
    builder.add(ball);
    const std::shared_ptr<Model> model = builder.release();
    model->cube = cube;
    return model;
}

}  // namespace

TEST_CASE("a scene's cube is the smallest around its surfaces, and a little more") {
    const TestScene scene(kBall + "p sphere t 0 0 4 4 0 0 1\n");
    const SceneCube cube = scene.scene.cube();
    CHECK(cube.size == rounded(6 + 2e-5));
    CHECK(cube.origin.x == rounded(-1 - 1e-5));
    CHECK(cube.origin.y == rounded(-3 - 1e-5));
}

TEST_CASE("an octree's cube is the one that it states, also where it is an instance") {
    MemoryResources files;
    Silence silence;
    const Scene alone(model_in_cube({-2, -3, -4, 10}), modifier_factory, files, silence);
    CHECK(alone.cube().origin == Vec3{-2, -3, -4});
    CHECK(alone.cube().size == 10);
    files.octrees["ball.oct"] = model_in_cube({-2, -3, -4, 10});
    const TestScene placed("void instance i 5 ball.oct -t 100 0 0 0 0\n", TestScene::exact(),
                           files);
    CHECK(placed.scene.cube().origin.x == rounded(98 - 1e-5));
    CHECK(placed.scene.cube().size == rounded(10 + 2e-5));
}

TEST_CASE("an octree's cube stays the scene's while it holds what was added to it") {
    MemoryResources files;
    Silence silence;
    const auto scene_with = [&](double x) {
        ModelBuilder builder(growable_copy(*model_in_cube({-2, -3, -4, 10})));
        builder.add(Primitive{
            PrimitiveType::sphere, builder.modifier("p", {}), "added", {}, {x, 0, 0, 1}, {}, {}});
        return std::make_unique<const Scene>(builder.release(), modifier_factory, files, silence);
    };
    CHECK(scene_with(6.9)->cube().size == 10);
    CHECK(silence.messages.empty());
    const auto outgrown = scene_with(7.5);
    CHECK(outgrown->cube().size == rounded(9.5 + 2e-5));
    CHECK(outgrown->cube().origin.x == rounded(-1 - 1e-5));
    REQUIRE(silence.messages.size() == 1);
    CHECK(silence.messages[0].find("cube of all surfaces") != std::string::npos);
}

}  // namespace lightwalk::test
