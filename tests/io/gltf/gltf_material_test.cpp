#include "io/gltf/gltf_material.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "io/language/primitive_text.h"
#include "io/language/tokenizer.h"

namespace lightwalk {
namespace {

std::vector<PrimitiveText> parsed(const std::string& text) {
    std::vector<PrimitiveText> result;
    SceneTokenizer tokens(text, "scene");
    while (tokens.peek() != SceneTokenizer::Item::end) result.push_back(read_primitive(tokens));
    return result;
}

std::vector<PrimitiveText> written(GltfMaterial material, const GltfPictures& pictures = {},
                                   bool is_light = false) {
    material.name = "m";
    auto result = parsed(gltf_material_scene(material, pictures, is_light));
    CHECK(result.back().name == "m");
    return result;
}

bool near_all(const std::vector<double>& a, const std::vector<double>& b) {
    bool near = a.size() == b.size();
    for (std::size_t i = 0; near && i < a.size(); ++i) near = std::abs(a[i] - b[i]) < 1e-6;
    return near;
}

}  // namespace

TEST_CASE("gltf material: metallic is metal, else plastic with 4 % specular") {
    GltfMaterial m;
    m.base = {.8, .6, .4};
    m.roughness = .5;
    CHECK(written(m).at(0).type_word == "metal");
    CHECK(near_all(written(m).at(0).reals, {.8, .6, .4, 1, .25}));
    m.metallic = 0;
    CHECK(written(m).at(0).type_word == "plastic");
    CHECK(near_all(written(m).at(0).reals, {.8, .6, .4, .04, .25}));
    m.unlit = true;
    CHECK(near_all(written(m).at(0).reals, {.8, .6, .4, 0, .25}));
}

TEST_CASE("gltf material: nothing reflects more than all") {
    for (double metallic = 0; metallic <= 1; metallic += 0.125) {
        CAPTURE(metallic);
        GltfMaterial m;
        m.metallic = metallic;
        const PrimitiveText text = written(m).at(0);
        for (std::size_t c = 0; c < 3; ++c) {
            const double color = text.reals[c], specular = text.reals[3];
            CHECK((text.type_word == "metal" ? color : color * (1 - specular) + specular) <=
                  1 + 1e-9);
        }
    }
}

TEST_CASE("gltf material: emission in cd/m² is radiance times 179") {
    GltfMaterial m;
    m.emitted = {179, 358, 0};
    CHECK(written(m).at(0).type_word == "glow");
    CHECK(near_all(written(m).at(0).reals, {1, 2, 0, 0}));
    CHECK(written(m, {}, true).at(0).type_word == "light");
    m.emitted_texture = GltfTexture{};
    GltfPictures pictures;
    pictures.emitted = TexturePicture{"./e.png"};
    const auto mixed = written(m, pictures);
    REQUIRE(mixed.size() == 4);
    CHECK(mixed[0].name == "m_dark");
    CHECK(mixed[2].type_word == "glow");
    CHECK(mixed[2].modifier == mixed[1].name);
    CHECK(mixed[3].type_word == "mixpict");
    CHECK(mixed[3].strings[0] == "m_lit");
    CHECK(mixed[3].strings[1] == "m_dark");
}

TEST_CASE("gltf material: alpha lets through what lies behind") {
    GltfMaterial m;
    m.opacity = .25;
    CHECK(written(m).size() == 1);  // opaque, whatever the number
    m.alpha = GltfMaterial::Alpha::blend;
    CHECK(written(m).at(1).strings ==
          std::vector<std::string>{"m_opaque", "void", "0.250000", "."});
    m.alpha = GltfMaterial::Alpha::mask;
    CHECK(written(m).at(1).strings[2] == "0.000000");
    GltfPictures pictures;
    pictures.base = TexturePicture{"./b.png"};
    pictures.opacity = TexturePicture{"./b.png#alpha", 1, TextureWrap::clamp, TextureWrap::mirror};
    m.opacity = 1;
    const auto cut = written(m, pictures);
    CHECK(cut.back().type_word == "mixpict");
    CHECK(cut.back().strings ==
          std::vector<std::string>{"m_opaque", "void", "cutout", "./b.png#alpha", "gltf.cal",
                                   "if(Lu,if(1-Lu,Lu,1),0)", "(1-2*abs(frac(Lv/2)-.5))"});
    CHECK(near_all(cut.back().reals, {.5}));
}

TEST_CASE("gltf material: transmission is glass, trans or a dielectric") {
    GltfMaterial m;
    m.metallic = m.roughness = 0;
    m.transmission = 1;
    const PrimitiveText glass = written(m).at(0);
    CHECK(glass.type_word == "glass");
    CHECK(glass.reals[0] == doctest::Approx(1).epsilon(0.005));  // 92 % of clear glass pass
    CHECK(glass.reals[3] == 1.5);
    m.transmission = .5;
    CHECK(near_all(written(m).at(0).reals, {1, 1, 1, .04, 0, .5, 1}));
    CHECK(written(m).at(0).type_word == "trans");
    m.transmission = 1;
    m.thickness = 1;
    m.attenuation = {.25, 1, 1};
    m.attenuation_distance = 2;
    CHECK(written(m).at(0).type_word == "dielectric");
    CHECK(near_all(written(m).at(0).reals, {.5, 1, 1, 1.5, 0}));
}

TEST_CASE("gltf light: candelas and lux") {
    GltfLight light;
    light.intensity = {179, 179, 179};
    const auto ball = parsed(gltf_light_scene(light, "l"));
    REQUIRE(ball.size() == 2);
    const double radius = ball[1].reals[3];
    CHECK(ball[0].reals[0] * 3.14159265 * radius * radius == doctest::Approx(1));
    light.kind = GltfLight::Kind::directional;
    light.direction = {0, 0, -1};
    const auto sun = parsed(gltf_light_scene(light, "l"));
    const double sine = std::sin(sun[1].reals[3] / 2 * 3.14159265 / 180);
    CHECK(sun[1].type_word == "source");
    CHECK(sun[1].reals[2] == 1);
    CHECK(sun[0].reals[0] * 3.14159265 * sine * sine == doctest::Approx(1));
    light.kind = GltfLight::Kind::spot;
    light.angle = 0.5;
    CHECK(parsed(gltf_light_scene(light, "l")).at(0).reals[3] == doctest::Approx(57.29578));
}

}  // namespace lightwalk
