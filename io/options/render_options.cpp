#include "io/options/render_options.h"

#include <sstream>
#include <utility>

namespace lightwalk {
namespace {

constexpr std::size_t kMaxModifiers = 512;  // of -ae and -ai together

using Kind = AmbientSelection::Kind;

void select(AmbientSelection& selection, Kind kind, const std::vector<std::string>& names) {
    if (selection.kind != kind) selection = {kind, {}};
    selection.modifiers.insert(selection.modifiers.end(), names.begin(), names.end());
    if (selection.modifiers.size() > kMaxModifiers) {
        throw UsageError("more than " + std::to_string(kMaxModifiers) +
                         " modifiers in ambient lists");
    }
}

/// -ae, -ai, -aE, -aI. They come first: the nearest name of a misspelt "-a?" is one of them.
std::vector<OptionRow> ambient_lists(AmbientSelection& selection, const LibraryPath& library) {
    const auto adds = [&selection](Kind kind) {
        return [&selection, kind](const std::vector<std::string>& names) {
            select(selection, kind, names);
        };
    };
    return {{"Surfaces with indirect light", SectionTitle{"render"}},
            {"-ae MODIFIER", name_option(adds(Kind::exclude)),
             "no indirect light is calculated on surfaces of this modifier; repeatable"},
            {"-ai MODIFIER", name_option(adds(Kind::include)),
             "indirect light is calculated on surfaces of this modifier alone; repeatable"},
            {"-aE FILE", names_option(adds(Kind::exclude), library),
             "no indirect light on surfaces of the modifiers that FILE names"},
            {"-aI FILE", names_option(adds(Kind::include), library),
             "indirect light on surfaces of the modifiers that FILE names, and no others"}};
}

std::vector<OptionRow> direct_light(RenderSettings& s) {
    RenderOptions& o = s.light;
    return {
        {"What is shown", SectionTitle{"render"}},
        {"-u[+-]", &s.uncorrelated,
         "uncorrelated sampling | independent samples, as Radiance has them; those of one ray a "
         "pixel always are, so it changes nothing"},
        {"-w[+-]", &s.warnings, "warning messages | print warnings"},
        {"-i[+-]", &o.irradiance,
         "irradiance instead of radiance | irradiance of the surfaces seen, instead of their "
         "radiance"},
        {"-bv[+-]", &o.back_faces_visible,
         "back faces visible | surfaces are visible from behind, too"},
        {"Direct light", SectionTitle{"render"}},
        {"-dt SHARE", &o.shadow_threshold,
         "direct threshold | at a point no more shadows are tested when the light sources left "
         "would add less than this share to the light found; 0: all are tested"},
        {"-dc CERTAINTY", &o.shadow_certainty,
         "direct certainty | how surely the error by -dt stays within its share, 0 to 1"},
        {"-dj SHARE", &o.source_jitter,
         "direct jitter | part of a light source over which shadow rays are spread, for soft "
         "shadows; 0: they go to fixed places"},
        {"-ds RATIO", &o.source_subdivision,
         "direct sampling (source size / distance) | light sources are divided until a part's size "
         "/ distance is below this; 0: never"},
        {"-dr N", &o.redirections,
         "relays of virtual light sources | mirrors and prisms make virtual light sources, of real "
         "ones and of virtual ones, at most N deep"},
        {"-dp DENSITY", &o.virtual_source_pretest,
         "pretest density of virtual sources [1/sr] | rays per steradian that test beforehand "
         "whether a virtual light source is hidden; 0: no test",
         With{.format = "%.0f"}},
        {"-dv[+-]", &o.sources_visible, "light sources visible | light sources are seen as such"},
        {"Specular light", SectionTitle{"render"}},
        {"-ss N", &o.specular_samples,
         "specular samples | rays that sample a rough reflection or transmission; below 1: how "
         "much these are blurred, 0: they look sharp"},
        {"-st SHARE", &o.specular_threshold,
         "specular threshold | rough surfaces that reflect or transmit no more than this are not "
         "sampled for it"}};
}

/// The lines of -defaults for files and lists, which have no value unless one is given.
std::string lines_if_given(const RenderSettings& settings) {
    std::string text;
    if (!settings.ambient_file.empty())
        text += defaults_line("-af " + settings.ambient_file, "ambient file");
    const AmbientSelection& selection = settings.light.ambient_surfaces;
    const bool include = selection.kind == Kind::include;
    for (const std::string& name : selection.modifiers)
        text += defaults_line((include ? "-ai " : "-ae ") + name,
                              include ? "ambient include modifier" : "ambient exclude modifier");
    return text;
}

std::vector<OptionRow> indirect_light(RenderSettings& s) {
    RenderOptions& o = s.light;
    const With scientific{.format = "%.2e"};
    return {
        {"Indirect light", SectionTitle{"render"}},
        {"-av R G B", &o.ambient_value,
         "ambient value [W/(m2 sr)] | constant radiance from all around, where indirect light is "
         "not calculated [W/(m2 sr)]"},
        {"-aw N", &o.ambient_weight,
         "ambient value weight | the mean of calculated values replaces -av, which counts as N of "
         "them; 0: it stays"},
        {"-ab N", &o.ambient_bounces, "ambient bounces | bounces of indirect light; 0: -av alone"},
        {"-aa ERROR", &o.ambient_accuracy,
         "ambient accuracy | error allowed where indirect light is interpolated, as a share; 0: it "
         "never is"},
        {"-ar N", &o.ambient_resolution,
         "ambient resolution | calculated values are no closer than the scene's size times -aa / "
         "N; 0: no limit"},
        {"-ad N", &o.ambient_divisions,
         "ambient divisions | rays over the hemisphere for each value of indirect light"},
        {"-as N", &o.ambient_super_samples,
         "ambient super-samples | rays added to those of -ad where neighbours differ most"},
        {"Mist", SectionTitle{"render"}},
        {"-me R G B", &o.extinction, "mist extinction [1/m] |", scientific},
        {"-ma R G B", &o.albedo,
         "mist scattering albedo | share of its extinction that mist scatters"},
        {"-mg G", &o.eccentricity,
         "mist scattering eccentricity | how much mist scatters forward: 0: alike to all sides, 1: "
         "forward alone"},
        {"-ms DISTANCE", &o.scatter_step,
         "mist sampling distance [m] | distance between samples of scattered light along a ray "
         "[m]; 0: one sample a ray"},
        {"How far light is followed, and what is kept", SectionTitle{"render"}},
        {"-lr N", &o.reflection_limit,
         "limit of reflections (<= 0: Russian roulette) | most reflections along a path; 0: chance "
         "ends paths (Russian roulette); -N: chance, and at most N"},
        {"-lw SHARE", &o.weight_limit,
         "limit of weight | rays that would bring less than this share of their pixel are not "
         "followed",
         scientific},
        {"-af FILE", &s.ambient_file,
         "keep the values of indirect light in a file; several runs may share it, also Radiance's",
         With{.lines = [&s] { return lines_if_given(s); }}}};
}

/// Radiance's options that Lightwalk knows and does not offer.
std::vector<OptionRow> foreign_options() {
    struct Foreign {
        std::vector<const char*> names;
        const char* why;
    };
    const std::vector<Foreign> foreign{
        {{"-ap"}, " names a photon map, which Lightwalk does not support"},
        {{"-am"}, " limits the search in photon maps, which Lightwalk does not support"},
        {{"-ac", "-aC"}, " is about photon maps, which Lightwalk does not support"},
        {{"-cs", "-cw", "-co", "-co+", "-co-"},
         " is about spectral rendering; Lightwalk renders three channels (red, green, blue)"},
        {{"-pS", "-pM"},
         " weights colours by another eye than the photopic one, which Lightwalk does not support; "
         "the choices are -pRGB, -pXYZ, -pY (photopic) and -pA (mean)"},
        {{"-f"},
         " reads definitions for all of a scene's functions, which Lightwalk does not support; "
         "name the file in the scene"},
        {{"-sj"}, " is gone since Radiance 4, use -ss"},
        {{"-P", "-PP"}, ": persistent processes are not supported"}};
    std::vector<OptionRow> rows;
    for (const Foreign& f : foreign)
        for (const char* name : f.names) rows.push_back({name, RefusedOption{f.why}});
    return rows;
}

}  // namespace

CustomOption name_option(AddNames add) {
    return {[add = std::move(add)](OptionWords& words) { add({words.text()}); }};
}

CustomOption names_option(AddNames add, const LibraryPath& library) {
    return {[add = std::move(add), library](OptionWords& words) {
        std::istringstream text(
            library.files().read(library.locate(words.text(), "modifier list")));
        std::vector<std::string> names;
        for (std::string word; text >> word;) names.push_back(word);
        add(names);
    }};
}

RenderSettings default_render_settings(OptionDefaults program) {
    RenderSettings settings;
    if (program == OptionDefaults::rpict) return settings;
    settings.uncorrelated = true;
    settings.light.shadow_threshold = 0.03;
    settings.light.shadow_certainty = 0.75;
    settings.light.source_subdivision = 0.2;
    settings.light.redirections = 2;
    settings.light.ambient_accuracy = 0.1;
    settings.light.ambient_resolution = 256;
    settings.light.ambient_divisions = 1024;
    settings.light.ambient_super_samples = 512;
    settings.light.reflection_limit = -10;
    if (program == OptionDefaults::rtrace) return settings;
    settings.light.shadow_threshold = 0;
    settings.light.source_jitter = 0.9;
    settings.light.redirections = 3;
    settings.light.specular_threshold = 0.02;
    settings.light.ambient_bounces = 1;
    settings.light.ambient_accuracy = 0;
    settings.light.ambient_divisions = 350;
    settings.light.ambient_super_samples = 0;
    settings.light.weight_limit = 2e-3;
    return settings;
}

std::vector<OptionRow> render_option_rows(RenderSettings& settings, const LibraryPath& library) {
    std::vector<OptionRow> rows = ambient_lists(settings.light.ambient_surfaces, library);
    for (const auto& more : {direct_light(settings), indirect_light(settings), foreign_options()})
        rows.insert(rows.end(), more.begin(), more.end());
    return rows;
}

bool parse_render_option(OptionWords& words, const LibraryPath& library, RenderSettings& settings) {
    return OptionTable({"", ~0U}, {render_option_rows(settings, library)}).take(words);
}

void check_render_settings(const RenderSettings& settings) {
    if (settings.light.reflection_limit <= 0 && settings.light.weight_limit <= 0) {
        throw UsageError(
            "option -lw: must be positive when -lr is zero or negative (Russian roulette)");
    }
}

std::string describe_render_settings(const RenderSettings& settings) {
    RenderSettings shown = settings;
    const LibraryPath none(std::vector<std::string>{});
    return OptionTable({"", ~0U}, {render_option_rows(shown, none)}).defaults();
}

}  // namespace lightwalk
