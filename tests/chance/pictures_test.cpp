// Random pictures against stored means: lobes, mist, lamps' places, lens, shutter, indirect light,
// places in pixels, pixels that a walk's frame takes from the frames before it. Each test finds
// three errors that are planted in it.
//
// LIGHTWALK_UPDATE_MEANS=1 lightwalk_tests --source-file='*/chance/*' makes means.txt anew, which
// is right after a change that is meant to change pictures, and after no other.
#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>
#include <map>

#include "core/view/pixel_rays.h"
#include "parallel/walk/cloud_frames.h"
#include "parallel/walk/scene_caster.h"
#include "tests/chance/z_test.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

constexpr int kSide = 8;  ///< pixels
constexpr int kStoredSamples = 20000;
constexpr std::uint64_t kStoredSeed = 1 << 20, kTestSeed = 1;
const std::string kMeans = std::string(LIGHTWALK_SOURCE) + "/tests/chance/means.txt";

const std::string kCheckered =
    "void brightfunc squares 2 if(sin(4*Px)*sin(4*Py),1,.4) . 0 0\n"
    "squares plastic tiles 0 0 5 .7 .6 .5 0 0\n"
    "tiles polygon floor 0 0 12 -9 -9 0 9 -9 0 9 9 0 -9 9 0\n";
const std::string kSky =
    "void brightfunc shape 2 1.2+Dx*Dz . 0 0\nshape glow air 0 0 4 1 1 1 0\n"
    "air source sky 0 0 4 0 0 1 180\n";
const std::string kPanel =
    "void light lamp 0 0 3 9 9 9\nlamp polygon panel 0 0 12 -1 -1 3 -1 1 3 1 1 3 1 -1 3\n";
const std::string kBoard =
    "void plastic card 0 0 5 .2 .2 .2 0 0\n"
    "card polygon board 0 0 12 -.6 -.3 1 .5 -.3 1 .5 .9 1 -.6 .9 1\n";

/// What is drawn, and how.
struct ChanceCase {
    std::string name, text;
    RenderOptions options = TestScene::exact();
    PixelOptions pixels;
    bool moves = false;
    bool reuses = false;  ///< it is the third frame of a walk
    int samples = 600;    ///< of each pixel in the test
};

ChanceCase still(const std::string& name, const std::string& text, int samples) {
    ChanceCase c;
    c.name = name;
    c.text = text;
    c.pixels.jitter = 0;
    c.samples = samples;
    return c;
}

std::vector<ChanceCase> all_cases() {
    std::vector<ChanceCase> all;
    all.push_back(still("rough-lobe",
                        kSky + "void metal brushed 0 0 5 .8 .7 .6 .9 .15\n"
                               "brushed polygon floor 0 0 12 -9 -9 0 9 -9 0 9 9 0 -9 9 0\n",
                        400));
    all.back().options.specular_samples = 1;
    all.back().options.specular_threshold = 0;
    all.push_back(still("rough-transmission",
                        kSky +
                            "void trans frosted 0 0 7 .9 .9 .9 0 .2 .8 .9\n"
                            "frosted polygon pane 0 0 12 -9 -1 -9 9 -1 -9 9 -1 9 -9 -1 9\n" +
                            kCheckered + kPanel,
                        600));
    all.back().options.specular_samples = 1;
    all.back().options.specular_threshold = 0;
    all.push_back(still("mist",
                        "void light lamp 0 0 3 99 99 99\nlamp sphere bulb 0 0 4 .4 .2 1.8 .1\n"
                        "void mist fog 1 bulb 0 7 .2 .2 .2 .8 .8 .8 .3\n"
                        "fog sphere cloud 0 0 4 0 0 1 2.5\n" +
                            kCheckered,
                        300));
    all.back().options.scatter_step = .7;
    all.push_back(still("jitter", kCheckered + kPanel + kBoard, 800));
    all.back().options.source_jitter = 1;
    all.push_back(still("lens", kCheckered + kSky + kPanel, 800));
    all.back().pixels.aperture = .4;
    all.push_back(still("shutter", kCheckered + kSky + kPanel, 800));
    all.back().pixels.motion = .8;
    all.back().moves = true;
    all.push_back(still("ambient", kCheckered + kSky + kBoard, 200));
    all.back().options.ambient_bounces = 2;
    all.back().options.ambient_accuracy = 0;
    all.back().options.ambient_divisions = 9;
    all.back().options.ambient_super_samples = 0;
    all.push_back(still("pixel-samples", kCheckered + kPanel + kBoard, 300));
    all.back().pixels.samples = 4;
    all.push_back(still("pixel-jitter", kCheckered + kPanel + kBoard, 800));
    all.back().pixels.jitter = 1;
    all.push_back(still("reuse", kCheckered + kPanel + kBoard, 800));
    all.back().options.source_jitter = 1;
    all.back().reuses = true;
    return all;
}

