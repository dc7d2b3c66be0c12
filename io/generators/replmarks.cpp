// replmarks: put objects, instances or meshes in the place of marker polygons. See Radiance's
// manual page replmarks(1).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <utility>
#include <vector>

#include "io/generators/generator.h"
#include "io/generators/generator_words.h"
#include "io/generators/scene_writer.h"
#include "io/language/command_line.h"
#include "io/language/primitive_text.h"
#include "io/language/tokenizer.h"

namespace lightwalk {
namespace {

constexpr std::string_view kReplmarksUsage =
    "[-e] {[-s size] [-m modifier] {-x objfile | -i octree | -I mesh} markmod}... [file...]";
constexpr std::size_t kMaxGroups = 128;
constexpr int kDeepestCommand = 64;  ///< commands whose output holds commands ...
constexpr int kExactDigits = 17;     ///< copies numbers without rounding
constexpr double kDegrees = 180 / kPi;

enum class Replacement { none, object, octree, mesh };

/// The replacement of the markers with one modifier.
struct MarkerGroup {
    std::string marker_modifier;
    Replacement replacement = Replacement::none;
    std::string file;
    std::string modifier;  ///< new modifier of the replacement; "" to keep its own
    double size = 0;  ///< scale of the replacement for a marker whose x side is 1; 0 for no scaling
};

struct ReplmarksOptions {
    std::vector<MarkerGroup> groups;
    std::vector<std::string> files;
    bool expand = false;  ///< run commands, of the input and our own
};

/// Take the options of one group; false when the next word is none.
bool accept_group_option(GeneratorWords& words, MarkerGroup& group) {
    constexpr std::array<std::pair<std::string_view, Replacement>, 3> kReplacements = {
        {{"-x", Replacement::object}, {"-i", Replacement::octree}, {"-I", Replacement::mesh}}};
    for (const auto& [option, replacement] : kReplacements) {
        if (!words.accept(option)) continue;
        group.replacement = replacement;
        group.file = words.text("file");
        return true;
    }
    if (words.accept("-s"))
        group.size = words.real("size");
    else if (words.accept("-m"))
        group.modifier = words.text("modifier");
    else
        return false;
    return true;
}

bool is_option(const GeneratorWords& words) {
    return !words.at_end() && words.peek().size() > 1 && words.peek()[0] == '-';
}

ReplmarksOptions parse_replmarks(GeneratorWords& words) {
    ReplmarksOptions options;
    double size = 0;
    do {
        MarkerGroup group;
        group.size = size;
        while (is_option(words)) {
            if (words.accept("-e"))
                options.expand = true;
            else if (!accept_group_option(words, group))
                words.unknown_option();
        }
        group.marker_modifier = words.text("marker modifier");
        if (group.replacement == Replacement::none) {
            words.fail("missing -x, -i or -I for \"" + group.marker_modifier + "\"");
        }
        if (options.groups.size() == kMaxGroups) {
            words.fail("more than " + std::to_string(kMaxGroups) + " markers");
        }
        size = group.size;
        options.groups.push_back(std::move(group));
    } while (is_option(words));
    while (!words.at_end()) options.files.push_back(words.text("file"));
    return options;
}

/// A marker's own coordinates.
struct MarkerFrame {
    Vec3 origin;
    double length = 0;  ///< length of the x side
    Vec3 x, y, z;       ///< unit vectors
};

/// The longest side is the hypotenuse, the second is the x axis, the third shows where y is; the
/// origin is where these two meet. Nothing when they do not, or lie on a line.
std::optional<MarkerFrame> marker_frame(std::span<const double> reals) {
    const std::size_t n = reals.size() / 3;
    if (reals.size() % 3 != 0 || n < 3 || n > 6) return std::nullopt;
    const auto vertex = [&](std::size_t i) {
        return Vec3{reals[3 * (i % n)], reals[3 * (i % n) + 1], reals[3 * (i % n) + 2]};
    };
    std::vector<std::size_t> sides(n);
    for (std::size_t i = 0; i < n; ++i) sides[i] = i;
    std::ranges::stable_sort(sides, [&](std::size_t a, std::size_t b) {
        return length_squared(vertex(a + 1) - vertex(a)) >
               length_squared(vertex(b + 1) - vertex(b));
    });
    const std::size_t x_side = sides[1];
    const std::size_t y_side = sides[2];
    const bool y_follows = y_side == (x_side + 1) % n;
    if (!y_follows && x_side != (y_side + 1) % n) return std::nullopt;
    const std::size_t origin = y_follows ? y_side : x_side;
    const Vec3 before = vertex(origin + n - 1) - vertex(origin);
    const Vec3 after = vertex(origin + 1) - vertex(origin);
    MarkerFrame frame;
    frame.origin = vertex(origin);
    frame.length = length(y_follows ? before : after);
    frame.x = normalize(y_follows ? before : after);
    frame.z = normalize(cross(frame.x, y_follows ? after : before));
    frame.y = cross(frame.z, frame.x);
    const bool usable = length_squared(frame.z) > 0 && std::isfinite(frame.length + frame.z.x);
    return usable ? std::optional(frame) : std::nullopt;
}

void add_words(const char* option, std::initializer_list<double> values,
               std::vector<std::string>& words) {
    words.emplace_back(option);
    for (const double value : values) words.push_back(fixed(value, 6));
}

/// Rotation from the axes to the frame's: about x, then y, then z; angles near 0 are left out.
void add_rotation(const MarkerFrame& frame, std::vector<std::string>& words) {
    if (frame.y.z * frame.y.z + frame.z.z * frame.z.z < 2 * kEpsilon * kEpsilon) {
        add_words("-ry", {frame.x.z < 0 ? 90.0 : -90.0}, words);
        add_words("-rz", {-std::atan2(frame.y.x, frame.y.y) * kDegrees}, words);
        return;
    }
    const std::array<std::pair<const char*, double>, 3> turns = {
        {{"-rx", std::atan2(frame.y.z, frame.z.z)},
         {"-ry", std::asin(std::clamp(-frame.x.z, -1.0, 1.0))},
         {"-rz", std::atan2(frame.x.y, frame.x.x)}}};
    for (const auto& [option, angle] : turns) {
        if (std::abs(angle) > kEpsilon) add_words(option, {angle * kDegrees}, words);
    }
}

std::vector<std::string> transform_words(const MarkerFrame& frame, double size) {
    std::vector<std::string> words;
    if (size > 0) add_words("-s", {frame.length * size}, words);
    add_rotation(frame, words);
    add_words("-t", {frame.origin.x, frame.origin.y, frame.origin.z}, words);
    return words;
}

/// The command that writes the object in the marker's place.
std::string object_command(const MarkerGroup& group, const std::string& name,
                           const std::vector<std::string>& transform) {
    std::string command = "!xform -n " + quoted_for_shell(name);
    if (!group.modifier.empty()) command += " -m " + quoted_for_shell(group.modifier);
    for (const std::string& word : transform) command += " " + word;
    return command + " " + quoted_for_shell(group.file);
}

/// The instance or mesh in the marker's place.
PrimitiveText reference_primitive(const MarkerGroup& group, const std::string& name,
                                  const std::vector<std::string>& transform) {
    PrimitiveText primitive;
    primitive.modifier = group.modifier.empty() ? "void" : group.modifier;
    primitive.type_word = group.replacement == Replacement::octree ? "instance" : "mesh";
    primitive.name = name;
    primitive.strings.push_back(group.file);
    primitive.strings.insert(primitive.strings.end(), transform.begin(), transform.end());
    return primitive;
}

class Replmarks {
  public:
    Replmarks(std::span<const std::string> args, GeneratorContext& context)
        : context_(context), out_(command_comment(args)) {
        GeneratorWords words(args, kReplmarksUsage);
        options_ = parse_replmarks(words);
    }

