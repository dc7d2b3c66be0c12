#include "apps/render_command.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>

#include "apps/commands.h"
#include "core/light/find_light_groups.h"
#include "core/model/transform_args.h"
#include "core/view/pixel_samples.h"
#include "io/options/frame_name.h"
#include "io/options/view_options.h"
#include "io/picture/film.h"
#include "io/picture/layers.h"

namespace lightwalk {
namespace {

using Files = std::shared_ptr<FileSource>;

/// A view of a walk's list is read alone, not as a change of the one before it.
void take_view_file(OptionWords& words, RenderCommand& command, FileSource& files) {
    const std::vector<std::string> rest = words.rest();
    if (command.serve) command.view = {};
    (void)take_view_option(words, command.view, files);
    if (!command.serve) return;
    const std::string title = std::filesystem::path(rest[1]).stem().string();
    command.serve->page.views.push_back({title, command.view});
}

std::vector<OptionRow> view_rows(RenderCommand& c, const Files& files) {
    const CustomOption file{[&c, files](OptionWords& words) { take_view_file(words, c, *files); }};
    std::vector<OptionRow> rows = view_option_rows(c.view, files);
    rows.insert(
        rows.end(),
        {{"-vf FILE", file, "read the view from a view file or a picture",
          With{.commands = kRender | kAnimate}},
         {"-vf FILE", file,
          "a view for the page's list, named as the file; repeatable. The first is where the walk "
          "begins, and its height above the ground is that of the eyes",
          With{.commands = kWalk}}});
    for (OptionRow& row : rows) row.with.then = [&c] { c.view_given = true; };
    rows.push_back({"-v NAME", &c.rad_view,
                    "the view of a rad file (scene.rif) of that name or number, or a standard one "
                    "(X, y, Zl, xyZ ...); without: its first"});
    return rows;
}

/// "auto", or a number.
CustomOption sample_lights(std::optional<int>& lights) {
    const auto take = [&lights](OptionWords& words) {
        const std::string word = words.text();
        long count = 0;
        const bool automatic = word == "auto";
        if (!automatic && !(parse_integer(word, count) && count >= 0 && count <= 4096))
            refuse_argument("--sample-lights", "auto or a number of lights, 0 for all",
                            '"' + word + '"');
        lights = automatic ? std::nullopt : std::optional(static_cast<int>(count));
    };
    return {take, [&lights] { return lights ? std::to_string(*lights) : "auto"; }};
}

std::vector<OptionRow> pixel_rows(RenderCommand& c) {
    PixelOptions& p = c.common.request.options.pixels;
    return {
        {"Pixels", SectionTitle{"render"}},
        {"-x N", &c.x, "largest width [pixels] |"},
        {"-y N", &c.y, "largest height [pixels] |"},
        {"-pa A", &c.pixel_aspect,
         "pixel aspect (height / width) | height / width of a pixel; 0: the picture is exactly -x "
         "by -y",
         With{.least = 0}},
        {"-pj J", &p.jitter, "pixel jitter | jitter of a ray within its pixel, 0 to 1",
         With{.least = 0, .most = 1}},
        {"-pm M", &p.motion,
         "pixel motion | share of the frame time that the shutter is open, for motion blur (with "
         "-S)",
         With{.least = 0}},
        {"-pd D", &p.aperture,
         "pixel depth of field (lens diameter) [m] | lens diameter, for depth of field [m]",
         With{.least = 0}},
        {"-ps N", &p.spacing,
         "pixel sample spacing | trace every Nth pixel, and those between where neighbours differ; "
         "1: every pixel",
         With{.then = [&c] { c.spacing_given = true; }}},
        {"-pt T", &p.threshold,
         "pixel threshold | how much neighbours may differ (see -ps), as a share",
         With{.least = 0}},
        {"--samples N", &p.samples,
         "rays a pixel | N rays in every pixel, filtered by a Gaussian of .6 pixels as pfilt -r .6 "
         "does; pixels share those of their neighbours: edges without steps, less noise, best for "
         "powers of two (-ps is then 1 and -pj does not count; -z tells the distance along the ray "
         "nearest to the pixel's centre)",
         With{.least = 1, .most = 65536}},
        {"--pixel-filter FILTER",
         choice(p.filter,
                {{"gaussian", PixelFilter::gaussian}, {"mitchell", PixelFilter::mitchell}}),
         "with --samples, --error or --time: gaussian: as above; mitchell: the cubic of Mitchell & "
         "Netravali (B = C = 1/3), over 4 pixels: sharper, but its weights are negative from 1.1 "
         "pixels on: beside a bright edge it is a little too dark, around small bright lights "
         "there "
         "are rings, and what would be less than nothing is 0, in each layer by itself",
         With{.commands = kRender | kAnimate}},
        {"--error E", &c.common.request.options.goal.error,
         "relative error | rays are added where the picture needs them until 95 % of its pixels "
         "are within E of their luminance, as estimated from two halves of the rays: .05 is 5 %. "
         "--samples are those that each pixel begins with (at least 4). An .exr holds the error in "
         "a channel of that name (with layers, that of the whole picture), --stats what was "
         "reached",
         With{.least = 0, .most = 1, .shown = "", .commands = kRender | kAnimate}},
        {"--time SECONDS", &c.common.request.options.goal.seconds,
         "time for a picture [s] | the same until the time is up, but for reading, writing and the "
         "first rays of each pixel; with --error, until either is reached",
         With{.least = 0, .shown = "", .commands = kRender | kAnimate}},
        {"--sample-lights auto|N", sample_lights(c.sample_lights),
         "with --samples, N light sources, chosen by what they may bring, stand for all where more "
         "than twice as many may "
         "bring something: the same mean, more noise a ray, less time; auto: 8; 0: all are sampled",
         With{.commands = kRender | kAnimate}},
        {"-S N", &c.first_frame,
         "a picture for each view line on standard input, numbered from N; -o f%03d.hdr names them",
         With{.least = 1,
              .expected = "a frame number of at least 1",
              .shown = "",
              .commands = kRender}},
        {"-S", RefusedOption{": say --path FILE"}, "", With{.commands = kAnimate}},
        {"-t SECONDS", &c.report_interval,
         "time between reports [s] | report progress in lines, so often; on a terminal there is a "
         "progress bar unless --quiet",
         With{.least = 0}}};
}

CustomOption primaries(SeriesOutput& output) {
    return {[&output](OptionWords& words) {
        output.xyz = false;
        output.primaries.emplace();
        for (double& value : *output.primaries) value = words.real();
    }};
}

/// What the pixels of a Radiance picture hold.
Action channels(SeriesOutput& output, bool xyz) {
    return {[&output, xyz] {
        output.primaries.reset();
        output.xyz = xyz;
    }};
}

/// "auto", or a group by its patterns.
CustomOption light_group(RenderCommand& c) {
    return {[&c](OptionWords& words) {
        const std::string word = words.text();
        std::optional<std::vector<LightGroupPattern>>& groups =
            c.common.request.options.light_groups;
        const bool automatic = word == "auto";
        if (groups && automatic != groups->empty())
            throw UsageError("option --light-group: auto goes with no other groups");
        if (!groups) groups.emplace();
        c.output.layers = !c.serve;
        if (automatic) return;
        const std::size_t at = word.find('=');
        if (at == std::string::npos)
            refuse_argument("--light-group", "auto or NAME=PATTERN", '"' + word + '"');
        LightGroupPattern group{word.substr(0, at), {}};
        std::istringstream patterns(word.substr(at + 1));
        for (std::string pattern; std::getline(patterns, pattern, ',');)
            if (!pattern.empty()) group.patterns.push_back(pattern);
        groups->push_back(std::move(group));
        try {
            check_group_names(*groups);
        } catch (const InputError& error) {
            throw UsageError("option --light-group: " + std::string(error.what()));
        }
    }};
}

std::vector<OptionRow> output_rows(RenderCommand& c) {
    SeriesOutput& output = c.output;
    return {
        {"Output", SectionTitle{"render"}},
        {"-o FILE", &output.picture,
         ".hdr .pic .unf, or no ending: Radiance picture; .exr: float; .png .jpg: for the screen. "
         "Without -o a Radiance picture goes to standard output. A file of that name is replaced "
         "when the new one is whole",
         With{.commands = kRender}},
        {"-o FILE", &output.picture,
         "name of the frames' files, with %d or %04d for their numbers, from 1: frame%04d.hdr .exr "
         ".png .jpg (frame%04d: Radiance pictures). Pictures for the screen are all exposed as the "
         "first one (--exposure EV: "
         "fixed). FILE.mp4: a film, by the program ffmpeg where it is installed",
         With{.commands = kAnimate}},
        {"--light-group auto|NAME=PATTERN,...", light_group(c),
         "a layer for each group of light sources: those whose modifiers' names match a pattern "
         "(* ? [...]), the first that does; what is left is \"rest\", with -av. Repeatable. auto: "
         "the sun, the sky, and each other modifier. With -o %s.hdr a picture each, with -o "
         "FILE.exr "
         "all in one, beside the whole picture; lightwalk relight adds them up. As without, but "
         "with "
         "-ps 1",
         With{.commands = kRender}},
        {"--light-group auto|NAME=PATTERN,...", light_group(c),
         "dimmers in the page, one for each group of light sources: those whose modifiers' names "
         "match a pattern (* ? [...]), the first that does; what is left is \"rest\", with -av. "
         "Repeatable. auto: the sun, the sky, and each other modifier. Without -af",
         With{.commands = kWalk}},
        {"-z FILE", &output.depth,
         "distances along the pixels' rays [m]: raw floats from the top, or .exr; 1e10: nothing "
         "there",
         With{.then = [&c] { c.common.request.options.use_distances = !c.output.depth.empty(); },
              .commands = kRender | kAnimate}},
        {"-pRGB", channels(output, false), "a Radiance picture holds radiance (unless -pXYZ)"},
        {"-pXYZ", channels(output, true), "a Radiance picture holds CIE XYZ, Y in cd/m2"},
        {"-pc RX RY GX GY BX BY WX WY", primaries(output),
         "CIE chromaticities of the channels and of white, as a Radiance picture's header has "
         "them"},
        {"--exposure auto|EV", exposure_option(output.tone),
         "for .png and .jpg: average brightness, or a fixed number of stops"},
        {"--denoise", &output.denoise,
         "for .png, .jpg and films: remove the noise that is left, by Open Image Denoise where it "
         "is installed (libOpenImageDenoise of version 1 or 2); with --error or --time, the error "
         "before and after it is told. Other files hold what was traced, always",
         With{.commands = kRender | kAnimate}},
        {"--tone CURVE",
         choice(output.tone.curve,
                {{"curve", ToneCurve::highlights}, {"linear", ToneCurve::linear}}),
         "for .png and .jpg: curve: compress what is brighter than middle grey, so that windows "
         "and lamps keep their drawing; linear: cut off at white"}};
}

std::vector<OptionRow> run_rows(RenderCommand& c) {
    const RefusedOption frames{
        ": a walk's frames are kept as files, one by one: --resume draws the others"};
    RendererOptions& renderer = c.common.request.options;
    return {
        {"Cache of indirect light, beside -af", SectionTitle{"render"}},
        {"--overture WHEN", choice(renderer.cache_prepass, {{"auto", true}, {"off", false}}),
         "auto: with -ab fill the cache by a coarse picture first"},
        {"--deterministic", &renderer.deterministic,
         "the same bytes with any number of threads also with -ab: the cache is filled in rounds"},
        {"Interrupted runs", SectionTitle{"render"}},
        {"--checkpoint FILE", &c.checkpoint,
         "keep finished blocks in FILE, at most two seconds after they are traced; with -ab, "
         "ambient values in FILE-ambient, unless -af keeps them; with --deterministic their rounds "
         "in FILE",
         With{.commands = kRender}},
        {"--resume", &c.resume,
         "with --checkpoint: a run that was killed goes on, with any number of ranks and threads",
         With{.commands = kRender}},
        {"--checkpoint", frames, "", With{.commands = kAnimate}},
        {"--resume", &c.resume,
         "frames whose files are there are not drawn again. The first one that is drawn then has "
         "no points of frames before it; with -ab nor their ambient values, unless -af keeps them",
         With{.commands = kAnimate}}};
}

std::vector<OptionRow> refused_rows() {
    const RefusedOption whole{
        ": pictures are written whole or not at all, there is nothing to recover"};
    const RefusedOption file{": it is for pictures in files: say lightwalk render or animate"};
    std::vector<OptionRow> rows{{"-r", whole}, {"-ro", whole}};
    for (const char* name :
         {"-o", "-z", "-S", "--checkpoint", "--resume", "--path", "--rotate", "--walk"})
        rows.push_back({name, file, "", With{.commands = kWalk}});
    return rows;
}

/// Options that do not go with --light-group.
void check_layers(const RenderCommand& command) {
    if (command.output.picture.empty())
        throw UsageError(
            "option --light-group: name the layers' files with -o: -o layer_%s.hdr, or one of all: "
            "-o layers.exr");
    check_layers_name(command.output.picture);
    if (!command.checkpoint.empty())
        throw UsageError("option --checkpoint: layers (--light-group) are not kept in checkpoints");
    if (!command.common.settings.ambient_file.empty())
        throw UsageError("option -af: an ambient file holds no values of light groups");
}

/// Negative weights need samples that pixels share.
void check_filter(const RenderCommand& command) {
    const RendererOptions& options = command.common.request.options;
    if (!has_negative_weights(options.pixels.filter)) return;
    const std::string option = "option --pixel-filter: ";
    if (options.pixels.samples == 1 && !options.goal.given())
        throw UsageError(option +
                         "there is nothing to filter where pixels have one ray: say "
                         "--samples or --error");
    if (command.output.denoise)
        throw UsageError(option +
                         "pixels that are denoised (--denoise) share no rays, which "
                         "mitchell needs");
    if (command.walk && command.walk->reuse)
        throw UsageError(option +
                         "frames that reuse each other's points have pixels of their own, "
                         "by a Gaussian: say --reuse off");
}

void check_outputs(const RenderCommand& command) {
    const SeriesOutput& output = command.output;
    if (output.layers) check_layers(command);
    const std::string first =
        frame_name(output.layers ? layer_file_name(output.picture, "layer") : output.picture, 1);
    const bool film = command.walk && is_film(first);
    if (!first.empty() && !film) check_picture_name(first);  // before any work is done
    if (output.denoise && !film &&
        (first.empty() || is_radiance_picture(first) || is_exr_picture(first)))
        throw UsageError(
            "option --denoise: only pictures for the screen (-o FILE.png, .jpg, a film) are "
            "denoised: others hold what was traced");
    if (output.xyz && !output.picture.empty() && !is_radiance_picture(first))
        throw UsageError("option -pXYZ: only Radiance pictures (.hdr, .pic) hold CIE XYZ");
    const SampleGoal& goal = command.common.request.options.goal;
    if (goal.given() && !command.checkpoint.empty())
        throw UsageError(
            "option --checkpoint: a picture that is drawn until it is good (--error, --time) has "
            "no finished blocks to keep");
    if (goal.given() && command.walk && command.walk->reuse)
        throw UsageError(
            "options --error and --time: frames that reuse each other's points have samples of "
            "their own: say --reuse off");
    check_filter(command);
    if (command.resume && command.checkpoint.empty() && !command.walk)
        throw UsageError("option --resume: name the file with --checkpoint");
    (void)frame_name(output.depth, 0);
}

/// Options of `lightwalk animate` that do not go together.
void check_animate(const RenderCommand& command) {
    const SeriesOutput& output = command.output;
    const PixelOptions& pixels = command.common.request.options.pixels;
    if (output.picture.empty() || (!varies_by_frame(output.picture) && !is_film(output.picture)))
        throw UsageError(
            "name the frames' files with -o, with %d for their numbers: -o f%04d.hdr; or a film: "
            "-o walk.mp4");
    if (!output.depth.empty() && !varies_by_frame(output.depth))
        throw UsageError("option -z: expected %d in the name, for the frames' numbers");
    if (command.resume && is_film(output.picture))
        throw UsageError("option --resume: a film is made as a whole: draw frames, -o f%04d.png");
    const bool for_screen = !is_radiance_picture(output.picture) && !is_exr_picture(output.picture);
    if (command.resume && for_screen && output.tone.automatic)
        throw UsageError(
            "option --resume: all frames are exposed as the first one, which is not drawn again: "
            "say --exposure EV");
    if (command.walk->reuse && (pixels.aperture > 0 || pixels.motion > 0))
        throw UsageError("options -pd and -pm blur what points show sharp: say --reuse off");
}

/// Options of `lightwalk walk` that do not go together.
void check_walk(const RenderCommand& command) {
    const PixelOptions& pixels = command.common.request.options.pixels;
    if (command.common.request.options.light_groups &&
        !command.common.settings.ambient_file.empty())
        throw UsageError("option -af: an ambient file holds no values of light groups");
    if (!command.walk->reuse)
        throw UsageError(
            "option --reuse: a walk in a browser cannot do without: off is for animate");
    if (pixels.aperture > 0 || pixels.motion > 0)
        throw UsageError("options -pd and -pm blur what points show sharp");
    if (pixels.samples > 1)
        throw UsageError("option --samples: say --edge-samples, for where a view rests");
}

/// The largest distance of pixels that are traced in any case.
void settle_spacing(RenderCommand& command, WarningSink& warnings) {
    constexpr int kLargestSpacing = 16;
    PixelOptions& pixels = command.common.request.options.pixels;
    if (pixels.spacing > kLargestSpacing) warnings.warn("-ps reduced to 16");
    pixels.spacing = std::clamp(pixels.spacing, 1, kLargestSpacing);
    if (command.output.layers && pixels.spacing > 1) {
        if (command.spacing_given)
            warnings.warn("-ps ignored: with --light-group every pixel is traced");
        pixels.spacing = 1;
    }
    pixels.share_samples = !command.output.denoise;  // noise differs from pixel to pixel then
    const bool reuses = reuses_frames(command);
    const bool sampled =
        pixels.samples > 1 || command.common.request.options.goal.given() || command.output.denoise;
    if (pixels.spacing == 1 || (!reuses && !sampled)) return;
    if (command.spacing_given)
        warnings.warn(reuses ? "-ps ignored: every pixel that is not reused is traced"
                             : "-ps ignored: every pixel is traced where they have several rays, "
                               "or are denoised");
    pixels.spacing = 1;
}

/// Light sources at the end of each ray; 0: all of them.
int settled_lights(const RenderCommand& command) {
    constexpr int kAutomatic = 8;
    const RendererOptions& options = command.common.request.options;
    if (options.pixels.samples <= 1 && !options.goal.given()) return 0;
    if (command.sample_lights) return *command.sample_lights;
    // Layers are made for lights that may be turned up later.
    return reuses_frames(command) || command.output.layers ? 0 : kAutomatic;
}

}  // namespace

RenderCommand::RenderCommand(const std::string& name) : common(name) {
    if (name == "render") return;
    walk.emplace();
    if (name != "walk") return;
    serve.emplace();
    serve->page.max_size = {1920, 1200};
    walk->cloud.check = CloudCheck::rotating;  // frames are seen for a moment only
}

OptionTable option_table(RenderCommand& c, const Files& files) {
    const std::vector<std::vector<OptionRow>> rows{
        c.serve ? serve_option_rows(*c.serve) : std::vector<OptionRow>(),
        c.walk ? walk_option_rows(*c.walk, c.common.ranks.options.projectors)
               : std::vector<OptionRow>(),
        output_rows(c),
        view_rows(c, files),
        pixel_rows(c),
        render_option_rows(c.common.settings, LibraryPath::from_environment(files)),
        run_rows(c),
        refused_rows(),
        common_option_rows(c.common)};
    const std::string& name = c.common.command;
    if (c.serve) return {{name, kWalk}, rows, {"-vf", "--check"}};
    if (c.walk) return {{name, kAnimate}, rows, {"-o"}};
    return {{name, kRender}, rows};
}

void check_render_command(RenderCommand& command, FileSource& files) {
    check_outputs(command);
    if (command.serve) return check_walk(command);
    if (!command.walk) return;
    check_animate(command);
    resolve_walk(*command.walk, command.view, files);
}

void settle_render_command(RenderCommand& command, WarningSink& warnings) {
    settle_spacing(command, warnings);
    command.common.settings.light.sample_lights = settled_lights(command);
    if (reuses_frames(command))
        command.common.request.options.reuse =
            std::make_shared<const CloudOptions>(command.walk->cloud);
}

PictureSize picture_size(const RenderCommand& command, const View& view, WarningSink& warnings) {
    constexpr int kMostPixels = 1 << 28;
    const Camera camera(view);
    const PictureSize size =
        fit_picture(command.x, command.y, camera.aspect(), command.pixel_aspect);
    if (size.width <= 0 || size.height <= 0) warnings.warn("empty output picture");
    if (static_cast<double>(size.width) * size.height > kMostPixels)
        throw UsageError("options -x and -y: more than " + std::to_string(kMostPixels) + " pixels");
    return size;
}

}  // namespace lightwalk
