#include "io/scene/scene_reader.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/model/model_builder.h"
#include "io/files/forget_pages.h"
#include "io/generators/sky_command.h"
#include "io/generators/text_sink.h"
#include "io/language/command_line.h"
#include "io/language/primitive_text.h"
#include "io/language/tokenizer.h"
#include "io/scene/binary_models.h"
#include "io/scene/command_runner.h"
#include "io/scene/model_scene.h"
#include "io/scene/obj_scene.h"

namespace lightwalk {
namespace {

constexpr std::string_view kHeaderMark = "#?";  ///< with which octrees begin
constexpr int kMaxNesting = 64;  ///< commands that write commands that write commands ...

/// What programs write into files whose names end so is never scene text. Where text is to be read
/// from one, a program has left it that failed: empty, cut off in its header, or an error message.
/// It must not pass for a scene of nothing.
void refuse_binary_names(std::string_view bytes, const std::string& name) {
    constexpr std::array<std::pair<std::string_view, const char*>, 3> kKinds{
        {{".oct", "an octree"}, {".lwz", "a frozen scene"}, {".rtm", "scene text, but a mesh"}}};
    for (const auto& [ending, kind] : kKinds) {
        if (!name.ends_with(ending)) continue;
        throw InputError({name, 0},
                         std::string("not ") + kind + (bytes.empty() ? ": the file is empty" : ""));
    }
}

/// The bytes of one argument, and what messages call it.
struct SceneText {
    std::string bytes, name;
};

/// Files that a generator makes a scene of, by their ending.
constexpr std::array<std::pair<std::string_view, const char*>, 2> kConverters = {
    {{".ies", "ies2rad"}, {".ldt", "ldt2rad"}}};

/// The generator for a file of this name; null for scene files and octrees.
const char* converter_of(const std::string& name) {
    for (const auto& [ending, program] : kConverters) {
        if (has_ending(name, ending)) return program;
    }
    return nullptr;
}

class SceneReader {
  public:
    SceneReader(const SceneReadOptions& options, WarningSink& warnings, ProblemList& problems)
        : problems_(problems),
          directory_(options.directory),
          files_(options.library.files()),
          runner_(options.library, options.allow_commands, warnings),
          warnings_(warnings),
          make_pipe_(options.pipe) {}

    /// Open a scene argument: a file, "-", or "!command". A luminaire's file becomes a scene
    /// whose names are the file's, and an object file one of meshes.
    SceneText open(const std::string& argument) {
        if (argument == "-") {
            SceneText text{files_.standard_input(), "standard input"};
            if (text.bytes.empty())  // whatever was to write it has failed
                throw InputError({text.name, 0}, "empty, expected an octree or scene text");
            return text;
        }
        if (!argument.empty() && argument[0] == '!') {
            return {runner_.run(argument, directory_, {abbreviate_command(argument), 0}),
                    abbreviate_command(argument)};
        }
        if (const char* converter = converter_of(argument))
            return {runner_.convert({converter, "-s", "-o", argument, argument}, directory_),
                    argument};
        const std::string path = path_from(directory_, argument);
        if (is_model_name(argument)) return {read_object(argument, path), path};
        return {files_.read(path), path};
    }

    /// What files are added to; before anything is read.
    void begin_with(std::shared_ptr<Model> base) { builder_ = ModelBuilder(std::move(base)); }
    void begin_with(const SceneText& octree) {
        OctreeContents contents = decode_octree(octree.bytes, octree.name);
        if (contents.model) return begin_with(std::move(contents.model));
        read_files_of(contents, octree.name);
        cube_->holds_all = false;
    }
    /// The scene files of an octree that is not frozen.
    void read_files_of(OctreeContents& contents, const std::string& name) {
        for (const std::string& file : contents.scene_files) {
            SceneText text = open(file);
            read(text);
        }
        if (problems_.empty() && size() != contents.objects) {
            throw InputError({name, 0}, "bad object count; octree stale? Its scene files hold " +
                                            std::to_string(size()) + " primitives, expected " +
                                            std::to_string(contents.objects));
        }
        header_ = std::move(contents.header);
        cube_ = contents.cube;
    }

