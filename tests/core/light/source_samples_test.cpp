// Samples of all sources from one point, side by side, against those that are found one by one.
#include "core/light/source_samples.h"

#include <doctest/doctest.h>

#include <numeric>
#include <optional>
#include <vector>

#include "tests/core/light/source_examples.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

/// One of every kind.
std::vector<LightSource> all_kinds() {
    LightSource spot = panel(0.4), sun = panel(0.1), glow = panel(0.7), ball = panel(0.2);
    spot.spot = SpotShape{{0, 0, -1}, 2.0f, 0.3f, false};
    sun.shape = PrimitiveType::source;
    sun.center = normalize(Vec3{0.1, 0.2, 1});
    glow.material_type = PrimitiveType::glow;
    glow.proximity = 1.3f;
    ball.shape = PrimitiveType::sphere;
    ball.w = {0, 0, 0.2};
    return {panel(0.5), tube(0.8, 0.1), spot, sun, glow, ball};
}

std::vector<std::int32_t> numbers(std::size_t count) {
    std::vector<std::int32_t> result(count);
    std::iota(result.begin(), result.end(), 0);
    return result;
}

/// Below the sources, beside and above them.
Vec3 place(int i) {
    return {0.02 * i - 1, 0.3, i % 5 == 0 ? 1.5 : 0.01 * i - 1};
}

}  // namespace

TEST_CASE("samples that are found side by side are those that each is alone") {
    const std::vector<LightSource> sources = all_kinds();
    std::vector<int> found(sources.size());
    SourceSamples samples;
    for (int i = 0; i < 150; ++i) {
        const Vec3 point = place(i);
        RandomStream together(3), alone(3);
        std::vector<SourceSample> expected;
        std::vector<std::int32_t> of;
        samples.clear();
        for (std::size_t s = 0; s < sources.size(); ++s) {
            SourceParts parts;
            Partition{sources[s]}(point, 0.4, parts);
            for (int k = 0; k < parts.count; ++k) {
                const SourcePart& part = parts.part[static_cast<std::size_t>(k)];
                const auto index = static_cast<std::int32_t>(s);
                samples.add(sources[s], index, part, parts.count, point, 0.9, together);
                const auto one = sample_part(sources[s], part, parts.count, point, 0.9, alone);
                if (!one) continue;
                expected.push_back(*one);
                of.push_back(index);
            }
        }
        samples.sample(sources, point);
        const LightSamples lights = samples.lights();
        REQUIRE(lights.count == expected.size());
        for (std::size_t k = 0; k < expected.size(); ++k) {
            CHECK(samples.source(k) == of[k]);
            CHECK(lights.direction(k) == expected[k].direction);
            CHECK(lights.solid_angle[k] == expected[k].solid_angle);
            CHECK(length(lights.direction(k)) == rounded(1.0));
            ++found[static_cast<std::size_t>(of[k])];
        }
    }
    for (const int count : found) CHECK(count > 20);
}

TEST_CASE("boxes: what is said of all sources at once is true of each") {
    const std::vector<LightSource> sources = all_kinds();
    const SourceBoxes boxes(sources, numbers(sources.size()));
    SourceViews views;
    int behind = 0, turned = 0, far = 0;
    for (int i = 0; i < 600; ++i) {
        const Vec3 point = place(i % 150);
        const Vec3 front = normalize(Vec3{0.01 * (i % 7) - 0.03, 0.2, i % 2 == 0 ? 1.0 : -1.0});
        const double size = i < 300 ? 0.4 : 2.0;
        boxes.look(point, &front, size, views);
        for (std::size_t s = 0; s < sources.size(); ++s) {
            CHECK(views.is_behind(s) == is_behind(sources[s], point, front));
            SourceParts parts;
            Partition{sources[s]}(point, size, parts);
            if (views.turns_away(s)) {
                CHECK(parts.count == 0);
                ++turned;
            } else if (views.is_far(s)) {
                CHECK(parts.count == 1);
                ++far;
            }
            behind += views.is_behind(s) ? 1 : 0;
        }
    }
    CHECK(behind > 100);
    CHECK(turned > 100);
    CHECK(far > 100);
}

TEST_CASE("boxes: sources that are not divided give the samples of their whole") {
    const std::vector<LightSource> sources = all_kinds();
    const SourceBoxes boxes(sources, numbers(sources.size()));
    SourceViews views;
    SourceSamples samples;
    for (int i = 0; i < 150; ++i) {
        const Vec3 point = place(i);
        boxes.look(point, nullptr, 0, views);
        for (std::size_t s = 0; s < sources.size(); ++s) {
            RandomStream random(1);
            const auto expected = sample_whole(sources[s], point, 0, random);
            samples.clear();
            boxes.add_whole(s, static_cast<std::int32_t>(s), views, samples);
            samples.sample(sources, point);
            REQUIRE(samples.size() == (expected ? 1 : 0));
            if (!expected) continue;
            CHECK(samples.lights().direction(0) == expected->direction);
            CHECK(samples.lights().solid_angle[0] == expected->solid_angle);
        }
    }
}

TEST_CASE("samples that are dropped leave the others in their order") {
    const std::vector<LightSource> sources(200, panel(0.5));
    SourceSamples samples;
    RandomStream random(1);
    for (std::int32_t i = 0; i < 200; ++i)
        samples.add(sources[0], i, kWholeBox, 1, {0.001 * i, 0, 0}, 0, random);
    samples.sample(sources, {0, 0, 0});
    REQUIRE(samples.size() == 200);
    const std::vector<double> x(samples.lights().x, samples.lights().x + 200);
    samples.retain([](std::size_t i) { return i % 3 == 1; });
    REQUIRE(samples.size() == 67);
    for (std::size_t k = 0; k < samples.size(); ++k) {
        CHECK(samples.source(k) == static_cast<std::int32_t>(3 * k + 1));
        CHECK(samples.lights().x[k] == x[3 * k + 1]);
    }
}
