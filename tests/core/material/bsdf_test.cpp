// BSDF, aBSDF and WGMDfunc: energy, sides, shadows and proxies.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <vector>

#include "tests/core/material/bsdf_files.h"
#include "tests/core/material/surroundings.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

const std::string kBsdf = "void BSDF m 6 0 a.xml 0 1 0 . 0 0\n",
                  kApertured = "void aBSDF m 5 a.xml 0 1 0 . 0 0\n";
const std::string kSun = "void light sun 0 0 3 1e4 1e4 1e4\nsun source zenith 0 0 4 0 0 1 1\n";
const std::string kFloor =
    "void plastic grey 0 0 5 .5 .5 .5 0 0\n"
    "grey polygon floor 0 0 12 -9 -9 -1 9 -9 -1 9 9 -1 -9 9 -1\n";

}  // namespace

TEST_CASE("furnace: BSDFs that lose nothing show radiance 1, sampled or left to ambient light") {
    // Half is Lambertian, half a peak; as much is reflected as transmitted.
    const auto bsdf = bsdf_of(quarter(0.25 / kPi, 0.25), quarter(0.25 / kPi, 0.25));
    for (const std::string& material : {kBsdf, kApertured}) {
        for (const double threshold : {0.0, 0.9}) {
            for (const double samples : {0.0, 0.5, 1.0, 8.0}) {
                for (const Vec3& direction : {Vec3{0.6, 0.3, -1}, Vec3{0.1, -0.4, 1}}) {
                    RenderOptions options = deep();
                    options.specular_threshold = threshold;
                    options.specular_samples = samples;
                    TestScene scene(kFurnace + material + sheet("pane"), options, with_file(bsdf));
                    CAPTURE(material);
                    CAPTURE(threshold);
                    CAPTURE(samples);
                    const Ray ray = scene.trace(-direction, direction);
                    CHECK(relative_error(ray.value.g, 1) < 1e-4);
                }
            }
        }
    }
}

TEST_CASE("furnace: the limit of weights makes a BSDF's samples fewer, not darker") {
    const auto bsdf = bsdf_of(quarter(0, 0.25), quarter(0, 0.75));
    RenderOptions options = deep();
    options.specular_threshold = 0;
    options.specular_samples = 64;
    options.weight_limit = 0.02;
    TestScene scene(kFurnace + kBsdf + sheet("pane"), options, with_file(bsdf));
    CHECK(relative_error(scene.trace({-0.6, -0.3, 1}, {0.6, 0.3, -1}).value.g, 1) < 1e-4);
}

TEST_CASE("a BSDF stops the light of sources, an aBSDF passes its straight part") {
    const AngleBasis full = *klems_basis("LBNL/Klems Full");
    BsdfMatrix peak{full, full, std::vector<float>(full.size() * full.size(), 0.0f), {}};
    for (std::size_t i = 0; i < full.size(); ++i)
        peak.y[i * full.size() + i] = static_cast<float>(0.4 / full.solid_angle(i));
    const auto bsdf = bsdf_of(peak, std::nullopt);
    const auto floor_under = [&](const std::string& pane) {
        TestScene scene(kSun + kFloor + pane, TestScene::exact(), with_file(bsdf));
        return static_cast<double>(scene.trace({0.1, 0.2, -0.5}, {0, 0, -1}).value.g);
    };
    const double open = floor_under("");
    CHECK(open > 0);
    CHECK(floor_under(kBsdf + sheet("pane")) == 0);
    CHECK(floor_under(kApertured + sheet("pane")) == doctest::Approx(0.4 * open).epsilon(1e-4));
}

TEST_CASE("a BSDF of a thickness is there for scattered rays of its own side only") {
    const auto bsdf = bsdf_of(std::nullopt, quarter(0.5 / kPi));
    const std::string proxy = "void BSDF m 6 .1 a.xml 0 1 0 . 0 0\n" + sheet("proxy");
    TestScene scene(kSun + kFloor + proxy, TestScene::exact(), with_file(bsdf));
    TestScene bare(kSun + kFloor, TestScene::exact());
    for (const Vec3& from : {Vec3{0.1, 0.2, 1}, Vec3{0.1, 0.2, -0.5}})
        CHECK(scene.trace(from, {0.1, 0.1, -1}).value == bare.trace(from, {0.1, 0.1, -1}).value);
    // Ambient rays from above meet it: the surface above sees its reflected light.
    const std::string mirror_floor =
        "void plastic white 0 0 5 1 1 1 0 0\n"
        "white polygon top 0 0 12 -9 -9 2 -9 9 2 9 9 2 9 -9 2\n";
    RenderOptions options = TestScene::exact();
    options.ambient_bounces = 1;
    options.ambient_divisions = 1024;
    options.ambient_super_samples = 0;
    options.ambient_accuracy = 0;
    TestScene room(
        "void glow g 0 0 4 1 1 1 0\ng source up 0 0 4 0 0 1 180\n" + proxy + mirror_floor, options,
        with_file(bsdf));
    CHECK(room.trace({0.1, 0.2, 1.5}, {0, 0, 1}).value.g < 1e-3f);
}

