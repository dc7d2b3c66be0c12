#include "io/options/render_options.h"

#include <doctest/doctest.h>

#include <string>
#include <utility>
#include <vector>

#include "core/error.h"

using namespace lightwalk;

namespace {

const LibraryPath kNowhere(std::vector<std::string>{});

RenderSettings parse(const std::vector<std::string>& line,
                     OptionDefaults program = OptionDefaults::rpict) {
    RenderSettings settings = default_render_settings(program);
    OptionWords words(line);
    while (words.at_option()) {
        const bool known = parse_render_option(words, kNowhere, settings);
        REQUIRE(known);
    }
    return settings;
}

}  // namespace

TEST_CASE("defaults are those of rpict(1) and rtrace(1)") {
    const RenderOptions rpict = default_render_settings(OptionDefaults::rpict).light;
    const RenderSettings trace = default_render_settings(OptionDefaults::rtrace);
    const RenderOptions& rtrace = trace.light;
    CHECK(rpict.shadow_threshold == 0.05);
    CHECK(rtrace.shadow_threshold == 0.03);
    CHECK(rpict.shadow_certainty == 0.5);
    CHECK(rtrace.shadow_certainty == 0.75);
    CHECK(rpict.source_subdivision == 0.25);
    CHECK(rtrace.source_subdivision == 0.2);
    CHECK(rpict.redirections == 1);
    CHECK(rtrace.redirections == 2);
    CHECK(rpict.reflection_limit == 7);
    CHECK(rtrace.reflection_limit == -10);
    CHECK(std::pair(rpict.ambient_accuracy, rtrace.ambient_accuracy) == std::pair(0.2, 0.1));
    CHECK(std::pair(rpict.ambient_resolution, rtrace.ambient_resolution) == std::pair(64, 256));
    CHECK(std::pair(rpict.ambient_divisions, rtrace.ambient_divisions) == std::pair(512, 1024));
    CHECK(std::pair(rpict.ambient_super_samples, rtrace.ambient_super_samples) ==
          std::pair(128, 512));
    CHECK(trace.uncorrelated);
    for (const RenderOptions* o : {&rpict, &rtrace}) {
        CHECK(o->virtual_source_pretest == 512);
        CHECK(o->source_jitter == 0);
        CHECK(o->specular_samples == 1);
        CHECK(o->specular_threshold == 0.15);
        CHECK(o->weight_limit == 1e-4);
        CHECK(o->sources_visible);
        CHECK(o->back_faces_visible);
        CHECK_FALSE(o->irradiance);
        CHECK(o->ambient_bounces == 0);
    }
}

TEST_CASE("every rendering option sets its value") {
    const RenderSettings s =
        parse({"-i+", "-bv-", "-dt", ".1",   "-dc", ".2",  "-dj",  ".3",  "-ds", ".4",  "-dr",
               "5",   "-dp",  "6",   "-dv-", "-ss", "7.5", "-st",  ".8",  "-av", "1",   "2",
               "3",   "-aw",  "9",   "-ab",  "2",   "-aa", ".11",  "-ar", "12",  "-ad", "13",
               "-as", "14",   "-me", ".1",   ".2",  ".3",  "-ma",  ".4",  ".5",  ".6",  "-mg",
               ".7",  "-ms",  ".9",  "-lr",  "-3",  "-lw", "1e-3", "-u+", "-w-", "-af", "amb"});
    const RenderOptions& o = s.light;
    CHECK(o.irradiance);
    CHECK_FALSE(o.back_faces_visible);
    CHECK_FALSE(o.sources_visible);
    CHECK(o.shadow_threshold == 0.1);
    CHECK(o.shadow_certainty == 0.2);
    CHECK(o.source_jitter == 0.3);
    CHECK(o.source_subdivision == 0.4);
    CHECK(o.redirections == 5);
    CHECK(o.virtual_source_pretest == 6);
    CHECK(o.specular_samples == 7.5);
    CHECK(o.specular_threshold == 0.8);
    CHECK(o.ambient_value == Rgb(1, 2, 3));
    CHECK(o.ambient_weight == 9);
    CHECK(o.ambient_bounces == 2);
    CHECK(o.ambient_accuracy == 0.11);
    CHECK(o.ambient_resolution == 12);
    CHECK(o.ambient_divisions == 13);
    CHECK(o.ambient_super_samples == 14);
    CHECK(o.extinction == Rgb(.1f, .2f, .3f));
    CHECK(o.albedo == Rgb(.4f, .5f, .6f));
    CHECK(o.eccentricity == 0.7);
    CHECK(o.scatter_step == 0.9);
    CHECK(o.reflection_limit == -3);
    CHECK(o.weight_limit == 1e-3);
    CHECK(s.uncorrelated);
    CHECK_FALSE(s.warnings);
    CHECK(s.ambient_file == "amb");
}

