#include "io/ambient/ambient_fit.h"

#include <doctest/doctest.h>

#include "core/ambient/ambient_cache.h"

namespace lightwalk {
namespace {

AmbientRecord record(int level, float weight = 1) {
    AmbientRecord r;
    r.level = static_cast<std::uint8_t>(level);
    r.weight = weight;
    r.radius = {0.5f, 0.75f};
    return r;
}

/// A fit of a file with the given header line to a run in a cube of edge 8.
AmbientFit fit(const std::string& line, const RenderOptions& options) {
    return {{"oconv -f scene.rad", line},
            options,
            ambient_limits({}, 8, options.ambient_accuracy, options.ambient_resolution)};
}

RenderOptions two_bounces() {
    RenderOptions options;
    options.ambient_bounces = 2;
    return options;
}

TEST_CASE("ambient options: a file of the same options, by its own line, serves as it stands") {
    RenderOptions options = two_bounces();
    options.ambient_value = {0.1f, 1.0f / 3, 1e-7f};
    options.ambient_accuracy = 1.0 / 7;
    options.ambient_divisions = 1234567;
    const AmbientFit same = fit(ambient_option_line(options), options);
    CHECK(same.difference().empty());
    CHECK_FALSE(same.loses_values());
    for (const int level : {0, 1}) {
        const auto served = same.for_run(record(level, 0.5f));
        REQUIRE(served);
        CHECK(served->level == level);
        CHECK(served->radius == record(level).radius);
        CHECK(same.for_file(record(level))->level == level);
    }
}

TEST_CASE("ambient options: what differs is told, whoever wrote the header") {
    const RenderOptions options = two_bounces();  // -av 0 0 0 -aw 0 -aa .2 -ad 512 -as 128 -ar 64
    CHECK(fit("\trpict -av 0 0 0 -aw 0 -ab 2 -aa 0.2 -ad 512 -as 128 -ar 64 -lr 7 x.oct", options)
              .difference()
              .empty());
    CHECK(fit("no options here -ab", options).difference().empty());
    CHECK(fit("-ab many -aa", options).difference().empty());
    CHECK(fit("rpict -aa 0.1", options).difference() == "-aa 0.1 (not 0.2)");
    CHECK(fit("rpict -av .5 0 0 -ab 3 -ad 64 -as 0 -ar 16", options).difference() ==
          "-av 0.5 0 0 (not 0 0 0), -ab 3 (not 2), -ad 64 (not 512), -as 0 (not 128), "
          "-ar 16 (not 64)");
}

TEST_CASE("ambient options: another -aa, -ad, -as or -av changes no value") {
    const AmbientFit other = fit("rpict -av 1 1 1 -aa .05 -ad 7 -as 0", two_bounces());
    const auto served = other.for_run(record(1, 0.5f));
    REQUIRE(served);
    CHECK(served->level == 1);
    CHECK(served->radius == record(1).radius);
    CHECK_FALSE(other.loses_values());
}

TEST_CASE("ambient options: a value serves where as many bounces are asked for as it holds") {
    const AmbientFit fewer = fit("rpict -ab 1", two_bounces());
    CHECK(fewer.for_run(record(0))->level == 1);
    CHECK(fewer.loses_values());
    CHECK_FALSE(fewer.for_file(record(0)));
    CHECK(fewer.for_file(record(1))->level == 0);

    const AmbientFit more = fit("rpict -ab 3", two_bounces());
    CHECK_FALSE(more.for_run(record(0)));
    CHECK(more.for_run(record(2))->level == 1);
    CHECK_FALSE(more.loses_values());
    CHECK(more.for_file(record(0))->level == 1);

    CHECK_FALSE(fit("rpict -ab -1e300", two_bounces()).for_run(record(0)));
    CHECK_FALSE(fit("rpict -ab 1e300", two_bounces()).for_run(record(255)));
}

TEST_CASE("ambient options: a finer -ar does not trust radii that a coarser one has raised") {
    // In a cube of edge 8: at least 0.5 with -ar 16, at least 0.125 with -ar 64.
    const AmbientFit finer = fit("rpict -ar 16", two_bounces());
    CHECK(finer.for_run(record(0))->radius == std::array{0.125f, 0.25f});
    // A deeper value of half the weight reaches farther by the root of two.
    AmbientRecord deeper = record(1, 0.5f);
    deeper.radius = {0.70710678f, 0.75f};
    CHECK(static_cast<double>(finer.for_run(deeper)->radius[0]) ==
          doctest::Approx(0.125 * std::sqrt(2.0)));
    AmbientRecord own = record(0);  // larger than the least, or of a run with another -ar
    for (const float radius : {0.51f, 0.3f}) {
        own.radius = {radius, 0.75f};
        CHECK(finer.for_run(own)->radius == own.radius);
    }
    CHECK(fit("rpict -ar 256", two_bounces()).for_run(record(0))->radius == record(0).radius);
    AmbientRecord wide = record(0);  // at most 1.6, a fifth of the cube
    wide.radius = {1, 3};
    CHECK(finer.for_run(wide)->radius == std::array{1.0f, 1.6f});
}

}  // namespace
}  // namespace lightwalk
