#include "apps/commands.h"

#include <algorithm>

#include "apps/contrib_command.h"
#include "apps/render_command.h"
#include "apps/trace_command.h"
#include "io/options/manual_page.h"

namespace lightwalk {
namespace {

template <class Command>
OptionTable own_table(Command command) {
    return owning_table(std::move(command),
                        [](Command& owned) { return option_table(owned, real_files()); });
}

constexpr const char* kProgramHelp =
    R"(
SCENE is one octree (.oct), one frozen scene (.lwz), or Radiance scene files in order. Files behind an octree or a frozen
scene are added to it (base.oct sky.rad), and use its materials by their names. A rad file (.rif) stands for the files that
it names, its views (-v NAME) and the options that rad(1) would give; what is on the command line comes before it, and may
set its variables (scene.rif QUALITY=High). "-" is standard input, which render and info also read when no scene is
named. Library files are looked for along RAYPATH, then in the library that
comes with Lightwalk.

A first picture, of a room with a window:
  lightwalk render -vp 2 1.6 0.5 -vd 0 0 1 -vu 0 1 0 -vh 60 -vv 45 -o room.png room.rad

Exit status: 0 success, 1 bad input (the message begins with file:line), 2 a command line that was not understood,
130 ended by Ctrl-C. Nothing is ever half-written.
)";

constexpr Command kCommands[] = {
    {"render", "OPTIONS SCENE...   a picture of a view          (like rpict)", run_render,
     [] { return own_table(RenderCommand("render")); },
     R"(Compute a picture. Options are those of Radiance's rpict; a word @FILE or $NAME in place of an option stands for the
words in the file or environment variable. A switch like -dv toggles; -dv+ and -dv- set it. `-defaults` lists every
option with its value; rpict(1) tells more of those with one dash.
)",
     ""},
    {"animate", "OPTIONS SCENE...  the frames of a walk", run_animate,
     [] { return own_table(RenderCommand("animate")); },
     R"(Compute the frames of a walk. Options are those of `lightwalk render`, but for -S and the checkpoint; what a frame has
in common with those before it is not traced again.
)",
     ""},
    {"walk", "OPTIONS SCENE...     walk through a scene in a browser", run_walk,
     [] { return own_table(RenderCommand("walk")); },
     R"(Walk through a scene in a browser: prints the address to open. Options are those of `lightwalk render` and those on
reuse of `lightwalk animate`, but for what is about files of pictures. When the scene's files are edited they are read
again beside the frames, and the walk goes on with what has not changed; what is wrong with them stands in the page.
)",
     ""},
    {"trace", "OPTIONS SCENE...    radiance along single rays   (like rtrace)", run_trace,
     [] { return own_table(TraceCommand{}); },
     R"(Trace rays from standard input, one record a ray on standard output, in order. A ray is six numbers: origin and
direction. Options are those of Radiance's rtrace, as are the defaults (-defaults lists them); @FILE, $NAME and
switches work as in `lightwalk render`. Without -ab the output does not depend on the number of threads.
)",
     R"(
A zero direction flushes the output. The input ends at its end, or at a word that is no number.

  echo "0 0 1  0 0 -1" | lightwalk trace -h -ovp -av .1 .1 .1 room.rad
)"},
    {"contrib", "OPTIONS SCENE...  what light sources bring to rays (like rcontrib)", run_contrib,
     [] { return own_table(ContribCommand{}); },
     R"(Tell what surfaces of some modifiers, light sources above all, bring to rays from standard input: coefficients, in bins
by direction and place. Options are those of Radiance's rcontrib, as are the defaults (-defaults lists them); @FILE,
$NAME and switches work as in `lightwalk render`. Files appear when they are whole; until then they are named FILE.part.
)",
     R"(