TEST_CASE("words that are no rendering options are left alone") {
    RenderSettings settings;
    for (const std::string word : {"-vp", "-x", "-dvx", "-dvx+", "scene.rad", "-", "-abc", "-I"}) {
        CAPTURE(word);
        OptionWords words({word, "1"});
        REQUIRE(words.at_option());
        CHECK_FALSE(parse_render_option(words, kNowhere, settings));
        CHECK(words.position() == 0);
    }
}

TEST_CASE("one kind of ambient list at a time: the other kind starts anew") {
    using Kind = AmbientSelection::Kind;
    CHECK(parse({"-ae", "a", "-ae", "b"}).light.ambient_surfaces ==
          AmbientSelection{Kind::exclude, {"a", "b"}});
    CHECK(parse({"-ae", "a", "-ai", "b"}).light.ambient_surfaces ==
          AmbientSelection{Kind::include, {"b"}});
    std::vector<std::string> line;
    for (int i = 0; i < 513; ++i) line.insert(line.end(), {"-ai", "m"});
    CHECK_THROWS_AS((void)parse(line), UsageError);
    CHECK_THROWS_AS((void)parse({"-aE", "no-such-list"}), InputError);
}

TEST_CASE(
    "malformed values and options that are not offered are usage errors that name the option") {
    const auto message = [](const std::vector<std::string>& line) -> std::string {
        try {
            (void)parse(line);
        } catch (const UsageError& error) {
            return error.what();
        }
        return "";
    };
    CHECK(message({"-ab", "1.5"}) == "option -ab: expected an integer, found \"1.5\"");
    CHECK(message({"-av", "1", "2"}) == "option -av: expected a number, found nothing");
    CHECK(message({"-dp", "1e3"}) == "option -dp: expected an integer, found \"1e3\"");
    CHECK(message({"-ap", "map"}) ==
          "option -ap names a photon map, which Lightwalk does not support");
    CHECK(message({"-cs", "20"}).starts_with("option -cs is about "));
    CHECK(message({"-f", "x.cal"}).starts_with("option -f reads "));
}

TEST_CASE("Russian roulette needs a positive weight limit") {
    CHECK_THROWS_AS(check_render_settings(parse({"-lr", "0", "-lw", "0"})), UsageError);
    CHECK_NOTHROW(check_render_settings(parse({"-lr", "5", "-lw", "0"})));
    CHECK_NOTHROW(check_render_settings(parse({"-lr", "-5"})));
}

TEST_CASE(
    "-defaults: reals with six decimals, -me and -lw as %.2e, switches with a sign, then tabs and "
    "#") {
    const std::string text = describe_render_settings(parse({"-dv-", "-av", ".5", ".25", ".125"}));
    for (const std::string line :
         {"-dv-\t\t\t\t# ", "-dt 0.050000\t\t\t# ", "-lw 1.00e-04\t\t\t# ", "-bv+\t\t\t\t# ",
          "-dp 512\t\t\t\t# ", "-me 0.00e+00 0.00e+00 0.00e+00\t# ",
          "-av 0.500000 0.250000 0.125000\t# ", "-lr 7\t"}) {
        CAPTURE(line);
        CHECK(text.find(line) != std::string::npos);
    }
    CHECK(text.back() == '\n');
}
