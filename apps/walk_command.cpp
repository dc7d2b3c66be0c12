#include "apps/walk_command.h"

#include <algorithm>

#include "apps/commands.h"
#include "core/model/transform_args.h"
#include "core/scene/scene.h"
#include "io/options/view_keys.h"

namespace lightwalk {
namespace {

const With kPercentage{.least = 0, .most = 100, .divisor = kPercent};
/// Only the pixels around a pixel are searched for points.
const With kAroundPixel{.least = 0, .most = 1.5};

void set_way(WalkCommand& walk, WalkCommand::Way way) {
    if (walk.way != WalkCommand::Way::none && walk.way != way)
        throw UsageError("--path, --rotate and --walk: only one of them");
    walk.way = way;
}

std::vector<OptionRow> way_rows(WalkCommand& walk) {
    using Way = WalkCommand::Way;
    const auto chosen = [&walk](Way way) { return [&walk, way] { set_way(walk, way); }; };
    const Choice move = choice(walk.move, {{"turn", WalkMove::turn},
                                           {"forward", WalkMove::forward},
                                           {"backward", WalkMove::backward},
                                           {"left", WalkMove::left},
                                           {"right", WalkMove::right}});
    return {{"The walk, one of --path, --rotate and --walk", SectionTitle{"animate"}},
            {"--path FILE", &walk.path,
             "a file of views, one a line: \"VIEW= -vp X Y Z -vd X Y Z ...\"; what a line leaves "
             "out is as in the line before. A number before it is its time in seconds, otherwise a "
             "second passes. Each line is a frame; with --frames N, N of them are spread over the "
             "time, on a smooth path through the views",
             With{.then = chosen(Way::path), .commands = kAnimate}},
            {"--rotate DEGREES", &walk.degrees,
             "a turn to the right, about the view's up vector, by so much in all. Needs --frames",
             With{.shown = "", .then = chosen(Way::rotate), .commands = kAnimate}},
            {"--walk MOVE", move,
             "turn, forward, backward, left or right, from the view of the command line. Needs "
             "--frames",
             With{.shown = "", .then = chosen(Way::walk), .commands = kAnimate}},
            {"--step PERCENT", &walk.step,
             "length of a step of --walk, as a share of the field of view: a turn's step is that "
             "share of -vh; a step sideways shifts what the middle of the first picture shows by "
             "that share of the picture's width; steps forward and backward are as long",
             kPercentage},
            {"--frames N", &walk.frames, "number of frames",
             With{.least = 1, .most = 1'000'000, .shown = ""}},
            {"--fps N", &walk.rate, "of a film: frames a second",
             With{.least = .1, .most = 1000, .commands = kAnimate}}};
}

Choice reuse_choice(WalkCommand& walk) {
    return {{"off", "cloud", "supersaturated"},
            [&walk](std::size_t i) {
                walk.reuse = i > 0;
                walk.cloud.supersaturated = i == 2;
            },
            [&walk] { return !walk.reuse                 ? 0U
                             : walk.cloud.supersaturated ? 2U
                                                         : 1U; }};
}

Choice drop_choice(ReuseRules& rules) {
    return {{"both", "hidden", "lonely", "none"},
            [&rules](std::size_t i) {
                rules.drop_hidden = i == 0 || i == 1;
                rules.drop_lonely = i == 0 || i == 2;
            },
            [&rules] { return (rules.drop_hidden ? 0U : 2U) + (rules.drop_lonely ? 0U : 1U); }};
}

std::vector<OptionRow> reuse_rows(WalkCommand& walk, int& projectors) {
    CloudOptions& cloud = walk.cloud;
    ReuseRules& rules = cloud.rules;
    return {{"Reuse. Every traced pixel leaves a point: where its light came from, and how much. "
             "Later\n"
             "frames take points instead of rays wherever these are true",
             SectionTitle{"animate"}},
            {"--reuse WHAT", reuse_choice(walk),
             "off: every pixel of every frame is traced; cloud: a point lasts while each frame "
             "uses it; supersaturated: others stay, too, until they leave the view or grow old"},
            {"--cloud-age N", &cloud.age,
             "with --reuse supersaturated: number of frames for which an unused point is kept",
             With{.least = 0, .most = kOldestAge - 1}},
            {"--cloud-limit N", &cloud.limit, "at most N times as many points as pixels are kept",
             With{.least = 2, .most = 64}},  // a pixel leaves up to two points
            {"--check WHICH",
             choice(cloud.check, {{"all", CloudCheck::all},
                                  {"rotating", CloudCheck::rotating},
                                  {"edges", CloudCheck::edges},
                                  {"none", CloudCheck::none}}),
             "pixels for which a ray tells what is there, so that no other thing's point shows: "
             "all; rotating: all but those in the midst of a surface that the last frame has "
             "shown; of these a third, another one in each frame; edges: where points are missing "
             "or jump in depth, and the picture's rim; none"},
            {"--drop WHICH", drop_choice(rules),
             "which points are dropped where no ray tells what is there: hidden: those far behind "
             "most of those around them; lonely: those far from all around them; both; none"},
            {"--look WHERE", choice(rules.look_back, {{"back", true}, {"forward", false}}),
             "back: a pixel takes the nearest point of what its ray meets; forward: only a point "
             "that falls onto it"},
            {"--near PIXELS", &rules.near,
             "with --look back: a point this near to the pixel answers it", kAroundPixel},
            {"--reach PIXELS", &rules.reach,
             "with --look back: where the points around agree, one this near answers the pixel",
             kAroundPixel},
            {"--contrast PERCENT", &rules.contrast,
             "with --look back: points agree when the darkest and the brightest differ by no more",
             kPercentage},
            {"--projectors N", &projectors,
             "number of ranks that keep points, at most; further ranks trace what is missing",
             With{.least = 1, .most = 4096}}};
}

std::vector<OptionRow> quality_rows(CloudOptions& cloud) {
    return {{"Errors of reused pixels, and the time of a frame", SectionTitle{"animate"}},
            {"--specular-tolerance PERCENT", &cloud.tolerance,
             "error allowed in a reused colour that depends on the view; beyond, it is traced anew",
             kPercentage},
            {"--audit PERCENT", &cloud.audit,
             "share of the reused pixels that is traced all the same, to measure errors, a quarter "
             "of them twice; --stats has the errors, and how much two rays of a pixel differ",
             kPercentage},
            {"--audit-limit PERCENT", &cloud.audit_limit,
             "when so many more of the audited pixels are off by a tenth than two rays differ by "
             "as much, reuse is tightened (ages, angles, distances) until it holds, then slowly "
             "loosened; 0: never",
             With{.least = 0, .most = 1000, .divisor = kPercent}},
            {"--budget MS", &cloud.budget,
             "time for a frame [ms]: the pixels that lack points most are traced first; those that "
             "do not fit are interpolated, and traced in a later frame; 0: all are traced",
             With{.least = 0, .most = 1e6, .divisor = 1000}},
            {"--refine PERCENT", &cloud.refine,
             "when a frame has the view of the frame before, that share of its pixels is made "
             "better: those interpolated, then those reused, oldest first, then, with further "
             "rays, those at steps of brightness",
             kPercentage}};
}

CustomOption size_option(WalkSizeLimit& size) {
    const auto read_side = [](const std::string& word, int& side) {
        long number = 0;
        const bool good = parse_integer(word, number) && number >= 1 && number <= kLargestWalkSize;
        if (good) side = static_cast<int>(number);
        return good;
    };
    const auto take = [&size, read_side](OptionWords& words) {
        const std::string word = words.text();
        const std::size_t by = std::min(word.find('x'), word.size());
        if (by == word.size() || !read_side(word.substr(0, by), size.width) ||
            !read_side(word.substr(by + 1), size.height))
            refuse_argument(
                "--max-size",
                "WIDTHxHEIGHT of at most " + std::to_string(kLargestWalkSize) + " pixels",
                '"' + word + '"');
    };
    return {take,
            [&size] { return std::to_string(size.width) + 'x' + std::to_string(size.height); }};
}

/// Origins become a part of a header, in which they must stay what they are.
CustomOption embedders_option(std::string& origins) {
    return {[&origins](OptionWords& words) {
        origins = words.text();
        constexpr const char* kBelong =
            "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789 :/.*-[]";
        if (origins.find_first_not_of(' ') == std::string::npos ||
            origins.find_first_not_of(kBelong) != std::string::npos)
            refuse_argument("--embed", "origins: http://localhost:*", '"' + origins + '"');
    }};
}

}  // namespace

std::vector<OptionRow> walk_option_rows(WalkCommand& walk, int& projectors) {
    std::vector<OptionRow> rows = way_rows(walk);
    for (const auto& more : {reuse_rows(walk, projectors), quality_rows(walk.cloud)})
        rows.insert(rows.end(), more.begin(), more.end());
    return rows;
}

std::vector<OptionRow> serve_option_rows(ServeCommand& serve) {
    return {
        {"The page, and who may open it", SectionTitle{}},
        {"--port N", &serve.server.port, "port of the page; 0: any that is free",
         With{.least = 0, .most = 65535}},
        {"--bind ADDRESS", &serve.server.address,
         "address that the page is served on. 127.0.0.1: to this machine alone. Anything else "
         "demands the token in the printed address"},
        {"--embed ORIGINS", embedders_option(serve.server.embedders),
         "pages that may show this one within them, a notebook's say, by their origins, in one "
         "word "
         "with spaces between them: \"http://localhost:* http://127.0.0.1:*\""},
        {"--clients N", &serve.server.limits.clients,
         "number of browsers at once: the first drives, others watch",
         With{.least = 1, .most = 256}},
        {"--fps N", &serve.page.fps,
         "frames a second while moving; half as many where that leaves no time for large ones, for "
         "pages that draw the camera between them. "
         "A frame's time goes to its worst pixels; the others are interpolated now, and traced "
         "in a later frame",
         With{.least = .1, .most = 1000}},
        {"--max-size WxH", size_option(serve.page.max_size),
         "largest size of pictures; larger windows show them enlarged"},
        {"--ambient WHEN",
         choice(serve.page.settings.ambient, {{"rest", WalkAmbient::rest},
                                              {"always", WalkAmbient::always},
                                              {"off", WalkAmbient::off}}),
         "when there is indirect light, with -ab: rest: when the view rests; always; off. The "
         "page may change it"},
        {"--edge-samples N", &serve.edge_samples,
         "rays that a pixel at an edge gets when the view rests; 1: the picture of `lightwalk "
         "render`",
         With{.least = 1, .most = 255}},
        {"--denoise", &serve.denoise,
         "the page offers to show pictures at rest without the noise that is left, by Open Image "
         "Denoise where it is installed (libOpenImageDenoise of version 1 or 2). What is measured, "
         "false colours and what is saved as .hdr stay as they were traced"},
        {"--beside FILES", &serve.beside,
         "octree, frozen scene or scene files, in one word with spaces between them, that the page "
         "shows beside the walk's scene where somebody compares; else that is the scene itself, at "
         "another time, under other dimmers or of other materials"},
        {"--watch WHEN", choice(serve.watch, {{"on", true}, {"off", false}}),
         "whether files of the scene that are edited are read again, beside the frames: what has "
         "not changed stays. On ranks the walk begins anew"}};
}

void resolve_walk(WalkCommand& walk, const View& view, FileSource& files) {
    if (walk.way == WalkCommand::Way::none)
        throw UsageError("no walk: say --path FILE, --rotate DEGREES or --walk MOVE");
    if (walk.way != WalkCommand::Way::path && walk.frames == 0)
        throw UsageError("--rotate and --walk need --frames N");
    if (walk.way == WalkCommand::Way::path)
        walk.keys = read_view_keys(files.read(walk.path), walk.path, view);
}

std::size_t walk_length(const WalkCommand& walk) {
    return walk.frames > 0 ? static_cast<std::size_t>(walk.frames) : walk.keys.size();
}

std::vector<View> walk_views(const WalkCommand& walk, const View& view, const Scene& scene) {
    using Way = WalkCommand::Way;
    std::vector<View> views(walk_length(walk));
    const int steps = std::max(walk.frames - 1, 1);
    int i = 0;
    if (walk.way == Way::path && walk.frames == 0) {
        std::ranges::transform(walk.keys, views.begin(), &ViewKey::view);
    } else if (walk.way == Way::path) {
        const ViewPath path(walk.keys);
        const double pace = (path.end() - path.begin()) / steps;
        for (View& frame : views) frame = path.at(path.begin() + i++ * pace);
    } else if (walk.way == Way::rotate) {
        for (View& frame : views) frame = turned_view(view, i++ * walk.degrees / steps);
    } else {
        const Camera camera(view);
        const Hit middle = scene.geometry().intersect({view.position, camera.forward()});
        const double distance = middle.exists() ? middle.t : length(view.direction);
        for (View& frame : views) frame = walked_view(view, walk.move, i++, walk.step, distance);
    }
    return views;
}

}  // namespace lightwalk