    void read(std::string_view text, const std::string& name) { read(text, name, nullptr); }
    /// Parses a text whose memory is given back to the system meanwhile.
    void read(SceneText& text) {
        FadingText fading(text.bytes);
        read(text.bytes, text.name, &fading);
    }

    [[nodiscard]] std::size_t size() const { return builder_.model().size(); }
    [[nodiscard]] std::shared_ptr<Model> release() {
        std::shared_ptr<Model> model = builder_.release();
        if (!cube_) return model;
        model->header = std::move(header_);
        model->cube = cube_;
        return model;
    }

  private:
    std::string read_object(const std::string& name, const std::string& path) {
        const auto defined = [this](const std::string& modifier) {
            return builder_.is_defined(modifier);
        };
        const FunctionRef<bool(const std::string&)> is_defined = defined;
        return read_model(name, path, files_, &is_defined, warnings_);
    }

    /// Reads the output of the command that stands at `outer`.
    class OutputReader final : public TextSink {
      public:
        OutputReader(SceneReader& reader, FileName name, const SourceLocation& outer, int depth)
            : reader_(reader), name_(std::move(name)), outer_(outer), depth_(depth) {}
        void push(std::string_view piece) override {
            SceneTokenizer tokens(piece, name_, line_);
            reader_.read_items(tokens, &outer_, depth_, nullptr);
            line_ = tokens.where().line;
        }

      private:
        SceneReader& reader_;
        FileName name_;
        const SourceLocation& outer_;
        int depth_;
        std::int32_t line_ = 1;  ///< at which the next piece begins
    };

    void read(std::string_view text, const std::string& name, FadingText* fading) {
        if (text.find('\0') != std::string_view::npos)
            throw InputError({name, 0}, "neither an octree nor scene text: it holds zero bytes");
        refuse_binary_names(text, name);
        const std::size_t before = size();
        SceneTokenizer tokens(text, name);
        read_items(tokens, nullptr, 0, fading);
        if (size() == before && problems_.empty() && text.starts_with(kHeaderMark))
            throw InputError({name, 0}, "an information header without an end, expected an octree");
        warn_if_empty(before, name);
    }

