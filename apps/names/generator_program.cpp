// Generators as programs: gensky, xform, genbox and the like.
#include <cstdio>

#include "apps/command_run.h"
#include "apps/names/named_program.h"
#include "io/scene/command_runner.h"

namespace lightwalk {
namespace {

/// What a generator writes much of goes out in parts.
class StdoutSink final : public TextSink {
  public:
    void push(std::string_view piece) override { write_to_stdout(std::string(piece)); }
};

}  // namespace

int run_generator(const std::string& name, const std::vector<std::string>& words,
                  Communicator* /*ranks*/) {
    const LibraryPath library = LibraryPath::from_environment();
    StderrWarnings warnings(name);
    CommandRunner runner(library, true, warnings);
    GeneratorContext context{library, "", {}, false, warnings, {}};
    context.run_command = [&](const std::string& command, const std::string& directory) {
        return runner.run(command, directory, {});
    };
    context.read_input = [&] { return library.files().standard_input(); };
    StdoutSink sink;
    context.output = &sink;
    std::vector<std::string> line{name};
    line.insert(line.end(), words.begin(), words.end());
    write_to_stdout(find_generator(name)(line, context));
    return kSuccessStatus;
}

}  // namespace lightwalk
