#pragma once
// Runs a generator like a command of a scene, and parses its output.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "core/math/vec3.h"
#include "io/generators/generator.h"
#include "io/language/command_line.h"
#include "io/language/primitive_text.h"
#include "io/language/tokenizer.h"
#include "io/scene/command_runner.h"
#include "tests/test_scene.h"

namespace lightwalk::test {

struct Generated {
    std::string text;
    std::vector<std::string> warnings;
    std::vector<PrimitiveText> primitives;
    std::vector<std::string> commands;  ///< commands in the output
};

struct GeneratorInput {
    std::string directory, text;
};

/// The output of `command`, which is divided into words as by a shell; warnings go to `sink`.
inline std::string generate_text(const std::string& command, const GeneratorInput& input,
                                 Silence& sink) {
    const auto pipelines = split_command(command);
    REQUIRE(pipelines);
    std::vector<std::string> args;
    for (const CommandWord& word : pipelines->at(0).at(0)) args.push_back(word.text);
    const LibraryPath library = LibraryPath({"."}).relative_to(input.directory);
    CommandRunner runner(LibraryPath({"."}), false, sink);
    GeneratorContext context{library, input.directory, input.text, !input.text.empty(), sink, {}};
    context.run_command = [&](const std::string& text, const std::string& directory) {
        return runner.run(text, directory, {"outer.rad", 1});
    };
    const Generator generator = find_generator(args[0]);
    const bool known = generator != nullptr;
    REQUIRE(known);
    return generator(args, context);
}

/// The output of `command`, parsed as a scene.
inline Generated generate(const std::string& command, const GeneratorInput& input = {}) {
    Silence sink;
    Generated result;
    result.text = generate_text(command, input, sink);
    result.warnings = sink.messages;
    SceneTokenizer tokens(result.text, "generated");
    for (auto item = tokens.peek(); item != SceneTokenizer::Item::end; item = tokens.peek()) {
        if (item == SceneTokenizer::Item::comment)
            static_cast<void>(tokens.comment());
        else if (item == SceneTokenizer::Item::command)
            result.commands.push_back(tokens.command());
        else
            result.primitives.push_back(read_primitive(tokens));
    }
    return result;
}

/// The message of the InputError that the command throws; "" when it throws none.
inline std::string generator_error(const std::string& command, const GeneratorInput& input = {}) {
    try {
        static_cast<void>(generate(command, input));
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

inline std::vector<std::string> names(const Generated& generated) {
    std::vector<std::string> result;
    for (const PrimitiveText& primitive : generated.primitives) result.push_back(primitive.name);
    return result;
}

inline Vec3 vertex(const PrimitiveText& primitive, std::size_t i) {
    return {primitive.reals.at(3 * i), primitive.reals.at(3 * i + 1),
            primitive.reals.at(3 * i + 2)};
}

/// Unit normal of a polygon, by the right-hand rule.
inline Vec3 polygon_normal(const PrimitiveText& polygon) {
    Vec3 sum;
    for (std::size_t i = 1; i + 1 < polygon.reals.size() / 3; ++i) {
        sum += cross(vertex(polygon, i) - vertex(polygon, 0),
                     vertex(polygon, i + 1) - vertex(polygon, 0));
    }
    return normalize(sum);
}

/// The rounding error of three coordinates below 10 that are printed with twelve digits: half a
/// unit of the last digit of each.
inline constexpr double kPrinted = 1.5e-11;

inline bool near(const Vec3& a, const Vec3& b, double tolerance = kPrinted) {
    return length(a - b) <= tolerance;
}

}  // namespace lightwalk::test