    /// @param outer   where the command stands whose output this is; null for files
    /// @param fading  the text, when it may be forgotten; else null
    void read_items(SceneTokenizer& tokens, const SourceLocation* outer, int depth,
                    FadingText* fading) {
        for (auto item = tokens.peek(); item != SceneTokenizer::Item::end; item = tokens.peek()) {
            if (fading != nullptr) fading->read_to(tokens.offset());
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
    }

    void warn_if_empty(std::size_t before, const std::string& name) {
        if (size() == before && problems_.empty()) warnings_.warn(name + ": empty file");
    }

    void run_command(SceneTokenizer& tokens, const SourceLocation* outer, int depth) {
        const SourceLocation where = outer != nullptr ? *outer : tokens.where();
        const std::string command = tokens.command();
        if (depth >= kMaxNesting) {
            throw InputError(where, "commands that write commands nest more than " +
                                        std::to_string(kMaxNesting) + " levels deep");
        }
        const std::string name = to_prefix(where) + abbreviate_command(command);
        const std::size_t before = size();
        const GeneratedPart sky = begin_sky(where, command);
        const std::size_t skies = runner_.skies();
        OutputReader output(*this, name, where, depth + 1);
        const std::unique_ptr<TextPipe> pipe = make_pipe_ ? make_pipe_(output) : nullptr;
        try {
            TextSink& pieces = pipe ? static_cast<TextSink&>(*pipe) : output;
            runner_.run(command, directory_, where, pieces);
        } catch (const UnknownCommandError& error) {
            skip_command(error, where, error.program(), pipe.get());
            return;
        } catch (const FailedCommandError& error) {
            skip_command(error, where, message_of(error, where), pipe.get());
            return;
        } catch (...) {
            if (pipe) pipe->finish();  // what is wrong in an earlier piece comes first
            throw;
        }
        if (pipe) pipe->finish();
        if (runner_.skies() > skies) note_sky(sky, runner_.skies() - skies);
        warn_if_empty(before, name);
    }

    [[nodiscard]] GeneratedPart begin_sky(const SourceLocation& where,
                                          const std::string& command) const {
        const Model& model = builder_.model();
        return {where, command,
                {},    static_cast<std::int32_t>(model.modifiers.size()),
                0,     model.surfaces.size(),
                0};
    }

    /// Unless commands that the command has written did so.
    /// @param part   as it was before the command
    /// @param count  of the skies that were made
    void note_sky(GeneratedPart part, std::size_t count) {
        const Model& model = builder_.model();
        if (!model.skies.empty() && model.skies.back().first_surface >= part.first_surface &&
            model.skies.back().first_modifier >= part.first_modifier)
            return;
        part.last_modifier = static_cast<std::int32_t>(model.modifiers.size());
        part.last_surface = model.surfaces.size();
        const auto pipelines = split_command(without_command_mark(part.command));
        const bool direct = pipelines && pipelines->size() == 1 &&
                            SkyCommand::is_sky(pipelines->front().front().front().text);
        if (!direct || count > 1)
            part.refusal = "the sky is made within \"" + abbreviate_command(part.command) + "\"";
        builder_.add_sky(std::move(part));
    }

    /// Go on without the command's output, or without the rest of it.
    void skip_command(const CommandError& error, const SourceLocation& where,
                      const std::string& kind, TextPipe* pipe) {
        if (pipe != nullptr) pipe->finish();  // what is wrong in an earlier piece comes first
        problems_.add(where, message_of(error, where), "command " + kind);
        skipped_command_ = true;
    }

    void read_item(SceneTokenizer& tokens, const SourceLocation* outer) {
        PrimitiveText& text = item_;
        read_primitive_head(tokens, text);
        const bool inherits = text.modifier == "inherit";
        bool misfit = false;
        const std::int32_t modifier = inherits ? kVoidIndex : find_modifier(text, misfit);
        try {
            resolve_type(text);
        } catch (const InputError& error) {
            if (misfit) problems_.raise();  // neither is a word of the language: no primitive
            skip_unknown(tokens, text, error);
            return;
        }
        const bool is_alias = text.type == PrimitiveType::alias;
        if (inherits && !is_alias) {
            throw InputError(text.where,
                             "inappropriate use of 'inherit' modifier: only an alias inherits");
        }
        read_primitive_arguments(tokens, text);
        const SourceLocation where = outer != nullptr ? *outer : text.where;
        if (is_alias) {
            add_alias(text, inherits, modifier, where);
            return;
        }
        if (is_surface(text.type) &&
            text.strings.empty()) {  // the common case: scenes have millions
            builder_.add(SurfacePrimitive{
                text.type, modifier, text.name, {}, text.reals, &where.file, where.line});
            return;
        }
        builder_.add(Primitive{text.type,
                               modifier,
                               std::move(text.name),
                               std::move(text.strings),
                               std::move(text.reals),
                               {},
                               where});
    }

    /// The index of a primitive's modifier; void for a name that nothing has defined. `misfit`: set
    /// when that is a problem.
    std::int32_t find_modifier(const PrimitiveText& text, bool& misfit) {
        try {
            return builder_.modifier(text.modifier, text.where);
        } catch (const InputError& error) {
            misfit = complain_of_name(text.modifier, text.where, error);
            return kVoidIndex;
        }
    }

    void add_alias(const PrimitiveText& text, bool inherits, std::int32_t modifier,
                   const SourceLocation& where) {
        std::int32_t target = kVoidIndex;
        try {
            target = builder_.alias_target(text.strings[0], text.where);
        } catch (const InputError& error) {
            (void)complain_of_name(text.strings[0], text.where, error);
            skipped_names_.insert(text.name);
            return;
        }
        if (inherits)
            builder_.rename(text.name, target, where);
        else
            builder_.add_alias(modifier, text.name, target, where);
    }

    /// A name that is not defined is a problem, unless that follows from what has been skipped:
    /// false then.
    bool complain_of_name(const std::string& name, const SourceLocation& where,
                          const InputError& error) {
        if (skipped_command_ || skipped_names_.contains(name)) return false;
        problems_.add(where, message_of(error, where), "name " + name);
        return true;
    }

    /// Read over a primitive of unknown type. Where it has no arguments either, this is no scene,
    /// or not one that can be read on.
    void skip_unknown(SceneTokenizer& tokens, PrimitiveText& text, const InputError& error) {
        problems_.add(text.where, message_of(error, text.where), "type " + text.type_word);
        text.type = PrimitiveType::polygon;  // like most: strings, integers and numbers
        try {
            read_primitive_arguments(tokens, text);
        } catch (const InputError&) {
            problems_.raise();
        }
        skipped_names_.insert(text.name);
        text.reals = {};  // whose memory the next primitive would keep
    }

    /// The text of an error without its place.
    static std::string message_of(const InputError& error, const SourceLocation& where) {
        const std::string message = error.what();
        const std::string prefix = printable(to_prefix(where));
        return message.starts_with(prefix) ? message.substr(prefix.size()) : message;
    }

    ProblemList& problems_;
    PrimitiveText item_;                   ///< the primitive being read; its memory is reused
    bool skipped_command_ = false;         ///< it may have defined anything
    std::set<std::string> skipped_names_;  ///< names of primitives that were skipped
    std::string directory_;
    FileSource& files_;  ///< which the runner's library path keeps
    ModelBuilder builder_;
    std::vector<std::string> header_;  ///< of an octree that is not frozen
    std::optional<ModelCube> cube_;    ///< of it; nothing: there is none
    CommandRunner runner_;
    WarningSink& warnings_;
    MakeTextPipe make_pipe_;
};

}  // namespace

namespace {

/// Calls read(problems): what it gathers is left to the caller, or thrown where he wants none. An
/// error that ends the reading comes after what was gathered before it.
template <class Read>
auto gather_problems(ProblemList* wanted, Read&& read) {
    ProblemList own;
    ProblemList& problems = wanted != nullptr ? *wanted : own;
    try {
        auto result = read(problems);
        if (wanted == nullptr) problems.raise();
        return result;
    } catch (const InputError& error) {
        if (problems.empty() || printable(problems.text()) == error.what()) throw;
        problems.add(error);
        throw InputError(problems.text());
    }
}

}  // namespace

std::shared_ptr<const Model> read_octree(std::string_view bytes, const std::string& name,
                                         const SceneReadOptions& options, WarningSink& warnings,
                                         ProblemList* problems) {
    OctreeContents contents = decode_octree(bytes, name);
    if (contents.model) return contents.model;
    return gather_problems(problems, [&](ProblemList& list) {
        SceneReader reader(options, warnings, list);
        reader.read_files_of(contents, name);
        return reader.release();
    });
}

std::shared_ptr<const Model> read_scene(std::span<const std::string> files,
                                        const SceneReadOptions& options, WarningSink& warnings,
                                        ProblemList* problems) {
    if (files.empty()) throw InputError("no scene: expected one octree, or scene files");
    return gather_problems(problems, [&](ProblemList& list) -> std::shared_ptr<const Model> {
        SceneReader reader(options, warnings, list);
        if (options.base) reader.begin_with(growable_copy(*options.base));
        bool first = !options.base;
        for (const std::string& file : files) {
            SceneText text = reader.open(file);
            if (!is_octree(text.bytes)) {
                reader.read(text);
            } else if (!first) {
                throw InputError({text.name, 0}, kOneBase);
            } else if (files.size() == 1) {
                return read_octree(text.bytes, text.name, options, warnings, &list);
            } else {
                reader.begin_with(text);
            }
            first = false;
        }
        return reader.release();
    });
}

std::shared_ptr<const Model> parse_scene(std::string_view text, const std::string& name,
                                         const SceneReadOptions& options, WarningSink& warnings) {
    return gather_problems(nullptr, [&](ProblemList& list) {
        SceneReader reader(options, warnings, list);
        reader.read(text, name);
        return reader.release();
    });
}

}  // namespace lightwalk