View chance_view(double x) {
    View view;
    view.position = {x, -3.2, 2.2};
    view.direction = {-.1 * x, .85, -.6};
    view.up = {0, 0, 1};
    view.horizontal = view.vertical = 50;
    return view;
}

/// What is done to the samples of a picture.
enum class Planted { nothing, pdf, cosine, stale_seed };

/// The third frame of a walk, from points that the first two have left: green, row by row.
std::vector<double> reused_frame(const TestScene& scene, const PixelOptions& pixels,
                                 std::uint64_t seed) {
    const StopFlag never;
    const auto executor = make_executor(ExecutorKind::serial, 1);
    Silence warnings;
    WorkerContexts contexts(scene.tracer, warnings, 1);
    const VisibilityProbe visibility(scene.tracer);
    FrameOptions options;
    options.width = options.height = kSide;
    options.pixels = pixels;
    options.seed = seed;
    CloudFrames frames(kSide, kSide, {});
    std::vector<double> values;
    for (const double x : {0.0, .03, .06}) {
        SceneCaster caster(scene.tracer, visibility, Camera(chance_view(x)), options, contexts,
                           never, FrameUse::picture);
        const CloudFrame& frame = frames.draw(caster.camera(), caster, *executor, never);
        values.clear();
        for (const Rgb& pixel : frame.radiance) values.push_back(pixel.g);
        if (x > 0) CHECK(2 * frame.report.reused > frame.report.pixels);
    }
    return values;
}

/// Means of all pixels, each over samples of seeds of their own.
std::vector<MeanEstimate> draw(const ChanceCase& c, std::uint64_t seed, int samples,
                               Planted planted = Planted::nothing) {
    const TestScene scene(c.text, c.options);
    for (const std::string& m : scene.warnings.messages) MESSAGE(m);
    const Camera now(chance_view(0)), before(chance_view(.5));
    Silence warnings;
    TraceContext context(scene.tracer, warnings);
    std::vector<SampleSums> sums(kSide * kSide);
    for (int i = 0; i < samples; ++i) {
        const auto fresh = static_cast<std::uint64_t>(planted == Planted::stale_seed ? i % 10 : i);
        const PixelRays rays(now, c.moves ? &before : nullptr, kSide, kSide, c.pixels,
                             seed + fresh);
        if (c.reuses) {
            const std::vector<double> frame = reused_frame(scene, c.pixels, seed + fresh);
            for (int k = 0; k < kSide * kSide; ++k) {
                const double slope = std::abs(rays(k % kSide, k / kSide, 0).ray->direction.z);
                const double error = planted == Planted::pdf      ? 1.02
                                     : planted == Planted::cosine ? slope
                                                                  : 1;
                sums[static_cast<std::size_t>(k)].add(error * frame[static_cast<std::size_t>(k)]);
            }
            continue;
        }
        for (int k = 0; k < kSide * kSide; ++k) {
            double value = 0;
            for (int s = 0; s < rays.samples(); ++s) {
                const PixelRay at = rays(k % kSide, k / kSide, s);
                Ray ray = scene.tracer.primary(at.ray->origin, at.ray->direction, 0, at.random);
                scene.tracer.trace(ray, context);
                double one = static_cast<double>(ray.value.g) / rays.samples();
                if (planted == Planted::pdf) one *= 1.02;
                if (planted == Planted::cosine) one *= std::abs(at.ray->direction.z);
                value += one;
            }
            sums[static_cast<std::size_t>(k)].add(value);
        }
    }
    std::vector<MeanEstimate> means;
    for (const SampleSums& s : sums) means.push_back(s.estimate());
    return means;
}

