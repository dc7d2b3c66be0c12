#include "io/scene/scene_reader.h"

#include <cstddef>
#include <utility>
#include <vector>

#include "core/model/model_builder.h"
#include "io/language/primitive_text.h"
#include "io/language/tokenizer.h"
#include "io/scene/binary_models.h"
#include "io/scene/command_runner.h"

namespace lightwalk {
namespace {

constexpr int kMaxDepth = 64;  ///< commands that write commands that write commands ...

/// The bytes of one argument, and what messages call it.
struct SceneText {
    std::string bytes, name;
};

class SceneReader {
  public:
    SceneReader(const SceneReadOptions& options, WarningSink& warnings)
        : directory_(options.directory),
          runner_(options.library, options.allow_commands, warnings),
          warnings_(warnings) {}

    /// Open a scene argument: a file, "-", or "!command".
    SceneText open(const std::string& argument) {
        if (argument == "-") return {read_file("/dev/stdin"), "standard input"};
        if (!argument.empty() && argument[0] == '!') {
            return {runner_.run(argument, directory_, {abbreviate_command(argument), 0}),
                    abbreviate_command(argument)};
        }
        const std::string path = path_from(directory_, argument);
        return {read_file(path), path};
    }

    void read(std::string_view text, const std::string& name) { read_text(text, name, nullptr, 0); }

    [[nodiscard]] std::size_t size() const { return builder_.primitives().size(); }
    [[nodiscard]] std::shared_ptr<Model> take() { return builder_.take(); }

  private:
    /// `outer` is where the command stands whose output this is; null for files.
    void read_text(std::string_view text, const std::string& name, const SourceLocation* outer,
                   int depth) {
        const std::size_t before = builder_.primitives().size();
        SceneTokenizer tokens(text, name);
        for (auto item = tokens.peek(); item != SceneTokenizer::Item::end; item = tokens.peek()) {
            switch (item) {
                case SceneTokenizer::Item::comment:
                    tokens.comment();
                    break;
                case SceneTokenizer::Item::command:
                    run_command(tokens, outer, depth);
                    break;
                default:
                    read_item(tokens, outer);
            }
        }
        if (builder_.primitives().size() == before) warnings_.warn(name + ": empty file");
    }

    void run_command(SceneTokenizer& tokens, const SourceLocation* outer, int depth) {
        const SourceLocation where = outer != nullptr ? *outer : tokens.where();
        const std::string command = tokens.command();
        if (depth >= kMaxDepth) {
            throw InputError(where, "commands write commands more than " +
                                        std::to_string(kMaxDepth) + " levels deep");
        }
        const std::string output = runner_.run(command, directory_, where);
        read_text(output, to_prefix(where) + abbreviate_command(command), &where, depth + 1);
    }

    void read_item(SceneTokenizer& tokens, const SourceLocation* outer) {
        PrimitiveText text = read_primitive_head(tokens);
        const bool inherits = text.modifier == "inherit";
        std::int32_t modifier = kVoidIndex;
        if (!inherits) modifier = builder_.modifier(text.modifier, text.where);
        resolve_type(text);
        const bool is_alias = text.type == PrimitiveType::alias;
        if (inherits && !is_alias) {
            throw InputError(text.where,
                             "inappropriate use of 'inherit' modifier: only an alias inherits");
        }
        read_primitive_arguments(tokens, text);
        const SourceLocation where = outer != nullptr ? *outer : text.where;
        if (!is_alias) {
            builder_.add({text.type,
                          modifier,
                          std::move(text.name),
                          std::move(text.strings),
                          std::move(text.reals),
                          {},
                          where});
            return;
        }
        const std::int32_t target = builder_.alias_target(text.strings[0], text.where);
        if (inherits)
            builder_.rename(text.name, target, where);
        else
            builder_.add_alias(modifier, text.name, target, where);
    }

    std::string directory_;
    ModelBuilder builder_;
    CommandRunner runner_;
    WarningSink& warnings_;
};

}  // namespace

std::shared_ptr<const Model> read_octree(std::string_view bytes, const std::string& name,
                                         const SceneReadOptions& options, WarningSink& warnings) {
    OctreeContents contents = decode_octree(bytes, name);
    if (contents.model) return contents.model;
    SceneReader reader(options, warnings);
    for (const std::string& file : contents.scene_files) {
        const SceneText text = reader.open(file);
        reader.read(text.bytes, text.name);
    }
    if (reader.size() != contents.objects) {
        throw InputError({name, 0}, "bad object count; octree stale? Its scene files hold " +
                                        std::to_string(reader.size()) + " primitives, expected " +
                                        std::to_string(contents.objects));
    }
    std::shared_ptr<Model> model = reader.take();
    model->header = std::move(contents.header);
    model->cube = contents.cube;
    return model;
}

std::shared_ptr<const Model> read_scene(std::span<const std::string> files,
                                        const SceneReadOptions& options, WarningSink& warnings) {
    if (files.empty()) throw InputError("no scene: expected one octree, or scene files");
    SceneReader reader(options, warnings);
    for (const std::string& file : files) {
        const SceneText text = reader.open(file);
        if (!is_octree(text.bytes)) {
            reader.read(text.bytes, text.name);
            continue;
        }
        if (files.size() > 1) {
            throw InputError({text.name, 0}, "an octree is a whole scene, expected no other files");
        }
        return read_octree(text.bytes, text.name, options, warnings);
    }
    return reader.take();
}

std::shared_ptr<const Model> parse_scene(std::string_view text, const std::string& name,
                                         const SceneReadOptions& options, WarningSink& warnings) {
    SceneReader reader(options, warnings);
    reader.read(text, name);
    return reader.take();
}

}  // namespace lightwalk
