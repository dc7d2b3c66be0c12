// xform: transform a scene description. See Radiance's manual page xform(1).
#include <cstddef>
#include <optional>
#include <utility>

#include "io/generators/generator.h"
#include "io/generators/xform_options.h"
#include "io/generators/xform_primitive.h"
#include "io/language/command_line.h"
#include "io/language/primitive_text.h"
#include "io/language/tokenizer.h"

namespace lightwalk {
namespace {

constexpr int kMaxDepth = 64;  ///< commands whose output holds commands ...

/// A primitive, or a command that is passed on.
struct Item {
    std::optional<PrimitiveText> primitive;
    std::string command;
};

/// The word as the shell reads it back.
class Xform {
  public:
    Xform(std::span<const std::string> args, GeneratorContext& context)
        : line_(parse_xform(args)), context_(context) {}

    std::string run() {
        read_input();
        out_ = "# xform";
        for (const std::string& word : line_.options) out_ += " " + quoted_for_shell(word);
        out_ += "\n";
        const auto read = [this](const std::string& file) {
            if (file == "-") return context_.standard_input();
            const std::string path = path_from(context_.directory, file);
            FileSource& files = context_.library.files();
            if (!files.readable(path)) throw InputError("xform: cannot open " + path);
            return files.read(path);
        };
        for_each_step(line_.options, read, [this](const XformStep& step) { apply(step); });
        return std::move(out_);
    }

  private:
    void read_input() {
        if (line_.files.empty())
            read_text(context_.standard_input(), "standard input", context_.directory, 0);
        for (const std::string& file : line_.files) {
            const std::string path = context_.library.locate(file, "scene file");
            std::optional<std::string> model;
            if (context_.model_scene) model = context_.model_scene(path);
            read_text(model ? *model : context_.library.files().read(path), path,
                      directory_of(path), 0);
        }
    }

    void read_text(std::string_view text, const std::string& name, const std::string& directory,
                   int depth) {
        if (depth > kMaxDepth)
            throw CommandError({name, 0}, "commands that write commands nest too deep");
        SceneTokenizer tokens(text, name);
        for (auto item = tokens.peek(); item != SceneTokenizer::Item::end; item = tokens.peek()) {
            switch (item) {
                case SceneTokenizer::Item::comment:
                    tokens.comment();
                    break;
                case SceneTokenizer::Item::command: {
                    const std::string location = to_prefix(tokens.where());
                    const std::string command = tokens.command();
                    if (line_.keep_commands) {
                        items_.push_back({std::nullopt, command});
                    } else if (!context_.run_command) {
                        throw InputError(location + "commands cannot be run here: expected -c");
                    } else {
                        read_text(context_.run_command(command, directory),
                                  location + abbreviate_command(command), directory, depth + 1);
                    }
                    break;
                }
                default:
                    items_.push_back({read_primitive(tokens), {}});
            }
        }
    }

    void apply(const XformStep& step) {
        for (const Item& item : items_) {
            if (item.primitive)
                write_transformed(*item.primitive, step, out_);
            else
                out_ += "\n" + item.command + pipe_through(step) + "\n";
            if (out_.size() > kMaxGeneratedBytes) throw CommandError("xform writes too much");
        }
    }

    /// The command that applies `step` to the output of a command.
    static std::string pipe_through(const XformStep& step) {
        std::string text = " | xform -e";
        if (step.invert) text += " -I";
        if (!step.prefix.empty()) text += " -n " + quoted_for_shell(step.prefix);
        if (!step.surface_modifier.empty())
            text += " -m " + quoted_for_shell(step.surface_modifier);
        for (const std::string& word : step.words) text += " " + quoted_for_shell(word);
        return text;
    }

    XformCommandLine line_;
    GeneratorContext& context_;
    std::vector<Item> items_;
    std::string out_;
};

}  // namespace

std::string run_xform(std::span<const std::string> args, GeneratorContext& context) {
    return Xform(args, context).run();
}

}  // namespace lightwalk
