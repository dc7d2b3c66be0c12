#include "io/wavefront/mtl_file.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/language/primitive_text.h"
#include "io/language/tokenizer.h"

namespace lightwalk {
namespace {

std::vector<PrimitiveText> materials(const std::string& statements,
                                     const MtlPictures& pictures = {}) {
    const auto decoded = decode_mtl("newmtl m\n" + statements, "x.mtl");
    REQUIRE(decoded.size() == 1);
    const std::string text = mtl_scene(decoded[0], pictures);
    std::vector<PrimitiveText> result;
    SceneTokenizer tokens(text, "scene");
    while (tokens.peek() != SceneTokenizer::Item::end) result.push_back(read_primitive(tokens));
    CHECK(result.back().name == "m");
    return result;
}

std::string mtl_error(const std::string& text) {
    try {
        (void)decode_mtl(text, "x.mtl");
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

bool near_reals(const std::vector<double>& a, const std::vector<double>& b) {
    bool near = a.size() == b.size();
    for (std::size_t i = 0; near && i < a.size(); ++i) near = std::abs(a[i] - b[i]) < 1e-6;
    return near;
}

}  // namespace

TEST_CASE("mtl: Kd and a grey Ks are plastic, whose diffuse part is Kd") {
    const auto m = materials("Kd .4 .3 .2\nKs .2 .2 .2\nNs 198\nillum 2\n").at(0);
    CHECK(m.type_word == "plastic");
    CHECK(near_reals(m.reals, {.4 / .8, .3 / .8, .2 / .8, .2, .1}));
    CHECK(near_reals(materials("Kd .4 .3 .2\nKs .2 .2 .2\nillum 1\n").at(0).reals,
                     {.4, .3, .2, 0, 0}));
    CHECK(near_reals(materials("Kd .5\n").at(0).reals, {.5, .5, .5, 0, 0}));
}

TEST_CASE("mtl: a coloured Ks is metal") {
    const auto m = materials("Kd .1 .1 .1\nKs .7 .5 .3\nNs 0\n").at(0);
    CHECK(m.type_word == "metal");
    CHECK(near_reals({m.reals.begin(), m.reals.begin() + 3}, {.8, .6, .4}));
    CHECK(m.reals[4] == doctest::Approx(1));
}

TEST_CASE("mtl: nothing reflects more than all") {
    for (const char* text : {"Kd .8 .8 .8\nKs .5 .5 .5\n", "Kd .9 .8 .7\nKs .9 .2 .1\n",
                             "Kd 1 1 1\nKs 1 1 1\n", "Kd 0 0 0\nKs 1 1 1\n"}) {
        CAPTURE(text);
        const auto m = materials(text).at(0);
        for (std::size_t c = 0; c < 3; ++c) {
            const double color = m.reals[c], specular = m.reals[3];
            const double reflected =
                m.type_word == "metal" ? color : color * (1 - specular) + specular;
            CHECK(reflected <= 1 + 1e-6);
        }
    }
}

TEST_CASE("mtl: d dissolves, or is glass") {
    const auto parts = materials("Kd .4 .3 .2\nd .25\n");
    REQUIRE(parts.size() == 2);
    CHECK(parts[0].name == "m_opaque");
    CHECK(parts[1].type_word == "mixfunc");
    CHECK(parts[1].strings == std::vector<std::string>{"m_opaque", "void", "0.250000", "."});
    CHECK(materials("Tr .75\n").at(1).strings == parts[1].strings);
    const auto glass = materials("d .12\nNi 1.52\nTf 1 1 0\nillum 4\n").at(0);
    CHECK(glass.type_word == "glass");
    // Clear glass has a transmittance of 88% and a transmissivity of 96% (ray.pdf).
    CHECK(glass.reals[0] == doctest::Approx(0.96).epsilon(0.005));
    CHECK(glass.reals[2] == 0);
    CHECK(glass.reals[3] == 1.52);
}

TEST_CASE("mtl: Ke glows, a map multiplies Kd") {
    const auto lamp = materials("Kd .5 .5 .5\nKe 3 2 1\n").at(0);
    CHECK(lamp.type_word == "glow");
    CHECK(lamp.reals == std::vector<double>{3, 2, 1, 0});
    CHECK(decode_mtl("newmtl m\nmap_Kd -s 1 1 1 my.hdr\n", "x.mtl")[0].map_kd == "my.hdr");
    const auto mapped =
        materials("Kd .5 .5 .5\nmap_Kd my.hdr\n", {TexturePicture{"./my.hdr", 2}, {}});
    CHECK(mapped.at(0).type_word == "colorpict");
    CHECK(mapped[0].strings == std::vector<std::string>{"red", "green", "blue", "./my.hdr", ".",
                                                        "frac(Lu)*2.000000", "frac(Lv)"});
    CHECK(mapped.at(1).modifier == "m_map");
}

TEST_CASE("mtl: map_d cuts out, times d, and glass stays glass") {
    const MtlPictures pictures{{}, TexturePicture{"./leaf.png#alpha", 1}};
    const auto leaf = materials("Kd .1 .4 .1\nd .75\nmap_d leaf.png\n", pictures);
    REQUIRE(leaf.size() == 2);
    CHECK(leaf[0].name == "m_opaque");
    CHECK(leaf[1].type_word == "mixpict");
    CHECK(leaf[1].strings == std::vector<std::string>{"m_opaque", "void", "faded",
                                                      "./leaf.png#alpha", "gltf.cal", "frac(Lu)",
                                                      "frac(Lv)"});
    CHECK(leaf[1].reals == std::vector<double>{.75});
    CHECK(decode_mtl("newmtl m\nmap_d -imfchan m a.tga\n", "x.mtl")[0].map_d == "a.tga");
    CHECK(materials("d .5\nillum 4\n", pictures).back().type_word == "glass");
}

TEST_CASE("mtl: mistakes have their line") {
    CHECK(mtl_error("newmtl\n") == "x.mtl:1: newmtl without a name");
    CHECK(mtl_error("newmtl a\nKd .1 x .2\n") == "x.mtl:2: found \"x\", expected a number");
    CHECK(mtl_error("newmtl a\nKd spectral a.rfl\n").find("x.mtl:2: colours by") == 0);
    CHECK(mtl_error("Kd x\nfoo\n") == "");  // before any material
}

}  // namespace lightwalk
