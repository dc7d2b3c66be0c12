#include "apps/trace_command.h"

#include <optional>
#include <utility>

#include "apps/commands.h"

namespace lightwalk {
namespace {

AttachedOption formats_option(RayFormats& formats) {
    return {"-f", [&formats](OptionWords& words) {
                const auto named = parse_ray_formats(words.option().substr(2));
                if (named) words.skip(1);
                formats = named.value_or(formats);
                return named.has_value();
            }};
}

AttachedOption letters_option(std::string& letters) {
    const auto take = [&letters](OptionWords& words) {
        letters = words.option().substr(2);
        words.skip(1);
        return true;
    };
    return {"-o", take, [&letters] { return letters; }};
}

std::vector<OptionRow> record_rows(TraceCommand& c) {
    return {{"Records", SectionTitle{}},
            {"-oLETTERS", letters_option(c.letters),
             "output fields | fields of a record:\n  o origin   d direction   v radiance   V "
             "radiance times coefficient\n  w W weights\n  l distance of what is seen   L first "
             "distance   p first point\n  c mesh coordinates\n  n shading normal   N geometric "
             "normal   s surface   m modifier\n  M material   r mirrored part   x the rest   R X "
             "their distances   ~ a tilde\n  t T the fields after it, for every ray that is "
             "traced: children first, a\n      tab for each generation, -n 1. T also tells shadow "
             "rays that reach\n      their light source unhindered\n"},
            {"-h[+-]", &c.header, "output header | write a header before the records"},
            {"-I[+-]", &c.common.request.options.rays.sensor,
             "rays are points and normals: irradiance | irradiance: rays are points and the "
             "normals there"},
            {"-ld[+-]", &c.common.request.options.rays.limit_by_length,
             "a direction's length limits its ray |"},
            {"-x N", &c.x, "flush interval | picture width: flush the output after N rays"},
            {"-y N", &c.y,
             "rows | picture height: stop after -x times -y rays; a resolution line goes before "
             "the records"},
            {"--interval N", &c.interval,
             "answer each ray N times, with random numbers (and a cache of indirect light) of its "
             "own each: colours are the means, and behind each colour stand the half-widths of "
             "95 % confidence intervals, by Student's t. Errors that all answers have in common, "
             "as of a cache of low accuracy, are not in them",
             With{.least = 2, .most = 100, .expected = "2 to 100 answers", .shown = ""}},
            {"-fXY", formats_option(c.formats),
             "formats of input and output: a text, f float, d double, and for output c RGBE; -fX: "
             "both (default aa)"}};
}

std::vector<OptionRow> server_rows(TraceCommand& c) {
    constexpr double kDay = 86400;
    return {{"Server", SectionTitle{}},
            {"--serve", &c.serve,
             "trace nothing, but hold the octree, compiled, for all rtrace that are called by the "
             "names of `lightwalk install-names --serve`: these need not read it. Ends by itself, "
             "also when a file of the scene changes"},
            {"--idle SECONDS", &c.idle, "--serve ends when nobody has asked for so long",
             With{.least = .1, .most = kDay, .expected = "seconds, .1 to 86400"}}};
}

std::vector<OptionRow> color_rows(TraceCommand& c) {
    const auto color = [&c](ColorOutput output) {
        return Action{[&c, output] { c.color = output; }};
    };
    return {
        {"Colours, one of", SectionTitle{}},
        {"-pRGB", color(ColorOutput::rgb), "radiance, red, green, blue [W/(m2 sr)] (default)"},
        {"-pXYZ", color(ColorOutput::xyz), "CIE XYZ, Y in cd/m2"},
        {"-pY", color(ColorOutput::luminance), "luminance [cd/m2]"},
        {"-pA", color(ColorOutput::mean), "mean of the channels [W/(m2 sr)]"},
        {"-pc", RefusedOption{" converts to other primaries, which is not supported; the choices "
                              "are -pRGB, -pXYZ, -pY and -pA"}}};
}

std::vector<OptionRow> tree_rows(TreeSelection& tree, const LibraryPath& library) {
    using Kind = TreeSelection::Kind;
    const auto adds = [&tree](Kind kind) {
        return [&tree, kind](const std::vector<std::string>& names) { tree.add(kind, names); };
    };
    return {{"Rays of trees (-ot, -oT)", SectionTitle{}},
            {"-te MODIFIER", name_option(adds(Kind::exclude)),
             "leave out rays that meet this modifier; repeatable"},
            {"-ti MODIFIER", name_option(adds(Kind::include)),
             "only rays that meet this modifier; repeatable"},
            {"-tE FILE", names_option(adds(Kind::exclude), library),
             "leave out rays that meet the modifiers that FILE names"},
            {"-tI FILE", names_option(adds(Kind::include), library),
             "only rays that meet the modifiers that FILE names"}};
}

}  // namespace

OptionTable option_table(TraceCommand& c, const std::shared_ptr<FileSource>& files) {
    const LibraryPath library = LibraryPath::from_environment(files);
    return {{c.common.command, kTrace},
            {record_rows(c), color_rows(c), tree_rows(c.tree, library),
             render_option_rows(c.common.settings, library), server_rows(c),
             common_option_rows(c.common)},
            {"-i", "-n", "--seed"}};
}

}  // namespace lightwalk
