// Light groups of pictures: layers that add up to the picture, and that may be dimmed.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "apps/session/lightwalk/renderer.h"
#include "core/error.h"
#include "tests/every_material.h"
#include "tests/one_thread.h"

using namespace lightwalk;

namespace {

/// How much each kind of light of the room sends.
struct Levels {
    double lamps = 1, spot = 1, sun = 1, sky = 1;
};

/// A room with a window, and with most that can happen on the way to a lamp.
std::string many_lights(const Levels& l = {}, bool textured = true) {
    const auto light = [](const char* type, const char* name, double level, double r, double g,
                          double b, const char* more = "") {
        const bool long_list = *more != '\0';
        const int reals = !long_list ? 3 : std::string(type).find("spot") == 0 ? 7 : 4;
        return std::string(type) + ' ' + name + " 0 0 " + std::to_string(reals) + ' ' +
               std::to_string(level * r) + ' ' + std::to_string(level * g) + ' ' +
               std::to_string(level * b) + ' ' + more + '\n';
    };
    return "void " + light("light", "lamp_a", l.lamps, 10, 20, 30) +
           "void brightfunc stripes 2 .5+.4*sin(9*Px) . 0 0\nstripes " +
           light("light", "lamp_b", l.lamps, 4, 5, 6) + "void " +
           light("spotlight", "spot", l.spot, 50, 60, 70, "70 0 0 -1") + "void " +
           light("light", "sun", l.sun, 900, 800, 700) +
           "void brightfunc gradient 2 1+Dz . 0 0\ngradient " +
           light("glow", "sky", l.sky, 1, 2, 3, "0") + R"(
lamp_a polygon l1 0 0 12 -.5 -.5 3 -.5 .5 3 .5 .5 3 .5 -.5 3
lamp_b sphere l2 0 0 4 2 0 3 .2
spot sphere l3 0 0 4 -2 1 2.9 .05
sun source s 0 0 4 .3 .2 1 .5
sky source skyd 0 0 4 0 0 1 180
)" + std::string(lightwalk::test::kEveryMaterial) +
           R"(void mist fog 1 s 0 7 .05 .05 .05 .6 .6 .6 .3
fog sphere cloud 0 0 4 1 -2 1 .8
)" + std::string(textured ? "void texfunc waves 4 .2*sin(5*Px) 0 0 . 0 0\nwaves" : "void") +
           R"( plastic wavy 0 0 5 .6 .5 .4 0 0
wavy polygon table 0 0 12 -1 1 .7 1.5 1 .7 1.5 2.5 .7 -1 2.5 .7
)";
}

PictureTask room_view() {
    PictureTask task;
    task.view.position = {-3.4, -3, 1.7};
    task.view.direction = {.8, .9, -.12};
    task.width = 32;
    task.height = 24;
    return task;
}

RendererOptions room_options() {
    RendererOptions options;
    options.threads = 1;
    options.pixels.spacing = 1;
    options.light.specular_samples = 2;
    return options;
}

RendererOptions with_groups(RendererOptions options,
                            const std::vector<LightGroupPattern>& groups = {}) {
    options.light_groups = groups;
    return options;
}

RenderedPicture rendered(const std::string& scene, const RendererOptions& options,
                         const PictureTask& task = room_view()) {
    SceneSource source;
    source.bytes = scene;
    Renderer renderer(LoadedScene(source), options);
    return *renderer.finish(renderer.start(task));
}

/// Largest difference from `expected`, in shares of it; below a thousandth of the mean, of that.
double difference(const std::vector<Rgb>& found, const std::vector<Rgb>& expected) {
    REQUIRE(found.size() == expected.size());
    double mean = 0, largest = 0;
    for (const Rgb& pixel : expected)
        mean += static_cast<double>(brightness(pixel)) / static_cast<double>(expected.size());
    REQUIRE(mean > 0);
    for (std::size_t i = 0; i < found.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto a = static_cast<double>(found[i][k]),
                       b = static_cast<double>(expected[i][k]);
            largest = std::max(largest, std::abs(a - b) / std::max(b, 1e-3 * mean));
        }
    }
    return largest;
}

std::vector<Rgb> mixture(const RenderedPicture& picture, const std::vector<float>& levels) {
    REQUIRE(levels.size() == picture.layers.size());
    std::vector<Rgb> sum(picture.radiance.size());
    for (std::size_t g = 0; g < levels.size(); ++g) {
        for (std::size_t i = 0; i < sum.size(); ++i)
            sum[i] += picture.layers[g].radiance[i] * levels[g];
    }
    return sum;
}

std::vector<Rgb> sum_of_layers(const RenderedPicture& picture) {
    return mixture(picture, std::vector<float>(picture.layers.size(), 1));
}

const std::vector<LightGroupPattern> kRoomGroups{
    {"lamps", {"lamp_*"}}, {"spot", {"spot"}}, {"sun", {"sun"}}, {"sky", {"sk?"}}};