void store_means() {
    std::ofstream out(kMeans);
    out.precision(9);
    for (const ChanceCase& c : all_cases()) {
        out << c.name << '\n';
        for (const MeanEstimate& m : draw(c, kStoredSeed, kStoredSamples))
            out << m.mean << ' ' << m.variance << '\n';
    }
}

/// By the names of their cases.
std::map<std::string, std::vector<MeanEstimate>> stored_means() {
    std::map<std::string, std::vector<MeanEstimate>> all;
    std::ifstream in(kMeans);
    std::string name;
    while (in >> name) {
        std::vector<MeanEstimate>& means = all[name];
        means.resize(kSide * kSide);
        for (MeanEstimate& m : means) in >> m.mean >> m.variance;
    }
    return all;
}

}  // namespace

TEST_CASE("z-test: accepts what differs by chance, as often as its level says") {
    // Pixels of uniform numbers: the level is that of the whole picture.
    RandomStream random(5);
    constexpr int kPictures = 2000;
    int refused = 0;
    for (int i = 0; i < kPictures; ++i) {
        std::vector<MeanEstimate> a(9), b(9);
        for (std::vector<MeanEstimate>* picture : {&a, &b})
            for (MeanEstimate& pixel : *picture) {
                SampleSums sums;
                for (int k = 0; k < 40; ++k) sums.add(random.next());
                pixel = sums.estimate();
            }
        refused += z_test(a, b).p < .05 ? 1 : 0;
    }
    // 5 % of 2000 is 100 +- 10; 40 samples do not know their variance well.
    CHECK(refused > 60);
    CHECK(refused < 170);
}

TEST_CASE("z-test: refuses one pixel that is off, and all that are off by little") {
    std::vector<MeanEstimate> truth(64, {1, 1e-4}), one = truth, all = truth;
    CHECK(agrees(z_test(truth, truth)));
    one[7].mean += .08;
    CHECK(!agrees(z_test(one, truth)));
    for (MeanEstimate& m : all) m.mean *= 1.01;
    CHECK(!agrees(z_test(all, truth)));
    CHECK(z_test(all, truth).worst < 1);
    // What is not random has to be the same.
    const std::vector<MeanEstimate> exact(4, {1, 0}), off(4, {1.0002, 0});
    CHECK(agrees(z_test(exact, exact)));
    CHECK(!agrees(z_test(off, exact)));
}

TEST_CASE("pictures: what is random has the stored means, and planted errors are found") {
    if (std::getenv("LIGHTWALK_UPDATE_MEANS") != nullptr) {
        store_means();
        return;
    }
    const auto stored = stored_means();
    for (const ChanceCase& c : all_cases()) {
        CAPTURE(c.name);
        REQUIRE(stored.contains(c.name));
        const std::vector<MeanEstimate>& truth = stored.at(c.name);
        const double more = double(kStoredSamples) / c.samples;
        const ZTest right = z_test(draw(c, kTestSeed, c.samples), truth, more);
        CAPTURE(right);
        CHECK(agrees(right));
        for (const Planted planted : {Planted::pdf, Planted::cosine, Planted::stale_seed}) {
            const ZTest wrong = z_test(draw(c, kTestSeed, c.samples, planted), truth, more);
            CAPTURE(static_cast<int>(planted));
            CAPTURE(wrong);
            CHECK(!agrees(wrong));
        }
    }
}