TEST_CASE("a BSDF's lobe that ends beside the direction counts with its Lambertian part, or not") {
    // What rtrace shows of such a tree: of four values about e those without a lobe count as
    // nothing, and the mean is never less than the Lambertian part.
    std::vector<float> values(64, 0.1f);
    for (std::size_t i = 0; i < 16; ++i) values[i] = 0.3f;  // incident sines above a half
    BsdfTree tree{TensorTree(3), {}, {}};
    tree.y.set_root(tree.y.add_grid(values, 2));
    RenderOptions options = TestScene::exact();
    options.specular_samples = 1;
    options.specular_threshold = 1;
    TestScene scene(kSun + kBsdf + sheet("pane"), options, with_file(bsdf_of(std::nullopt, tree)));
    const auto seen = [&](const Vec3& direction, std::uint32_t sample) {
        return static_cast<double>(scene.trace(-direction, direction, sample).value.g);
    };
    const double coarse = seen({0.02, 0, -1}, 0);
    std::array<int, 4> counts{};
    for (std::uint32_t sample = 0; sample < 400; ++sample) {
        const double value = seen({0.5, 0.2, -1}, sample) / coarse;
        const std::array<double, 4> possible{1, 1.5, 2.25, 3};
        std::size_t nearest = 0;
        for (std::size_t i = 1; i < 4; ++i) {
            if (std::abs(value - possible[i]) < std::abs(value - possible[nearest])) nearest = i;
        }
        CHECK(value == doctest::Approx(possible[nearest]).epsilon(1e-4));
        ++counts[nearest];
    }
    for (const int count : counts) CHECK(count > 5);
}

TEST_CASE("a BSDF whose up runs along the normal is black, and says so") {
    TestScene scene(kFurnace + "void BSDF m 6 0 a.xml 0 0 1 . 0 0\n" + sheet("pane"), deep(),
                    with_file(bsdf_of(quarter(0.3), std::nullopt)));
    CHECK(scene.trace({0, 0, 1}, {0.1, 0, -1}).value == Rgb{});
    REQUIRE_FALSE(scene.warnings.messages.empty());
    CHECK(scene.warnings.messages.back().find("illegal orientation vector") != std::string::npos);
}

TEST_CASE("BSDF: a wrong number of real arguments is refused where it stands") {
    CHECK_THROWS_WITH_AS(TestScene("void BSDF m 6 0 a.xml 0 0 1 . 0 4 1 1 1 1\n" + sheet("pane"),
                                   deep(), with_file(bsdf_of(quarter(0.3), std::nullopt))),
                         doctest::Contains("test.rad:1: bad number of arguments for BSDF \"m\""),
                         InputError);
    CHECK_THROWS_AS(TestScene("void aBSDF m 4 a.xml 0 0 1 0 0\n" + sheet("pane"), deep()),
                    InputError);
}

TEST_CASE("furnace: WGMDfunc of white parts shows radiance 1, smooth or rough") {
    for (const char* material :
         {"void WGMDfunc m 13 void .3 0 0 void .4 0 0 void 1 0 0 . 0 9 .3 .3 .3 .3 .3 .3 0 0 0\n",
          "void WGMDfunc m 13 void .015 0 0 void .4 0 0 void 1 0 0 . 0 9 .3 .3 .3 .3 .3 .3 .285 "
          ".285 .285\n",
          "void WGMDfunc m 13 void .3 .1 .2 void .4 .2 .1 void 1 0 0 . 0 9 .1 .1 .1 .1 .1 .1 .2 .2 "
          ".2\n"}) {
        for (const Vec3& direction : {Vec3{0.6, 0.3, -1}, Vec3{0.1, -0.4, 1}}) {
            TestScene scene(kFurnace + material + sheet("pane"), deep());
            CAPTURE(std::string(material));
            const Ray ray = scene.trace(-direction, direction);
            CHECK(relative_error(ray.value.g, 1) < 1e-5);
        }
    }
}

TEST_CASE("WGMDfunc: an unknown modifier of a part is refused") {
    CHECK_THROWS_WITH_AS(
        TestScene(
            "void WGMDfunc m 13 lost .3 0 0 void .4 0 0 void 1 0 0 . 0 9 0 0 0 0 0 0 0 0 0\n" +
                sheet("pane"),
            deep()),
        doctest::Contains("test.rad:1: WGMDfunc \"m\": undefined modifier \"lost\""), InputError);
}
