#include "apps/contrib_command.h"

#include <algorithm>
#include <optional>

#include "apps/commands.h"

namespace lightwalk {
namespace {

void track(ContribCommand& c, const std::vector<std::string>& names) {
    for (const std::string& name : names) {
        const auto same = std::ranges::find(c.modifiers, name, &ModifierRequest::name);
        if (same != c.modifiers.end())
            throw UsageError("option -m: modifier \"" + name + "\" is named twice");
        ModifierRequest request = c.next;
        request.name = name;
        if (request.bin == "0") request.bins = 1;
        if (request.bins == 0)
            throw UsageError("option -b: how many bins modifier \"" + name +
                             "\" has is not known: expected -bn N before it");
        c.modifiers.push_back(std::move(request));
        c.next_open = false;
    }
}

/// Holds for the modifiers behind it.
CustomOption next_option(ContribCommand& c, std::string& place) {
    return {[&c, &place](OptionWords& words) {
        place = words.text();
        c.next_open = true;
    }};
}

void settle_cache(const ContribCommand& command, const std::vector<TrackedModifier>& tracked,
                  WarningSink& warnings) {
    for (const TrackedModifier& modifier : tracked) {
        if (depends_on_position(modifier.bin))
            throw UsageError("option --cache: the bins of modifier \"" + modifier.name +
                             "\" depend on place (Px Py Pz), which is not kept: expected Dx Dy "
                             "Dz alone");
    }
    if (command.common.settings.light.ambient_bounces < 2)
        warnings.warn("--cache changes nothing: it is for -ab 2 and more");
}

std::vector<OptionRow> modifier_rows(ContribCommand& c, const LibraryPath& library) {
    const auto add = [&c](const std::vector<std::string>& names) { track(c, names); };
    return {
        {"Whose contributions", SectionTitle{}},
        {"-m MODIFIER", name_option(add),
         "tell what surfaces of this modifier bring; repeatable. Of -b -bn -p -o the last ones "
         "before it hold"},
        {"-M FILE", names_option(add, library), "the same for the modifiers that FILE names"},
        {"-V[+-]", &c.values,
         "output contributions | contributions, in radiance, instead of coefficients, which times "
         "the emitter's radiance are these"},
        {"-c N", &c.rays,
         "accumulated rays per record | a record is the mean of N rays; 0: the sum of all",
         With{.least = 0,
              .expected = "a number of rays, 0 for all",
              .then =
                  [&c] {
                      if (c.rays == 0) c.x = c.y = 0;
                  }}},
        {"--cache[+-]", &c.cache,
         "cache of coefficients | with -ab 2 and more, for many rays: what rays of indirect light "
         "see is not traced further, but interpolated between places whose coefficients are kept, "
         "which lie closer for a lower -aa (0 counts as 0.2); directions next to those in which "
         "light comes in get more rays. For bins by direction, of light sources. "
         "With -r the rays that are left make places of their own: their records are as exact, not "
         "the same"},
        {"Bins", SectionTitle{}},
        {"-b EXPRESSION", next_option(c, c.next.bin),
         "the bin of a contribution, rounded, from 0 on; by where the emitter is met (Px Py Pz) "
         "and the ray's direction towards it (Dx Dy Dz); 0: there is one bin"},
        {"-bn N", CustomOption{[&c](OptionWords& words) {
             c.next.bins = c.definitions.count(words.text(), c.next.parameters);
             c.next_open = true;
         }},
         "number of bins: a constant expression of what -e and -f have defined before"},
        {"-p NAME=VALUE,...", next_option(c, c.next.parameters),
         "definitions for the expression -b alone"},
        {"-e DEFINITIONS",
         CustomOption{[&c](OptionWords& words) { c.definitions.add_expression(words.text()); }},
         "definitions for -b, in the language of function files: \"MF:4;\""}};
}

std::vector<OptionRow> record_rows(ContribCommand& c, const LibraryPath& library) {
    const auto take = [&c, library](OptionWords& words) {
        if (words.option() == "-f") {
            c.definitions.add_file(words.text(), library);
            return true;
        }
        const auto named = parse_ray_formats(words.option().substr(2));
        if (named) words.skip(1);
        c.formats = named.value_or(c.formats);
        return named.has_value();
    };
    const auto keeps = [&c](const char* name, ExistingOutputs existing) {
        return AttachedOption{name, [&c, name, existing](OptionWords& words) {
                                  const auto on = words.toggle(name, c.existing == existing);
                                  if (on) c.existing = *on ? existing : ExistingOutputs::refuse;
                                  return on.has_value();
                              }};
    };
    return {
        {"Records", SectionTitle{}},
        {"-o FILE", next_option(c, c.next.output),
         "where records go; in the name %s stands for the modifier, %d or %04d for the bin: a "
         "file each. Without: standard output"},
        {"-fo[+-]", keeps("-fo", ExistingOutputs::replace), "replace files that exist"},
        {"-r[+-]", keeps("-r", ExistingOutputs::continue_),
         "go on behind the records that files, or those of an interrupted run (.part), hold; with "
         "-c 0 add to these"},
        {"-h[+-]", &c.header, "output header | write a header before the records"},
        {"-I[+-]", &c.common.request.options.rays.sensor,
         "rays are points and normals: irradiance |"},
        {"-ld[+-]", &c.common.request.options.rays.limit_by_length,
         "a direction's length limits its ray |"},
        {"-x N", &c.x, "flush interval | picture width |"},
        {"-y N", &c.y, "rows | picture height: stop after -x times -y records"},
        {"-fXY | -f FILE", AttachedOption{"-f", take},
         "formats of input and output: a text, f float, d double, and for output c RGBE; -fX: "
         "both (default aa)\n-f FILE: definitions for -b in a function file along RAYPATH "
         "(reinhart.cal, tregenza.cal, klems_full.cal, disk2square.cal)\n"}};
}

}  // namespace

OptionTable option_table(ContribCommand& c, const std::shared_ptr<FileSource>& files) {
    const LibraryPath library = LibraryPath::from_environment(files);
    return {{c.common.command, kContrib},
            {modifier_rows(c, library), record_rows(c, library),
             render_option_rows(c.common.settings, library), common_option_rows(c.common)},
            {"-i", "-n", "--seed"}};
}

std::vector<TrackedModifier> tracked_modifiers(const ContribCommand& command) {
    if (command.modifiers.empty())
        throw UsageError("no modifier is named: expected -m MODIFIER or -M FILE");
    if (command.next_open)
        throw UsageError("options -o -b -bn -p hold for the modifiers behind them: expected -m");
    std::vector<TrackedModifier> tracked;
    for (const ModifierRequest& request : command.modifiers)
        tracked.push_back({request.name, command.definitions.bin(request.bin, request.parameters),
                           static_cast<std::size_t>(request.bins)});
    return tracked;
}

void settle_contrib_command(ContribCommand& command, const std::vector<TrackedModifier>& tracked,
                            WarningSink& warnings) {
    constexpr double kCacheAccuracy = 0.2;  // -aa, with --cache and -aa 0
    if (!command.common.settings.ambient_file.empty())
        throw UsageError("option -af: contributions are not kept in ambient files");
    RenderOptions& light = command.common.settings.light;
    if (light.ambient_super_samples > 0)
        warnings.warn("-as counts as 0: contributions tell no places that need more samples");
    if (light.ambient_accuracy > 0 && !command.cache)
        warnings.warn("-aa counts as 0: without --cache contributions are not interpolated");
    if (!command.cache)
        light.ambient_accuracy = 0;
    else if (light.ambient_accuracy <= 0)
        light.ambient_accuracy = kCacheAccuracy;
    light.ambient_super_samples = 0;
    light.shadow_threshold = 0;
    if (command.cache) settle_cache(command, tracked, warnings);
    RendererOptions& renderer = command.common.request.options;
    renderer.answers_rays = true;
    renderer.long_rays = light.ambient_bounces > 0;
    renderer.keep_coefficients = command.cache && light.ambient_bounces > 1;
}

std::size_t rays_at_once(const ContribCommand& command,
                         const std::vector<TrackedModifier>& tracked) {
    constexpr std::size_t kMostBytes = std::size_t{64} << 20;  // of answers
    constexpr std::size_t kMost = std::size_t{1} << 20, kMostLong = 1024;
    const std::size_t ray = 3 * sizeof(double) * column_count(tracked);
    const std::size_t most = std::clamp<std::size_t>(kMostBytes / ray, 1, kMost);
    return command.common.request.options.long_rays ? std::min(most, kMostLong) : most;
}

}  // namespace lightwalk
