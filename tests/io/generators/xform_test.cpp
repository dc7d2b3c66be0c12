#include <doctest/doctest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "io/generators/generator.h"
#include "io/language/primitive_text.h"
#include "io/language/tokenizer.h"
#include "io/scene/command_runner.h"
#include "tests/temporary_folder.h"
#include "tests/test_scene.h"

namespace lightwalk {
namespace {

using test::TemporaryFolder;

struct Setting {
    std::string directory, input;
};

/// What xform writes; `command` is split at blanks, '_' standing for one inside a word.
std::string xform(const std::string& command, const Setting& setting) {
    std::istringstream stream(command);
    std::vector<std::string> args{"xform"};
    for (std::string word; stream >> word;) {
        for (char& c : word) c = c == '_' ? ' ' : c;
        args.push_back(word);
    }
    test::Silence silence;
    const LibraryPath library = LibraryPath({"."}).relative_to(setting.directory);
    CommandRunner runner(LibraryPath({"."}), false, silence);
    GeneratorContext context{
        library, setting.directory, setting.input, !setting.input.empty(), silence, {}};
    context.run_command = [&](const std::string& text, const std::string& directory) {
        return runner.run(text, directory, {"outer.rad", 1});
    };
    return run_xform(args, context);
}

std::vector<PrimitiveText> primitives(const std::string& text) {
    SceneTokenizer tokens(text, "out");
    std::vector<PrimitiveText> result;
    for (auto item = tokens.peek(); item != SceneTokenizer::Item::end; item = tokens.peek()) {
        if (item == SceneTokenizer::Item::primitive)
            result.push_back(read_primitive(tokens));
        else if (item == SceneTokenizer::Item::comment)
            tokens.comment();
        else
            static_cast<void>(tokens.command());
    }
    return result;
}

PrimitiveText transformed(const std::string& options, const std::string& primitive) {
    const auto result = primitives(xform(options, {"", primitive}));
    REQUIRE(result.size() == 1);
    return result[0];
}

/// Type and numbers of a primitive, as text with 12 digits.
std::string shape(const std::string& options, const std::string& primitive) {
    PrimitiveText p = transformed(options, primitive);
    std::string text = p.type_word;
    for (const double real : p.reals) {
        std::ostringstream number;
        number.precision(9);
        number << (std::abs(real) < 1e-12 ? 0 : real);
        text += " " + number.str();
    }
    return text;
}

std::string strings(const std::string& options, const std::string& primitive) {
    std::string text;
    for (const std::string& word : transformed(options, primitive).strings)
        text += (text.empty() ? "" : " ") + word;
    return text;
}

std::string error_of(const std::string& command, const Setting& setting) {
    try {
        static_cast<void>(xform(command, setting));
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

// (x, y, z) -> (1 - 2y, 2x, 2z)
const std::string kTurn = "-s 2 -rz 90 -t 1 0 0";

TEST_CASE("surfaces under -s 2 -rz 90 -t 1 0 0, under -mx, and inside out") {
    struct Row {
        const char* primitive;
        const char* turned;
        const char* mirrored;
        const char* inverted;
    };
    const Row rows[] = {
        {"m source a 0 0 4 1 2 3 0.5", "source -4 2 6 0.5", "source -1 2 3 0.5",
         "source 1 2 3 0.5"},
        {"m sphere a 0 0 4 1 2 3 4", "sphere -3 2 6 8", "sphere -1 2 3 4", "bubble 1 2 3 4"},
        {"m bubble a 0 0 4 1 2 3 4", "bubble -3 2 6 8", "bubble -1 2 3 4", "sphere 1 2 3 4"},
        {"m polygon a 0 0 9 0 0 0 1 0 0 1 2 3", "polygon 1 0 0 1 2 0 -3 2 6",
         "polygon -1 2 3 -1 0 0 0 0 0", "polygon 1 2 3 1 0 0 0 0 0"},
        {"m cone a 0 0 8 0 0 0 0 0 1 .5 .25", "cone 1 0 0 1 0 2 1 0.5", "cone 0 0 0 0 0 1 0.5 0.25",
         "cup 0 0 0 0 0 1 0.5 0.25"},
        {"m cup a 0 0 8 0 0 0 0 0 1 .5 .25", "cup 1 0 0 1 0 2 1 0.5", "cup 0 0 0 0 0 1 0.5 0.25",
         "cone 0 0 0 0 0 1 0.5 0.25"},
        {"m cylinder a 0 0 7 1 0 0 0 1 1 .5", "cylinder 1 2 0 -1 0 2 1",
         "cylinder -1 0 0 0 1 1 0.5", "tube 1 0 0 0 1 1 0.5"},
        {"m tube a 0 0 7 1 0 0 0 1 1 .5", "tube 1 2 0 -1 0 2 1", "tube -1 0 0 0 1 1 0.5",
         "cylinder 1 0 0 0 1 1 0.5"},
        {"m ring a 0 0 8 1 2 3 1 0 0 0 .5", "ring -3 2 6 0 2 0 0 1", "ring -1 2 3 -1 0 0 0 0.5",
         "ring 1 2 3 -1 0 0 0 0.5"},
    };
    for (const Row& row : rows) {
        CAPTURE(row.primitive);
        CHECK(shape(kTurn, row.primitive) == row.turned);
        CHECK(shape("-mx", row.primitive) == row.mirrored);
        CHECK(shape("-I", row.primitive) == row.inverted);
        CHECK(shape("-I -I", row.primitive) == shape("-t 0 0 0", row.primitive));
    }
    CHECK(shape("-I -mx", "m polygon a 0 0 9 0 0 0 1 0 0 1 2 3") == "polygon 0 0 0 -1 0 0 -1 2 3");
    CHECK(shape("-mx -my", "m polygon a 0 0 9 0 0 0 1 0 0 1 2 3") ==
          "polygon 0 0 0 -1 0 0 -1 -2 3");
}

TEST_CASE("lights and media scale with the model") {
    CHECK(shape(kTurn, "void glow g 0 0 4 1 1 1 3") == "glow 1 1 1 6");
    CHECK(shape("-s -2", "void glow g 0 0 4 1 1 1 3") == "glow 1 1 1 6");
    CHECK(shape(kTurn, "void spotlight g 0 0 7 1 1 1 30 1 2 3") == "spotlight 1 1 1 30 -4 2 6");
    CHECK(shape(kTurn, "void dielectric g 0 0 5 .25 .5 1 1.5 0") ==
          "dielectric 0.5 0.707107 1 1.5 0");
    CHECK(shape(kTurn, "void interface g 0 0 8 .25 .5 1 1.5 .5 .5 .25 1.2") ==
          "interface 0.5 0.707107 1 1.5 0.707107 0.707107 0.5 1.2");
    CHECK(shape(kTurn, "void mist g 0 0 7 .1 .2 .123456789 .8 .8 .8 .5") ==
          "mist 0.05 0.1 0.0617284 0.8 0.8 0.8 0.5");
    CHECK(strings("-n up", "void mist g 2 lamp lens>lamp 0 0") == "up.lamp up.lens>up.lamp");
    CHECK(shape(kTurn, "void brighttext t 2 f.fnt x 0 11 1 2 3 1 0 0 0 -1 0 1 .1") ==
          "brighttext -3 2 6 0 2 0 2 0 0 1 0.1");
    for (const char* same :
         {"void light a 0 0 3 1 2 3", "void illum a 1 void 0 3 1 2 3", "void mirror a 0 0 3 1 1 1",
          "void plastic a 0 0 5 1 1 1 0 0", "void trans a 0 0 7 1 1 1 0 0 1 1",
          "void glass a 0 0 3 1 1 1", "void antimatter a 1 m 0 0"}) {
        CAPTURE(same);
        CHECK(shape(kTurn, same) == shape("-t 0 0 0", same));
        CHECK(strings(kTurn, same) == strings("-t 0 0 0", same));
    }
    CHECK(strings(kTurn, "m alias a b") == "b");
}

TEST_CASE("what has a function file, instances and meshes keep the transform as words") {
    CHECK(strings(kTurn, "void brightfunc a 2 dirt dirt.cal 0 0") ==
          "dirt dirt.cal -i 1 -s 2 -rz 90 -t 1 0 0");
    CHECK(strings("-i 3 -t 1 0 0", "m instance a 1 tree.oct 0 0") == "tree.oct -i 3 -t 1 0 0");
    CHECK(strings("-t 1 0 0", "m mesh a 1 x.rtm 0 0") == "x.rtm -i 1 -t 1 0 0");
    CHECK(strings("-I", "m mesh a 1 x.rtm 0 0") == "x.rtm");
    for (const char* type :
         {"texfunc",  "texdata",   "colorfunc", "brightdata", "colordata", "colorpict",
          "mixfunc",  "mixdata",   "mixpict",   "plastic2",   "metal2",    "trans2",
          "ashik2",   "plasfunc",  "metfunc",   "transfunc",  "BRTDfunc",  "plasdata",
          "metdata",  "transdata", "prism1",    "prism2",     "BSDF",      "aBSDF",
          "WGMDfunc", "specfunc",  "specdata",  "specpict"}) {
        CAPTURE(type);
        CHECK(strings("-mz", std::string("void ") + type + " a 1 x 0 0") == "x -i 1 -mz");
    }
}

TEST_CASE("only surfaces are renamed and given another modifier") {
    const std::string scene = "void plastic p 0 0 5 1 1 1 0 0 p sphere s 0 0 4 0 0 0 1";
    const auto result = primitives(xform("-n a -n b -m other -m third -t 1 0 0", {"", scene}));
    REQUIRE(result.size() == 2);
    CHECK(result[0].name == "p");
    CHECK(result[0].modifier == "void");
    CHECK(result[1].name == "a.b.s");
    CHECK(result[1].modifier == "other");
}

/// Names and x coordinates of spheres.
std::string spheres(const std::string& command, const Setting& setting) {
    std::string text;
    for (const PrimitiveText& p : primitives(xform(command, setting))) {
        std::ostringstream line;
        line << p.name << "@" << p.reals[0] << "," << p.reals[1];
        if (!text.empty()) text += " ";
        text += line.str();
    }
    return text;
}

const std::string kSphere = "m sphere s 0 0 4 0 0 0 1";

TEST_CASE("arrays: element 0 is not moved, names count, the first array is slowest") {
    CHECK(spheres("-a 3 -t 2 0 0", {"", kSphere}) == "a0.s@0,0 a1.s@2,0 a2.s@4,0");
    CHECK(spheres("-n foo -a 2 -t 2 0 0", {"", kSphere}) == "foo.0.s@0,0 foo.1.s@2,0");
    CHECK(spheres("-n foo -t 9 0 0 -a 2 -t 2 0 0 -a 2 -t 0 1 0", {"", kSphere}) ==
          "foo.0.0.s@9,0 foo.0.1.s@9,1 foo.1.0.s@11,0 foo.1.1.s@11,1");
    CHECK(spheres("-a 2 -t 2 0 0 -a 2 -t 0 1 0", {"", kSphere}) ==
          "a0.0.s@0,0 a0.1.s@0,1 a1.0.s@2,0 a1.1.s@2,1");
    CHECK(spheres("-a 2 -t 2 0 0 -i 1 -t 0 5 0", {"", kSphere}) == "a0.s@0,5 a1.s@2,5");
    CHECK(strings("-a 1 -t 1 0 0", "m mesh a 1 x.rtm 0 0") == "x.rtm -i 0 -t 1 0 0");
}

TEST_CASE("argument files: one run a line, expanded before arrays") {
    const TemporaryFolder folder;
    folder.write("where",
                 "# comment\n-t 1 0 0\n\n!xform -t 2 0 0 \\\n-t 0 7 0\nxform '-t' 3 \"0\" 0\n");
    folder.write("empty", "# nothing\n\n");
    folder.write("self", "-f self\n");
    const Setting setting{folder.path(), kSphere};
    CHECK(spheres("-f where", setting) == "i0.s@1,0 i1.s@2,7 i2.s@3,0");
    CHECK(spheres("-n foo -f where -t 10 0 0", setting) ==
          "foo.0.s@11,0 foo.1.s@12,7 foo.2.s@13,0");
    CHECK(spheres("-a 2 -t 10 0 0 -i 1 -f where", setting) ==
          "i0.0.s@1,0 i0.1.s@11,0 i1.0.s@2,7 i1.1.s@12,7 i2.0.s@3,0 i2.1.s@13,0");
    CHECK(error_of("-f empty", setting) == "xform: empty argument file \"empty\"");
    CHECK(error_of("-f missing", setting) == "xform: cannot open " + folder.path() + "/missing");
    CHECK(error_of("-f self", setting) ==
          "xform: arrays nest more than 64 deep: does an argument file read itself?");
    CHECK(error_of("-f /dev/zero", setting) == "xform: cannot open /dev/zero");
}

TEST_CASE("usage errors name the word") {
    const Setting setting{"", kSphere};
    CHECK(error_of("-t 1 2", setting) == "xform: command line error at '-t'");
    CHECK(error_of("-t 1 2 x", setting) == "xform: command line error at '-t'");
    CHECK(error_of("-rw 3", setting) == "xform: command line error at '-rw'");
    CHECK(error_of("-s 0", setting) == "xform: command line error at '-s'");
    CHECK(error_of("-t 1 0 0 -m red", setting) == "xform: command line error at '-m'");
    CHECK(error_of("-a 0 -t 1 0 0", setting) == "xform: command line error at '-a'");
    CHECK(error_of("-a x", setting) == "xform: command line error at '-a'");
    CHECK(error_of("-n", setting) == "xform: command line error at '-n'");
    CHECK(error_of("-t 1 0 0 no_file.rad", setting) ==
          "cannot find scene file \"no file.rad\" in .");
}

TEST_CASE("primitives with too few arguments are told with their place") {
    const auto message = [](const std::string& text) {
        return error_of("-s 2", {"", "\n" + text});
    };
    CHECK(message("m sphere s 0 0 3 1 2 3") ==
          "standard input:2: bad sphere \"s\": wrong number of arguments");
    CHECK(message("m polygon s 0 0 8 1 2 3 4 5 6 7 8") ==
          "standard input:2: bad polygon \"s\": wrong number of arguments");
    CHECK(message("m instance s 0 0 0") ==
          "standard input:2: bad instance \"s\": wrong number of arguments");
    CHECK(message("void glow s 0 0 3 1 1 1") ==
          "standard input:2: bad glow \"s\": wrong number of arguments");
    CHECK(message("void dielectric s 0 0 4 1 1 1 1") ==
          "standard input:2: bad dielectric \"s\": wrong number of arguments");
    CHECK(message("void mixtext s 0 0 8 1 1 1 1 1 1 1 1") ==
          "standard input:2: bad mixtext \"s\": wrong number of arguments");
    CHECK(message("m sphere s 0 0 4 1e308 0 0 1") ==
          "standard input:2: sphere \"s\": number out of range");
    CHECK(message("m globe s 0 0 0") == "standard input:2: unknown type \"globe\"");
}

TEST_CASE("the output begins with its command, and quotes what it must") {
    CHECK(xform("-n a_b -t 1 0 0", {"", kSphere}).starts_with("# xform -n 'a b' -t 1 0 0\n"));
    const PrimitiveText p = transformed("-n a_b", "'m 1' mesh \"it's\" 2 '' 'say \"it'\"'s\" 0 0");
    CHECK(p.modifier == "m 1");
    CHECK(p.name == "a b.it's");
    REQUIRE(p.strings.size() == 2);
    CHECK(p.strings[0].empty());
    CHECK(p.strings[1] == "say \"it's");
}

TEST_CASE("numbers are rounded to 12 digits") {
    CHECK(transformed("-s 1", "m sphere s 0 0 4 0.12345678901234567 0 0 1").reals[0] ==
          0.123456789012);
}

TEST_CASE("commands inside are run and transformed, -c passes them on") {
    const TemporaryFolder folder;
    folder.write("parts/two.rad", "!cat one.rad\n!xform -t 0 1 0 one.rad\n");
    folder.write("parts/one.rad", kSphere);
    const Setting setting{folder.path(), ""};
    CHECK(spheres("-n x -t 5 0 0 parts/two.rad", setting) == "x.s@5,0 x.s@5,1");
    CHECK(spheres("-a 2 -t 5 0 0 parts/one.rad parts/two.rad", setting) ==
          "a0.s@0,0 a0.s@0,0 a0.s@0,1 a1.s@5,0 a1.s@5,0 a1.s@5,1");
    CHECK(xform("-c -n x -t 5 0 0 parts/two.rad", setting) ==
          "# xform -c -n x -t 5 0 0\n"
          "\n!cat one.rad | xform -e -n x -t 5 0 0\n"
          "\n!xform -t 0 1 0 one.rad | xform -e -n x -t 5 0 0\n");
}

TEST_CASE("arrays without end are refused") {
    CHECK_THROWS_WITH_AS(xform("-a 2000000000 -t 1 0 0", {"", kSphere}),
                         "xform: array of more than 1000000 elements", CommandError);
}

TEST_CASE("transforming twice is transforming by the product") {
    const std::string p = "m cone a 0 0 8 1 2 3 -1 0 1 .5 .25";
    const std::string once = xform("-rx 30 -s 2", {"", p});
    CHECK(shape("-t 1 2 3", once) == shape("-rx 30 -s 2 -t 1 2 3", p));
}

}  // namespace
}  // namespace lightwalk
