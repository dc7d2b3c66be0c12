#include "apps/walk_command.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include "core/scene/scene.h"
#include "io/options/view_keys.h"

namespace lightwalk {
namespace {

constexpr int kMostFrames = 1'000'000;
constexpr int kMostProjectors = 4096;

template <class Value, std::size_t kCount>
Value named_value(OptionWords& words,
                  const std::array<std::pair<const char*, Value>, kCount>& values) {
    const std::string option = words.option(), word = words.text();
    std::string expected;
    for (const auto& [name, value] : values) {
        if (word == name) return value;
        if (!expected.empty()) expected += ", ";
        expected += name;
    }
    throw UsageError("option " + option + ": expected one of " + expected + ", found \"" + word +
                     "\"");
}

double share(OptionWords& words, double most) {
    const std::string option = words.option();
    const double percent = words.real();
    if (!(percent >= 0) || percent > most)
        throw UsageError("option " + option + ": expected a percentage from 0 to " +
                         std::to_string(static_cast<int>(most)));
    return percent / 100;
}

double real_between(OptionWords& words, double least, double most) {
    const std::string option = words.option();
    const double number = words.real();
    if (!(number >= least) || number > most) {
        std::array<char, 64> range{};
        std::snprintf(range.data(), range.size(), "from %g to %g", least, most);
        throw UsageError("option " + option + ": expected a number " + range.data());
    }
    return number;
}

void set_way(WalkCommand& walk, WalkCommand::Way way) {
    if (walk.way != WalkCommand::Way::none && walk.way != way)
        throw UsageError("--path, --rotate and --walk: only one of them");
    walk.way = way;
}

bool parse_way(OptionWords& words, WalkCommand& walk) {
    const std::string word = words.option();
    if (word == "--path") {
        set_way(walk, WalkCommand::Way::path);
        walk.path = words.text();
    } else if (word == "--rotate") {
        set_way(walk, WalkCommand::Way::rotate);
        walk.degrees = words.real();
    } else if (word == "--walk") {
        set_way(walk, WalkCommand::Way::walk);
        walk.move = named_value(
            words,
            std::array{std::pair{"turn", WalkMove::turn}, std::pair{"forward", WalkMove::forward},
                       std::pair{"backward", WalkMove::backward}, std::pair{"left", WalkMove::left},
                       std::pair{"right", WalkMove::right}});
    } else if (word == "--step") {
        walk.step = share(words, 100);
    } else if (word == "--frames") {
        walk.frames = whole_number(words, 1, kMostFrames);
    } else if (word == "--fps") {
        walk.rate = real_between(words, 0.1, 1000);
    } else {
        return false;
    }
    return true;
}

void set_reuse(OptionWords& words, WalkCommand& walk) {
    enum class Reuse { off, cloud, supersaturated };
    const Reuse reuse = named_value(
        words, std::array{std::pair{"off", Reuse::off}, std::pair{"cloud", Reuse::cloud},
                          std::pair{"supersaturated", Reuse::supersaturated}});
    walk.reuse = reuse != Reuse::off;
    walk.cloud.supersaturated = reuse == Reuse::supersaturated;
}

void set_drop(OptionWords& words, ReuseRules& rules) {
    enum class Drop { both, hidden, lonely, none };
    const Drop drop = named_value(
        words, std::array{std::pair{"both", Drop::both}, std::pair{"hidden", Drop::hidden},
                          std::pair{"lonely", Drop::lonely}, std::pair{"none", Drop::none}});
    rules.drop_hidden = drop == Drop::both || drop == Drop::hidden;
    rules.drop_lonely = drop == Drop::both || drop == Drop::lonely;
}

/// Which points answer a pixel.
bool parse_rule(OptionWords& words, ReuseRules& rules) {
    const std::string word = words.option();
    constexpr double kFarthest = 1.5;  // of what the pixels beside a pixel hold
    if (word == "--look")
        rules.look_back =
            named_value(words, std::array{std::pair{"back", true}, std::pair{"forward", false}});
    else if (word == "--near")
        rules.near = static_cast<float>(real_between(words, 0, kFarthest));
    else if (word == "--reach")
        rules.reach = static_cast<float>(real_between(words, 0, kFarthest));
    else if (word == "--contrast")
        rules.contrast = static_cast<float>(share(words, 100));
    else if (word == "--drop")
        set_drop(words, rules);
    else
        return false;
    return true;
}

/// How the frames watch over themselves and their time.
bool parse_care(OptionWords& words, CloudOptions& cloud) {
    const std::string word = words.option();
    constexpr double kMostMilliseconds = 1e6;
    if (word == "--audit")
        cloud.audit = share(words, 100);
    else if (word == "--audit-limit")
        cloud.audit_limit = share(words, 1000);
    else if (word == "--budget")
        cloud.budget = real_between(words, 0, kMostMilliseconds) / 1000;
    else if (word == "--refine")
        cloud.refine = share(words, 100);
    else
        return false;
    return true;
}

}  // namespace

int whole_number(OptionWords& words, int least, int most) {
    const std::string option = words.option();
    const int number = words.integer();
    if (number < least || number > most)
        throw UsageError("option " + option + ": expected a number from " + std::to_string(least) +
                         " to " + std::to_string(most));
    return number;
}

bool parse_walk_option(OptionWords& words, WalkCommand& walk) {
    if (parse_way(words, walk) || parse_rule(words, walk.cloud.rules) ||
        parse_care(words, walk.cloud))
        return true;
    const std::string word = words.option();
    if (word == "--reuse")
        set_reuse(words, walk);
    else if (word == "--cloud-age")
        walk.cloud.age = whole_number(words, 0, kOldestAge - 1);
    else if (word == "--cloud-limit")
        walk.cloud.limit = real_between(words, 2, 64);  // a pixel leaves up to two points
    else if (word == "--check")
        walk.cloud.check =
            named_value(words, std::array{std::pair{"all", CloudCheck::all},
                                          std::pair{"rotating", CloudCheck::rotating},
                                          std::pair{"edges", CloudCheck::edges},
                                          std::pair{"none", CloudCheck::none}});
    else if (word == "--projectors")
        walk.projectors = whole_number(words, 1, kMostProjectors);
    else if (word == "--specular-tolerance")
        walk.cloud.tolerance = share(words, 100);
    else
        return false;
    return true;
}

std::vector<std::string> walk_option_names() {
    return {"--path",        "--rotate",      "--walk",     "--step",
            "--frames",      "--fps",         "--reuse",    "--cloud-age",
            "--cloud-limit", "--check",       "--drop",     "--look",
            "--near",        "--reach",       "--contrast", "--specular-tolerance",
            "--audit",       "--audit-limit", "--budget",   "--refine",
            "--projectors"};
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
    std::vector<View> views;
    if (walk.way == WalkCommand::Way::path && walk.frames == 0) {
        for (const ViewKey& key : walk.keys) views.push_back(key.view);
        return views;
    }
    if (walk.way == WalkCommand::Way::path) {
        const ViewPath path(walk.keys);
        const double pace = (path.end() - path.begin()) / std::max(walk.frames - 1, 1);
        for (int i = 0; i < walk.frames; ++i) views.push_back(path.at(path.begin() + i * pace));
        return views;
    }
    if (walk.way == WalkCommand::Way::rotate) {
        for (int i = 0; i < walk.frames; ++i)
            views.push_back(turned_view(view, i * walk.degrees / std::max(walk.frames - 1, 1)));
        return views;
    }
    const Camera camera(view);
    const Hit middle = scene.geometry().intersect({view.position, camera.forward()});
    const double distance = middle.exists() ? middle.t : length(view.direction);
    for (int i = 0; i < walk.frames; ++i)
        views.push_back(walked_view(view, walk.move, i, walk.step, distance));
    return views;
}

}  // namespace lightwalk
