#include "apps/render_command.h"

#include "apps/film.h"
#include "core/model/transform_args.h"
#include "io/options/frame_name.h"
#include "io/options/view_text.h"

namespace lightwalk {
namespace {

const std::vector<std::string> kOwnNames{
    "-x",           "-y",         "-pa",    "-ps",       "-pt",        "-pj",
    "-pd",          "-pm",        "-pc",    "-pRGB",     "-pXYZ",      "-o",
    "-z",           "-S",         "-t",     "-vp",       "-vd",        "-vu",
    "-vh",          "-vv",        "-vo",    "-va",       "-vs",        "-vl",
    "-vf",          "-vtv",       "-vtl",   "-vtc",      "-vth",       "-vta",
    "-vts",         "--exposure", "--tone", "--samples", "--overture", "--deterministic",
    "--checkpoint", "--resume"};

bool parse_view(OptionWords& words, RenderCommand& command, FileSource& files) {
    const std::vector<std::string> rest = words.rest();
    std::size_t used = 0;
    try {
        // A walk's views know nothing of each other.
        if (command.serve && words.option() == "-vf") command.view = {};
        used = parse_view_option(rest, command.view, files);
    } catch (const InputError& error) {
        if (words.option() == "-vf" && rest.size() > 1)
            throw;  // the file is at fault, not the command line
        throw UsageError(error.what());
    }
    if (command.serve && words.option() == "-vf")
        command.serve->views.push_back({view_title(rest[1]), command.view});
    if (used > 0) command.view_given = true;
    words.skip(used);
    return used > 0;
}

void set_exposure(const std::string& word, ToneMapping& tone) {
    tone.automatic = word == "auto";
    if (!tone.automatic && !parse_real(word, tone.ev)) {
        throw UsageError("option --exposure: expected auto or a number of stops (EV), found \"" +
                         word + "\"");
    }
}

ToneCurve tone_curve(const std::string& word) {
    if (word != "curve" && word != "linear")
        throw UsageError("option --tone: expected curve or linear, found \"" + word + "\"");
    return word == "curve" ? ToneCurve::highlights : ToneCurve::linear;
}

bool parse_pixel_option(OptionWords& words, RenderCommand& command) {
    const std::string word = words.option();
    if (word == "-x")
        command.x = words.integer();
    else if (word == "-y")
        command.y = words.integer();
    else if (word == "-pa")
        command.pixel_aspect = words.real();
    else if (word == "-ps") {
        command.pixels.spacing = words.integer();
        command.spacing_given = true;
    } else if (word == "--samples")
        command.pixels.samples = words.integer();
    else if (word == "-pt")
        command.pixels.threshold = words.real();
    else if (word == "-pj")
        command.pixels.jitter = words.real();
    else if (word == "-pd")
        command.pixels.aperture = words.real();
    else if (word == "-pm")
        command.pixels.motion = words.real();
    else if (word == "-pRGB" || word == "-pXYZ") {
        command.primaries.reset();
        command.xyz = word == "-pXYZ";
        words.skip(1);
    } else if (word == "-pc") {
        command.xyz = false;
        command.primaries.emplace();
        for (double& value : *command.primaries) value = words.real();
    } else {
        return false;
    }
    return true;
}

bool parse_output_option(OptionWords& words, RenderCommand& command) {
    const std::string word = words.option();
    if (word == "-o")
        command.output = words.text();
    else if (word == "-z")
        command.depth = words.text();
    else if (word == "-t")
        command.report_interval = words.real();
    else if (word == "--exposure")
        set_exposure(words.text(), command.tone);
    else if (word == "--tone")
        command.tone.curve = tone_curve(words.text());
    else if (word == "--checkpoint")
        command.checkpoint = words.text();
    else if (word == "--resume") {
        command.resume = true;
        words.skip(1);
    } else if (word == "--deterministic") {
        command.deterministic = true;
        words.skip(1);
    } else if (word == "--overture") {
        const std::string when = words.text();
        if (when != "auto" && when != "off")
            throw UsageError("option --overture: expected auto or off, found \"" + when + "\"");
        command.prepass = when == "auto";
    } else if (word == "-S") {
        command.first_frame = words.integer();
        if (command.first_frame < 1)
            throw UsageError("option -S: expected a frame number of at least 1");
    } else {
        return false;
    }
    return true;
}

void refuse_foreign(const std::string& word) {
    if (word == "-r" || word == "-ro") {
        throw UsageError("option " + word +
                         ": pictures are written whole or not at all, there is nothing to recover");
    }
    if (word == "-P" || word == "-PP")
        throw UsageError("option " + word + ": persistent processes are not supported");
}

void parse_option(OptionWords& words, const LibraryPath& library, RenderCommand& command) {
    const std::string& word = words.option();
    if (word == "-defaults") {
        command.show_defaults = true;
        return;
    }
    refuse_foreign(word);
    if (command.serve && parse_serve_option(words, *command.serve)) return;
    if (command.walk && parse_walk_option(words, *command.walk)) return;
    if (parse_view(words, command, library.files()) || parse_pixel_option(words, command) ||
        parse_output_option(words, command) ||
        parse_render_option(words, library, command.settings) ||
        parse_common_option(words, command.common, command.settings)) {
        return;
    }
    std::vector<std::string> names = render_option_names();
    names.insert(names.end(), kOwnNames.begin(), kOwnNames.end());
    if (command.walk)
        for (std::string& name : walk_option_names()) names.push_back(std::move(name));
    if (command.serve)
        for (std::string& name : serve_option_names()) names.push_back(std::move(name));
    refuse_option(words, std::move(names));
}

void check(const RenderCommand& command) {
    const PixelOptions& p = command.pixels;
    if (!(p.jitter >= 0) || p.jitter > 1)
        throw UsageError("option -pj: expected a number from 0 to 1");
    constexpr int kMostSamples = 65536;
    if (p.samples < 1 || p.samples > kMostSamples)
        throw UsageError("option --samples: expected a number from 1 to 65536");
    if (p.threshold < 0 || p.aperture < 0 || p.motion < 0 || command.pixel_aspect < 0 ||
        command.report_interval < 0) {
        throw UsageError("options -pt, -pd, -pm, -pa and -t take no negative numbers");
    }
    if (command.xyz && !command.output.empty() && !is_radiance_picture(command.output))
        throw UsageError("option -pXYZ: only Radiance pictures (.hdr, .pic) hold CIE XYZ");
    if (command.resume && command.checkpoint.empty())
        throw UsageError("option --resume: name the file with --checkpoint");
    (void)frame_name(command.output, 0);
    (void)frame_name(command.depth, 0);
}

/// A walk's pictures are many, and what is kept from one to the next are points on surfaces.
void check_walk(const RenderCommand& command) {
    if (command.first_frame > 0) throw UsageError("option -S: say --path FILE");
    if (!command.checkpoint.empty())
        throw UsageError("option --checkpoint: a walk's frames are kept as files, one by one");
    if (command.output.empty() || (!varies_by_frame(command.output) && !is_film(command.output)))
        throw UsageError(
            "name the frames' files with -o, with %d for their numbers: -o f%04d.hdr; or a film: "
            "-o walk.mp4");
    if (!command.depth.empty() && !varies_by_frame(command.depth))
        throw UsageError("option -z: expected %d in the name, for the frames' numbers");
    if (command.walk->reuse && (command.pixels.aperture > 0 || command.pixels.motion > 0))
        throw UsageError("options -pd and -pm blur what points show sharp: say --reuse off");
}

/// What is drawn for somebody who watches has no files and no end.
void check_serve(const RenderCommand& command) {
    if (command.first_frame > 0 || !command.checkpoint.empty() || !command.output.empty() ||
        !command.depth.empty() || command.walk->way != WalkCommand::Way::none)
        throw UsageError(
            "-o, -z, -S, --checkpoint, --path, --rotate and --walk are for pictures in files: say "
            "lightwalk render or animate");
    if (!command.walk->reuse) throw UsageError("option --reuse: a walk that is steered reuses");
    if (command.pixels.aperture > 0 || command.pixels.motion > 0)
        throw UsageError("options -pd and -pm blur what points show sharp");
    if (command.pixels.samples > 1)
        throw UsageError("option --samples: say --edge-samples, for where a view rests");
}

}  // namespace

RenderCommand parse_render_command(const std::string& name, const std::vector<std::string>& line,
                                   const std::shared_ptr<FileSource>& files) {
    RenderCommand command;
    command.name = name;
    if (name != "render") command.walk.emplace();
    if (name == "walk") {
        command.serve.emplace();
        command.walk->rate = 30;
        command.walk->cloud.check = CloudCheck::rotating;  // frames are seen for a moment only
    }
    command.settings = default_render_settings(OptionDefaults::rpict);
    const LibraryPath library = LibraryPath::from_environment(files);
    OptionWords words(line, files);
    while (!command.show_defaults && words.at_option()) parse_option(words, library, command);
    check(command);
    if (command.serve) {
        check_serve(command);
    } else if (command.walk && !command.show_defaults) {
        check_walk(command);
        resolve_walk(*command.walk, command.view, *files);
    }
    command.history = command_history(name, words, command.common);
    return command;
}

std::string describe(const RenderCommand& c) {
    const View& v = c.view;
    const auto vector_text = [](const std::string& name, const Vec3& a) {
        return option_text(name, a.x) + option_text("", a.y) + option_text("", a.z);
    };
    std::string text = option_line(std::string("-vt") + v.type, "view type");
    text += option_line(vector_text("-vp", v.position), "view point [m]");
    text += option_line(vector_text("-vd", v.direction), "view direction");
    text += option_line(vector_text("-vu", v.up), "view up");
    text += option_line(option_text("-vh", v.horizontal), "view horizontal size");
    text += option_line(option_text("-vv", v.vertical), "view vertical size");
    text += option_line(option_text("-vo", v.fore), "view fore clipping [m]");
    text += option_line(option_text("-va", v.aft), "view aft clipping [m]");
    text += option_line(option_text("-vs", v.shift), "view shift");
    text += option_line(option_text("-vl", v.lift), "view lift");
    text += option_line(option_text("-x", c.x), "largest width [pixels]");
    text += option_line(option_text("-y", c.y), "largest height [pixels]");
    text += option_line(option_text("-pa", c.pixel_aspect), "pixel aspect (height / width)");
    text += option_line(option_text("-pj", c.pixels.jitter), "pixel jitter");
    text += option_line(option_text("-pm", c.pixels.motion), "pixel motion");
    text += option_line(option_text("-pd", c.pixels.aperture),
                        "pixel depth of field (lens diameter) [m]");
    text += option_line(option_text("-ps", c.pixels.spacing), "pixel sample spacing");
    text += option_line(option_text("-pt", c.pixels.threshold), "pixel threshold");
    text += option_line("--samples " + std::to_string(c.pixels.samples), "rays a pixel");
    text += option_line(option_text("-t", c.report_interval), "time between reports [s]");
    text += describe_render_settings(c.settings);
    text += option_line(option_text("-n", c.common.workers), "threads");
    text += option_line("--seed " + std::to_string(c.settings.light.seed), "random seed");
    text += option_line("--ambient-lights " + std::to_string(c.settings.light.ambient_lights),
                        "lights sampled where ambient rays arrive");
    return text;
}

}  // namespace lightwalk