Daylight coefficients of sensors, points and normals, for the 145 patches of the sky and the ground:

  lightwalk contrib -I -ab 3 -ad 4096 -f tregenza.cal -b tbin -bn Ntbins -o %s.dat -m sky room.rad < sensors.txt
)"},
    {"relight", "LAYERS... -o FILE  light groups, dimmed, as one picture", run_relight,
     relight_option_table,
     R"(Add up layers that `lightwalk render --light-group` wrote, each times its level: the picture of the scene as it
would be with its light sources dimmed or coloured, without tracing a ray. Of pictures that are no layers each is one
by its name without the ending.

  lightwalk render --light-group auto -o layers.exr -vf hall.vf hall.rad
  lightwalk relight layers.exr --group sun=0 --group lamps=.5,1,.9,.8 -o evening.hdr

Layers in .exr files add up to the picture to within rounding; each .hdr has steps of 1/256 of its own. Levels are exact
for what is rendered with -dt 0, and with -ab by -aa 0 -as 0 --ambient-lights 0 as well: else which shadows are tested, and where
indirect light is sampled and cached, was chosen by the light as it was, which costs accuracy the more the mixture differs.
)",
     "", false},
    {"freeze", "SCENE... -o FILE   a scene in one file, for a quick start", run_freeze,
     freeze_option_table,
     R"(Write all that a run needs of a scene to one file: surfaces, materials, instances and meshes, and of the library the
function files, data, pictures and fonts that the scene uses. Every command takes such a file in place of the scene,
and makes the same pictures of it, bit for bit. It is mapped, not read: a run begins sooner, and processes on one
machine share its pages. Only the tree that rays search is built anew.

  lightwalk freeze building.rad furniture.rad sky.rad -o building.lwz
  lightwalk render -vf entrance.vf -o entrance.hdr building.lwz

The file knows what it was made from. Where a file has changed since, is missing, or has come to stand before another
one in the library, the run ends and names it; --stale takes the scene as it was frozen. Commands that were run
(--allow-commands) and standard input are not looked at again. Damaged files are refused: each part has a checksum. A
file belongs to the version of Lightwalk that wrote it.
)",
     "", false},
    {"info", "SCENE...             what a scene holds", run_info, info_option_table,
     R"(Say what a scene holds: primitives by type, bounds, light sources with the virtual ones that mirrors and prisms make,
instances, memory, and what Lightwalk does not support, with the first place of each. Exit status 1 when the scene
cannot be rendered; what could be found out is printed all the same.
)",
     "", false},
    {"launch", "COMMAND ...        a command on many ranks, again where one is lost", run_launch,
     launch_option_table,
     R"(Start a command on many ranks by Open MPI's mpirun, with the settings that let it notice a host that is gone. Where a
rank or a host is lost, `render --checkpoint FILE` and `animate` are started again and go on from what is kept, without the
hosts that do not answer: the picture is the same. What the command itself ends with, bad input above all, is no loss.

The page of a `walk` is served by this process, which draws nothing, on the port and address of the walk's options. Where ranks
are lost it stays connected, says what has happened, and tells those that are started anew view, lights, materials and
probes.
)",
     R"(
  lightwalk launch --hosts hosts render --checkpoint kept -vf view.vf -o picture.hdr building.oct
  lightwalk launch --ranks 4 walk -vf view.vf building.lwz
)",
     false},
    {"install-names", "FOLDER      the program by the names of Radiance's", run_install_names,
     install_names_option_table,
     R"(Make a folder of links to this program: oconv, rtrace, rpict, rcontrib, gensky, gendaylit, genbox, xform, getinfo,
vwrays, replmarks, pfilt, pvalue, evalglare, falsecolor, gensurf, genrev, genworm, genprism, genblinds. Called by such a
name it takes the words of Radiance's program, and writes what that writes; what it does not cover it refuses.

  lightwalk install-names ~/names
  export PATH=~/names:$PATH
)",
     "", false},
};

std::string options_document() {
    std::vector<OptionTable> tables;
    for (const Command& command : kCommands) tables.push_back(command.options());
    return "# Options\n\nAll options of all commands. After a change of one:\n\n"
           "    lightwalk help options > apps/OPTIONS.md\n\n" +
           option_reference(tables);
}

std::string program_help() {
    std::string text = "lightwalk: physically based pictures of Radiance scenes.\n\n";
    for (const Command& command : kCommands)
        text += std::string("  lightwalk ") + command.name + ' ' + command.summary + '\n';
    text +=
        "  lightwalk help COMMAND              how to use one of them\n"
        "  lightwalk help options              all options of all of them, in Markdown\n"
        "  lightwalk help man [COMMAND]        a page for man(1)\n";
    return text + kProgramHelp;
}

/// A summary is what is typed behind the command's name, and in columns beside it what it is for.
std::pair<std::string, std::string> operands_and_purpose(const Command& command) {
    const std::string summary = command.summary;
    const std::size_t gap = summary.find("  ");
    std::string purpose = summary.substr(summary.find_first_not_of(' ', gap));
    const auto twice = [](char a, char b) { return a == ' ' && b == ' '; };
    purpose.erase(std::unique(purpose.begin(), purpose.end(), twice), purpose.end());
    return {summary.substr(0, gap), purpose};
}

std::string program_manual() {
    std::string about =
        "Physically based pictures of Radiance scenes. Each command has a page of its own:\n\n";
    std::string pages;
    for (const Command& command : kCommands) {
        about += std::string("  lightwalk-") + command.name +
                 "(1): " + operands_and_purpose(command).second + '\n';
        pages += std::string(pages.empty() ? "" : ", ") + "lightwalk-" + command.name + "(1)";
    }
    return manual_page(
        {"lightwalk", "lightwalk", "COMMAND OPTIONS SCENE...",
         "light in buildings that do not exist yet", about + kProgramHelp, "", pages},
        nullptr, LIGHTWALK_VERSION);
}

}  // namespace

std::span<const Command> commands() {
    return kCommands;
}

const Command* find_command(const std::string& name) {
    const auto* const found = std::ranges::find_if(
        kCommands, [&](const Command& command) { return name == command.name; });
    return found != std::end(kCommands) ? found : nullptr;
}

std::string help_text(const std::string& name) {
    if (name == "options") return options_document();
    const Command* const command = find_command(name);
    if (command == nullptr) return program_help();
    return "lightwalk " + name + ' ' + operands_and_purpose(*command).first + "\n\n" +
           command->about + command->options().help() + command->example;
}

std::string manual_text(const std::string& name) {
    if (name.empty()) return program_manual();
    const Command* const command = find_command(name);
    if (command == nullptr) throw UsageError("help man: there is no command " + name);
    const auto [operands, purpose] = operands_and_purpose(*command);
    const OptionTable options = command->options();
    return manual_page({"lightwalk-" + name, "lightwalk " + name, operands, purpose, command->about,
                        command->example, "lightwalk(1)"},
                       &options, LIGHTWALK_VERSION);
}

}  // namespace lightwalk