/// A picture of groups dimmed, against one of the scene with its sources dimmed.
/// @param textured  normals are tilted, for which indirect light is extrapolated by the gradient of
///                  all light
double dimming_error(const RendererOptions& options, const Levels& l, bool textured = true) {
    const RenderedPicture layers =
        rendered(many_lights({}, textured), with_groups(options, kRoomGroups));
    const std::vector<float> levels{static_cast<float>(l.lamps), static_cast<float>(l.spot),
                                    static_cast<float>(l.sun), static_cast<float>(l.sky)};
    return difference(mixture(layers, levels),
                      rendered(many_lights(l, textured), options).radiance);
}

/// Sums of some hundred rounded terms, in another order.
constexpr double kSumRounding = 1e-5;

}  // namespace

TEST_CASE("the layers of light groups add up to the picture, which is that without them" *
          lightwalk::test::about_numbers) {
    RendererOptions options = room_options();
    SUBCASE("direct light, every source tested") {
        options.light.shadow_threshold = 0;
    }
    SUBCASE("direct light, some of it guessed") {
        options.light.shadow_threshold = .3;
    }
    SUBCASE("a constant beside it") {
        options.light.ambient_value = {.1f, .2f, .3f};
    }
    SUBCASE("small sources, which are drawn") {
        options.pixels.samples = 1;
    }
    SUBCASE("several samples a pixel") {
        options.pixels.samples = 3;
    }
    SUBCASE("Russian roulette") {
        options.light.reflection_limit = -10;
        options.light.weight_limit = .01;
    }
    SUBCASE("hemispheres of each pixel, sampled where they differ") {
        options.light.ambient_bounces = 2;
        options.light.ambient_accuracy = 0;
        options.light.ambient_divisions = 16;
        options.light.ambient_super_samples = 16;
    }
    SUBCASE("cached, sampled where they differ") {
        options.light.ambient_bounces = 2;
        options.light.ambient_accuracy = .2;
        options.light.ambient_divisions = 64;
        options.light.ambient_super_samples = 32;
        SUBCASE("as it goes") {}
        SUBCASE("in rounds") {
            options.deterministic = true;
        }
        SUBCASE("weighed against the constant") {
            options.light.ambient_value = {.1f, .1f, .1f};
            options.light.ambient_weight = 8;
        }
    }
    PictureTask task = room_view();
    if (options.light.ambient_bounces > 0) {
        const int smaller = options.light.ambient_accuracy > 0 ? 4 : 2;
        task.width /= smaller;
        task.height /= smaller;
    }
    const RenderedPicture plain = rendered(many_lights(), options, task);
    const RenderedPicture layered = rendered(many_lights(), with_groups(options), task);
    CHECK(plain.layers.empty());
    CHECK(layered.radiance == plain.radiance);
    CHECK(layered.distance == plain.distance);
    CHECK(layered.rays == plain.rays);
    CHECK(difference(sum_of_layers(layered), plain.radiance) < kSumRounding);
    for (const RenderedLayer& layer : layered.layers) {
        CAPTURE(layer.name);
        CHECK(*std::max_element(layer.radiance.begin(), layer.radiance.end(),
                                [](const Rgb& a, const Rgb& b) { return a.g < b.g; }) != Rgb{});
    }
}

TEST_CASE("layers are the same bytes with any number of threads") {
    RendererOptions options = room_options();
    options.light.ambient_bounces = 1;
    options.light.ambient_divisions = 64;
    options.deterministic = true;
    const RenderedPicture one = rendered(many_lights(), with_groups(options));
    options.threads = 3;
    const RenderedPicture three = rendered(many_lights(), with_groups(options));
    REQUIRE(one.layers.size() == three.layers.size());
    for (std::size_t g = 0; g < one.layers.size(); ++g)
        CHECK(one.layers[g].radiance == three.layers[g].radiance);
}

TEST_CASE("a mixture of dimmed layers is the picture of the dimmed sources") {
    RendererOptions options = room_options();
    options.light.shadow_threshold = 0;
    bool textured = true;
    SUBCASE("direct light") {}
    SUBCASE("indirect light that each pixel samples") {
        textured = false;
        options.light.ambient_lights = 0;  // else chosen by what they may bring
        options.light.ambient_bounces = 1;
        options.light.ambient_accuracy = 0;
        options.light.ambient_divisions = 64;
        options.light.ambient_super_samples = 0;
    }
    for (const Levels& l :
         {Levels{0, 1, 1, 1}, Levels{1, 0, 0, .5}, Levels{2, .25, .5, 0}, Levels{.1, 3, 1.5, 8}}) {
        CAPTURE(l.lamps);
        CHECK(dimming_error(options, l, textured) < kSumRounding);
    }
}

TEST_CASE("with cached indirect light a mixture is that of the dimmed sources at the same cache") {
    RendererOptions options = room_options();
    options.light.shadow_threshold = 0;
    options.light.ambient_bounces = 1;
    options.light.ambient_accuracy = .2;
    options.light.ambient_divisions = 144;
    options.light.ambient_super_samples = 0;
    options.deterministic = true;
    // By one factor values lie where they did: what decides are relations.
    CHECK(dimming_error(options, {4, 4, 4, 4}) < kSumRounding);
    // By several, elsewhere: what differs is how far values are from converged ones.
    CHECK(dimming_error(options, {1, 1, .25, 2}) < .5);
}