    std::string run() {
        if (options_.files.empty()) copy(context_.standard_input(), "standard input", 0);
        for (const std::string& file : options_.files) {
            const std::string path = path_from(context_.directory, file);
            copy(file == "-" ? context_.standard_input()
                             : context_.library.files().read(path, kMaxGeneratedBytes),
                 file == "-" ? "standard input" : path, 0);
        }
        return std::move(out_);
    }

  private:
    void copy(std::string_view text, const std::string& name, int depth) {
        if (depth > kDeepestCommand)
            throw CommandError({name, 0}, "commands that write commands nest too deep");
        SceneTokenizer tokens(text, name);
        for (auto item = tokens.peek(); item != SceneTokenizer::Item::end; item = tokens.peek()) {
            if (item == SceneTokenizer::Item::comment) {
                out_ += tokens.comment();
                out_ += "\n";
            } else if (item == SceneTokenizer::Item::command) {
                copy_command(tokens, depth);
            } else {
                copy_primitive(read_primitive(tokens));
            }
            if (out_.size() > kMaxGeneratedBytes) throw InputError("replmarks: too much output");
        }
    }

    void copy_command(SceneTokenizer& tokens, int depth) {
        const std::string location = to_prefix(tokens.where());
        const std::string command = tokens.command();
        if (options_.expand) {
            copy(context_.run_command(command, context_.directory),
                 location + abbreviate_command(command), depth + 1);
        } else {
            out_ += "\n" + command + "\n";
        }
    }

    void copy_primitive(const PrimitiveText& primitive) {
        const auto group =
            std::ranges::find(options_.groups, primitive.modifier, &MarkerGroup::marker_modifier);
        if (primitive.type == PrimitiveType::polygon && group != options_.groups.end()) {
            replace(primitive, *group);
        } else {
            write_primitive(primitive, kExactDigits, out_);
        }
    }

    void replace(const PrimitiveText& marker, const MarkerGroup& group) {
        const std::optional<MarkerFrame> frame = marker_frame(marker.reals);
        if (!frame) {
            throw InputError(marker.where,
                             "bad arguments for marker \"" + marker.name +
                                 "\", expected 3 to 6 vertices whose second and third "
                                 "longest sides meet at an angle");
        }
        const std::vector<std::string> transform = transform_words(*frame, group.size);
        if (group.replacement != Replacement::object) {
            write_primitive(reference_primitive(group, marker.name, transform), kExactDigits, out_);
            return;
        }
        const std::string command = object_command(group, marker.name, transform);
        if (options_.expand)
            out_ += context_.run_command(command, context_.directory);
        else
            out_ += "\n" + command + "\n";
    }

    GeneratorContext& context_;
    ReplmarksOptions options_;
    std::string out_;
};

}  // namespace

std::string run_replmarks(std::span<const std::string> args, GeneratorContext& context) {
    return Replmarks(args, context).run();
}

}  // namespace lightwalk
