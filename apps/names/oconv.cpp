// oconv: scene files as an octree, which holds all of them.
#include "apps/command_run.h"
#include "apps/names/named_program.h"
#include "apps/names/program_words.h"
#include "apps/session/run_header.h"
#include "io/scene/binary_models.h"
#include "io/scene/file_resources.h"
#include "io/scene/octree_writer.h"
#include "io/scene/scene_reader.h"

namespace lightwalk {
namespace {

struct OconvCommand {
    std::vector<std::string> files;  ///< the octree of -i first
    bool extends = false;            ///< -i
    OctreeOptions octree;
    bool warnings = true;
};

OconvCommand parse_oconv(const std::vector<std::string>& line) {
    OconvCommand command;
    ProgramWords words(line);
    while (words.at_option()) {
        const std::string& option = words.take();
        if (option == "-i") {
            command.files = {words.text("an octree")};
            command.extends = true;
        } else if (option == "-b") {
            ModelCube cube;
            for (double* value : {&cube.x, &cube.y, &cube.z, &cube.size})
                *value = words.real("the corner and the edge of the cube, four numbers");
            constexpr double kMargin = 1e-5;  // [m], as around surfaces
            cube = {cube.x - kMargin, cube.y - kMargin, cube.z - kMargin, cube.size + 2 * kMargin};
            command.octree.cube = cube;
            command.octree.strict = true;
        } else if (option == "-n") {
            command.octree.limits.objects = words.integer("a number of objects", 1, 511);
        } else if (option == "-r") {
            command.octree.limits.resolution = words.integer("a resolution", 2, 1 << 20);
        } else if (option == "-w") {
            command.warnings = !command.warnings;
        } else if (option != "-f") {  // octrees are always frozen
            words.unknown();
        }
    }
    const std::vector<std::string> files = words.rest();
    command.files.insert(command.files.end(), files.begin(), files.end());
    return command;
}

/// Throws InputError where what -i names is no octree.
void expect_octree(const std::string& path, FileSource& files) {
    constexpr std::size_t kLongestHeader = std::size_t{1} << 20;
    if (!files.readable(path)) throw InputError({path, 0}, "cannot open octree file");
    const auto beginning = files.answer(FileSource::Question::beginning, path, kLongestHeader);
    if (!beginning || !is_octree(*beginning)) throw InputError({path, 0}, "not an octree");
}

/// Files that commands of a scene have made are nowhere but in this process.
void expect_files_outside(const Model& model, const LibraryPath& library) {
    for (const Primitive& modifier : model.modifiers) {
        for (const std::string& word : modifier.strings) {
            if (!library.files().keeps(word)) continue;
            throw InputError(modifier.where,
                             word +
                                 " is made by a command of the scene, and an octree cannot hold "
                                 "it: use lightwalk freeze, or make it before");
        }
    }
}

}  // namespace

int run_oconv(const std::string& name, const std::vector<std::string>& words,
              Communicator* /*ranks*/) {
    OconvCommand command = parse_oconv(words);
    StderrWarnings warnings(name);
    warnings.enable(command.warnings);
    const LibraryPath library = LibraryPath::from_environment();
    if (command.extends) expect_octree(command.files.front(), library.files());
    const SceneReadOptions options{library, true};
    const std::shared_ptr<const Model> model = command.files.empty()
                                                   ? std::make_shared<const Model>()
                                                   : read_scene(command.files, options, warnings);
    expect_files_outside(*model, library);
    OctreeOptions& octree = command.octree;
    for (const std::string& line : model->header)
        if (!line.starts_with("#?")) octree.header.push_back(line);
    octree.header.push_back(name + (words.empty() ? "" : ' ' + history_line(words)));
    if (!octree.cube) octree.cube = model->cube;
    FileResources resources(library, true, warnings);
    write_to_stdout(encode_octree(*model, resources, octree, warnings));
    return kSuccessStatus;
}

}  // namespace lightwalk
