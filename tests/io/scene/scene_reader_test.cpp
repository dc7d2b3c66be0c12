#include "io/scene/scene_reader.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "apps/session/parse_queue.h"
#include "tests/all_primitives.h"
#include "tests/temporary_folder.h"
#include "tests/test_scene.h"

namespace lightwalk {
namespace {

using test::Silence;
using test::TemporaryFolder;

/// Options that look for files in one folder only.
SceneReadOptions inside(const std::string& directory) {
    return {LibraryPath(std::vector<std::string>{"."}), false, directory};
}

struct Parsed {
    std::shared_ptr<const Model> model;
    std::vector<std::string> warnings;
    std::string error;

    /// Modifiers come first, then the surfaces.
    [[nodiscard]] Primitive at(std::size_t i) const {
        const std::size_t modifiers = model->modifiers.size();
        return i < modifiers ? model->modifiers[i] : to_primitive(model->surfaces[i - modifiers]);
    }
    [[nodiscard]] std::size_t size() const { return model->size(); }
    /// Last primitive with this name.
    [[nodiscard]] Primitive named(const std::string& name) const {
        const auto all = test::all_primitives(*model);
        const auto found =
            std::find_if(all.rbegin(), all.rend(), [&](const auto& p) { return p.name == name; });
        REQUIRE(found != all.rend());
        return *found;
    }
};

Parsed parse(const std::string& text, const SceneReadOptions& options = inside("/nonexistent")) {
    Silence silence;
    Parsed result;
    try {
        result.model = parse_scene(text, "room.rad", options, silence);
    } catch (const InputError& error) {
        result.error = error.what();
    }
    result.warnings = silence.messages;
    return result;
}

Parsed read(const std::vector<std::string>& files, const SceneReadOptions& options) {
    Silence silence;
    Parsed result;
    try {
        result.model = read_scene(files, options, silence);
    } catch (const InputError& error) {
        result.error = error.what();
    }
    result.warnings = silence.messages;
    return result;
}

const std::string kPlastic = "void plastic red 0 0 5 .7 .1 .1 0 0\n";
const std::string kBall = "red sphere ball 0 0 4 0 0 0 1\n";

TEST_CASE("primitives may share a line, quote their words, and end lines as they like") {
    const Parsed scene = parse(
        "void plastic 'my \"red\"' 0 0 5 .7 .1 .1 0 0 \"my \"'\"red\"' sphere a\"b c\"d\r\n"
        "0\r\n0\r\n4 '1' +2 -.3e1 4. # done\r\n");
    CHECK(scene.error == "");
    REQUIRE(scene.size() == 2);
    CHECK(scene.at(1).name == "ab cd");
    CHECK(scene.at(1).modifier == 0);
    CHECK(scene.at(1).reals == std::vector<double>{1, 2, -3, 4});
    CHECK(scene.at(0).where.file == "room.rad");
    CHECK(scene.at(0).where.line == 1);
}

TEST_CASE("errors name file and line, what was found and what was expected") {
    struct Row {
        const char* text;
        const char* message;
    };
    const Row rows[] = {
        {"\nvoid plastic m # x\n0 0 0\n",
         "room.rad:2: bad arguments for plastic \"m\": expected the number of "
         "strings, found \"#\""},
        {"void plastic m 0 1 3 0",
         "room.rad:1: bad arguments for plastic \"m\": expected 0 integers, found \"1\""},
        {"void plastic m\n0\n0\n5 1 2 3",
         "room.rad:1: bad arguments for plastic \"m\": expected 2 more numbers, "
         "found the end of the text"},
        {"void plastic m 0 0 2 1 0x1",
         "room.rad:1: bad arguments for plastic \"m\": expected 1 more numbers, "
         "found \"0x1\""},
        {"void plastic m -1 0 0",
         "room.rad:1: bad arguments for plastic \"m\": expected the number of strings, "
         "found \"-1\""},
        {"void plastic m 2 a",
         "room.rad:1: bad arguments for plastic \"m\": expected 1 more strings, found the "
         "end of the text"},
        {"void plstic m 0 0 0", "room.rad:1: unknown type \"plstic\", did you mean \"plastic\"?"},
        {"void", "room.rad:1: unknown type \"\""},
        {"void plastic",
         "room.rad:1: bad arguments for plastic \"\": expected the number of strings, found the "
         "end of the text"},
        {"# a\nred sphere s 0 0 4 0 0 0 1", "room.rad:2: undefined modifier \"red\""},
        {"void plastic m 0 0 5 1 1 1 0 0 7\nvoid x",
         "room.rad:1: undefined modifier \"7\", did you mean \"m\"?"},
        {"inherit plastic m 0 0 0",
         "room.rad:1: inappropriate use of 'inherit' modifier: only an alias inherits"},
        {"void plastic void 0 0 0", "room.rad:1: illegal modifier name \"void\""},
        {"void plastic 'a\tb' 0 0 0", "room.rad:1: identifier \"a\tb\" holds a tab"},
        {"void alias x y", "room.rad:1: bad reference \"y\": no modifier has this name"},
        {"void alias x",
         "room.rad:1: bad arguments for alias \"x\": expected the modifier it stands for, found "
         "the end of the text"},
        {"void sphere s 0 0 4 0 0 0 1 s plastic p 0 0 0", "room.rad:1: undefined modifier \"s\""},
        {"void plastic m 99999999999 0 0",
         "room.rad:1: bad arguments for plastic \"m\": expected 99999999997 "
         "more strings, found the end of the text"},
    };
    for (const Row& row : rows) {
        CAPTURE(row.text);
        CHECK(parse(row.text).error == row.message);
    }
}

TEST_CASE("all problems that leave the rest readable are told at once, each with its first place") {
    const std::string text = kPlastic +
                             "!make_tree oak\n"
                             "rd sphere s 0 0 4 0 0 0 1\n"
                             "void plastik p 1 a 0 2 1 2\n"
                             "p sphere t 0 0 4 0 0 0 1\n"
                             "!make_tree elm\n" +
                             kBall;
    CHECK(parse(text).error ==
          "room.rad:2: command \"make_tree\" is not built in; --allow-commands runs it through the "
          "shell (and 1 more)\n"
          "room.rad:4: unknown type \"plastik\", did you mean \"plastic\"?");
    // Without commands that may have defined them, names that are missing are problems.
    const std::string names =
        "rd sphere s 0 0 4 0 0 0 1\nrd sphere t 0 0 4 0 0 0 1\nvoid alias a b\n"
        "a sphere u 0 0 4 0 0 0 1\nb sphere u 0 0 4 0 0 0 1\nred polygon p 0 0 2 1\n";
    CHECK(parse(names).error ==
          "room.rad:1: undefined modifier \"rd\" (and 1 more)\n"
          "room.rad:3: bad reference \"b\": no modifier has this name (and 1 more)\n"
          "room.rad:6: undefined modifier \"red\"\n"
          "room.rad:6: bad arguments for polygon \"p\": expected 1 more numbers, found the end of "
          "the text");
}

TEST_CASE("a caller that wants the problems gets the rest of the scene") {
    const TemporaryFolder folder;
    const std::string file = folder.write("room.rad", kPlastic + "!make_tree oak\n" + kBall);
    Silence silence;
    ProblemList problems;
    const auto model =
        read_scene(std::vector<std::string>{file}, inside(folder.path("")), silence, &problems);
    CHECK(model->size() == 2);
    CHECK(problems.text().starts_with(file + ":2: command \"make_tree\""));
}

TEST_CASE("what is neither octree nor text is refused before it is read") {
    CHECK(parse(std::string("void plastic\0", 13)).error ==
          "room.rad: neither an octree nor scene text: it holds zero bytes");
}

TEST_CASE("earlier users keep the old record of a redefined name, later ones get the new") {
    const Parsed scene = parse(kPlastic +
                               "red sphere a 0 0 4 0 0 0 1\n"
                               "void plastic red 0 0 5 .1 .1 .7 0 0 red sphere b 0 0 4 0 0 0 1\n");
    REQUIRE(scene.size() == 4);
    CHECK(scene.named("a").modifier == 0);
    CHECK(scene.named("b").modifier == 1);
}

TEST_CASE("an equal redefinition keeps identity: antimatter still means the old record") {
    const Parsed scene = parse(kPlastic + "void antimatter hole 1 red 0 0 " + kPlastic +
                               "red sphere s 0 0 4 0 0 0 1");
    CHECK(scene.named("hole").references == std::vector<std::int32_t>{0});
    CHECK(scene.named("s").modifier == 0);
}

TEST_CASE("the five forms of alias") {
    const std::string start =
        "void brightfunc P 2 f . 0 0 void brightfunc Q 2 g . 0 0 "
        "P plastic R 0 0 5 1 1 1 0 0 ";  // numbers 0, 1, 2
    const auto meaning = [&](const std::string& aliases) {
        const Parsed scene = parse(start + aliases + " X sphere s 0 0 4 0 0 0 1");
        REQUIRE(scene.error == "");
        const Primitive& m = scene.at(static_cast<std::size_t>(scene.named("s").modifier));
        CHECK(m.name == "X");  // what rtrace reports
        return std::pair{m.modifier, m.references.at(0)};
    };
    using Meaning = std::pair<std::int32_t, std::int32_t>;  // modifier, whose type and arguments
    CHECK(meaning("inherit alias X R") == Meaning{0, 2});
    CHECK(meaning("P alias X R") == Meaning{0, 2});
    CHECK(meaning("void alias X R") == Meaning{kVoidIndex, 2});
    CHECK(meaning("Q alias X R") == Meaning{1, 2});
    CHECK(meaning("Q alias Y R P alias X Y") == Meaning{0, 2});
    CHECK(meaning("void alias Y R inherit alias X Y") == Meaning{kVoidIndex, 2});
    CHECK(meaning("void alias R R inherit alias X R") == Meaning{kVoidIndex, 2});
}

TEST_CASE("commands are replaced by what they write, and keep their place in messages") {
    const TemporaryFolder folder;
    folder.write("ball.rad", kBall);
    folder.write("bad.rad", "\n\nblue sphere s 0 0 4 0 0 0 1\n");
    const Parsed scene = parse(
        kPlastic + "!cat ball.rad | xform -t 1 0 0\n !xform -n up -t 0 0 5 \\\n ball.rad\n" + kBall,
        inside(folder.path()));
    REQUIRE(scene.size() == 4);
    CHECK(scene.at(1).reals == std::vector<double>{1, 0, 0, 1});
    CHECK(scene.at(1).where.line == 2);
    CHECK(scene.at(2).name == "up.ball");
    CHECK(scene.at(2).where.line == 3);
    CHECK(scene.at(3).where.line == 5);
    CHECK(parse("\n!cat bad.rad", inside(folder.path())).error ==
          "room.rad:2: !cat bad.rad:3: undefined modifier \"blue\"");
}

TEST_CASE(
    "every command that fails is an error with its place, for a part of the scene is missing") {
    const TemporaryFolder folder;
    folder.write("lamp.rad", kPlastic + kBall + "red shpere b 0 0 4 0 0 3 .1\n" + kBall);
    folder.write("inner.rad", "!xform -t 1 0 0 no_such_file\n");
    const Parsed scene = parse(kPlastic + "!xform -t 1 0 lamp.rad\n!cat no_such_file\n" +
                                   "!xform -t 1 0 0 lamp.rad\n!xform inner.rad\n" +
                                   "!gensurf red s t t '1/(s-s)+1e308*10*s' 2 2\n" + kBall,
                               inside(folder.path()));
    const auto says = [&](const std::string& text) {
        CAPTURE(text);
        CHECK(scene.error.find(text) != std::string::npos);
    };
    says("room.rad:2: bad status from \"!xform -t 1 0 lamp.rad\": ");
    says("room.rad:3: bad status from \"!cat no_such_file\": ");
    says("room.rad:4: bad status from \"!xform -t 1 0 0 lamp.rad\": ");
    says("lamp.rad:3: ");
    says("unknown type \"shpere\"");
    says("room.rad:5: bad status from \"!xform ");
    says("no_such_file");
    says("room.rad:6: bad status from \"!gensurf red s t");
    CHECK(parse("# nothing\n").warnings == std::vector<std::string>{"room.rad: empty file"});
    CHECK(parse("# nothing\n").error.empty());
}

TEST_CASE("a failed command is told once, however often it stands in the scene") {
    const Parsed scene =
        parse("!xform -t 1 0 0 none\n!xform -t 2 0 0 none\n!xform -t 1 0 0 none\n");
    CHECK(scene.error ==
          "room.rad:1: bad status from \"!xform -t 1 0 0 none\": cannot find scene file \"none\" "
          "in /nonexistent (and 1 more)\n"
          "room.rad:2: bad status from \"!xform -t 2 0 0 none\": cannot find scene file \"none\" "
          "in /nonexistent");
}

TEST_CASE("what is named like an octree, a frozen scene or a mesh is no scene text") {
    const TemporaryFolder folder;
    const SceneReadOptions options = inside(folder.path());
    test::Silence silence;
    const auto error_of = [&](const std::string& name, const std::string& bytes) -> std::string {
        const std::vector<std::string> files{folder.write(name, bytes)};
        try {
            (void)read_scene(files, options, silence);
        } catch (const InputError& error) {
            return std::string(error.what()).substr(folder.path().size() + 1);
        }
        return {};
    };
    CHECK(error_of("a.oct", "") == "a.oct: not an octree: the file is empty");
    CHECK(error_of("b.oct", "#?RADIANCE\n") == "b.oct: not an octree");
    CHECK(error_of("c.oct", "# oconv: fatal\n") == "c.oct: not an octree");
    CHECK(error_of("a.lwz", "") == "a.lwz: not a frozen scene: the file is empty");
    CHECK(error_of("b.lwz", "light") == "b.lwz: not a frozen scene");
    CHECK(error_of("a.rtm", "") == "a.rtm: not scene text, but a mesh: the file is empty");
    CHECK(error_of("d", "#?RADIANCE\noconv a.rad\n#FORMAT") == "d:2: undefined modifier \"oconv\"");
    CHECK(error_of("e", "#?RADIANCE\n# oconv\n") ==
          "e: an information header without an end, expected an octree");
    CHECK(error_of("a.rad", "").empty());
    CHECK(silence.messages.size() == 1);
}

TEST_CASE("an error far within a long file has its exact line, and quotes what stands there") {
    const TemporaryFolder folder;
    std::string text = kPlastic;
    constexpr int kBalls = 200000;  // more than a fading text forgets at a time
    for (int i = 0; i < kBalls; ++i)
        text += "red sphere b" + std::string(70, 'a') + " 0 0 4 0 0 0 1\n";
    const std::string line = std::to_string(kBalls + 2);
    folder.write("good.rad", text + kBall);
    folder.write("number.rad", text + "red sphere last 0 0 4 0 x9 0 1\n");
    folder.write("names.rad",
                 text + "rd sphere s 0 0 4 0 0 0 1\nrd sphere s 0 0 4 0 0 0 1\nred x y\n");
    const Parsed good = read({"good.rad"}, inside(folder.path()));
    REQUIRE(good.size() == kBalls + 2);
    CHECK(good.at(kBalls + 1).name == "ball");
    CHECK(good.at(kBalls).name == good.at(1).name);
    CHECK(good.at(kBalls).where.line == kBalls + 1);
    const std::string path = folder.path("number.rad");
    CHECK(read({"number.rad"}, inside(folder.path())).error ==
          path + ":" + line +
              ": bad arguments for sphere \"last\": expected 3 more numbers, found \"x9\"");
    const std::string names = read({"names.rad"}, inside(folder.path())).error;
    CHECK(names.starts_with(folder.path("names.rad") + ":" + line +
                            ": undefined modifier \"rd\", did you mean \"red\"? (and 1 more)\n"));
    CHECK(names.find("unknown type \"x\"") != std::string::npos);
}

TEST_CASE("what gensurf writes by pieces is read as one text") {
    const std::string hill = "!gensurf red hill s t 's*t' 100 100\n";
    for (const bool beside : {false, true}) {  // or one after the other
        SceneReadOptions options = inside("/nonexistent");
        if (beside)
            options.pipe = [](TextSink& next) { return std::make_unique<ParseQueue>(next); };
        const Parsed scene = parse(kPlastic + hill + kBall, options);
        REQUIRE(scene.size() == 20002);
        CHECK(scene.warnings.empty());
        bool in_order = true;
        for (std::size_t i = 1; i <= 20000; ++i) {
            in_order = in_order && scene.at(i).name == "hill." + std::to_string(i) &&
                       scene.at(i).where.line == 2 && scene.at(i).reals.size() == 9;
        }
        CHECK(in_order);
        CHECK(scene.at(20001).where.line == 3);
        CHECK(parse("!gensurf inherit hill s t 's*t' 100 100\n", options).error ==
              "room.rad:1: !gensurf inherit hill s t 's*t' 100 100:3: inappropriate use of "
              "'inherit' modifier: only an alias inherits");
    }
    CHECK(parse("\n!gensurf rd hill s t 's*t' 100 100\n").error ==
          "room.rad:2: !gensurf rd hill s t 's*t' 100 100:3: undefined modifier \"rd\" (and 19999 "
          "more)");
}

TEST_CASE("a bad material that nothing uses is accepted") {
    CHECK(parse("void plastic unused 0 0 1 .5\n").size() == 1);
}

TEST_CASE("unknown programs need leave, and then run in the scene's directory") {
    const TemporaryFolder folder;
    folder.write("name.txt", "ball");
    CHECK(parse("\n!make_tree 7 | xform -t 0 0 1\n").error ==
          "room.rad:2: command \"make_tree\" is not built in; --allow-commands runs it through the "
          "shell");
    CHECK(parse("!genbox a b $SIZE 1 1\n").error ==
          "room.rad:1: \"!genbox a b $SIZE 1 1\" needs a shell; --allow-commands runs it through "
          "one");
    SceneReadOptions options = inside(folder.path());
    options.allow_commands = true;
    const Parsed scene = parse("!echo void sphere $(cat name.txt) 0 0 4 0 0 0 1\n", options);
    REQUIRE(scene.size() == 1);
    CHECK(scene.at(0).name == "ball");
    CHECK(scene.warnings.empty());
    CHECK(parse("!echo void sphere b 0 0 4 0 0 0 1; exit 3\n", options).error ==
          "room.rad:1: bad status from \"!echo void sphere b 0 0 4 0 0 0 1; exit 3\"");
}

TEST_CASE("commands do not read the program's input") {
    SceneReadOptions options = inside("");
    options.allow_commands = true;
    CHECK(parse("!sed p\n", options).size() == 0);
    CHECK(parse("!cat\n").size() == 0);
    CHECK(parse("!xform -t 1 2 3\n").size() == 0);
}

TEST_CASE("a file that reads itself ends with an error") {
    const TemporaryFolder folder;
    folder.write("self.rad", kBall + "!xform -t 1 0 0 self.rad\n");
    folder.write("cat.rad", "!cat cat.rad\n");
    folder.write("twice.rad", "!cat twice.rad\n!cat twice.rad\n");
    const std::string error = parse(kPlastic + "!xform -s 2 self.rad", inside(folder.path())).error;
    CHECK(error ==
          "room.rad:2: commands nest more than 64 levels deep at \"!xform -t 1 0 0 self.rad\": "
          "does a "
          "file read itself?");
    CHECK(parse("!cat cat.rad", inside(folder.path())).error ==
          "room.rad:1: commands that write commands nest more than 64 levels deep");
    CHECK(parse("!cat twice.rad", inside(folder.path())).error != "");
}

TEST_CASE("files share one name space in order, they are opened as given, without a search") {
    const TemporaryFolder folder;
    folder.write("mat.rad", kPlastic);
    folder.write("geo.rad", kBall);
    folder.write("lib/other.rad", kBall);
    SceneReadOptions options = inside(folder.path());
    options.library = LibraryPath(std::vector<std::string>{folder.path() + "/lib"});
    const Parsed scene = read({"mat.rad", "geo.rad", "!cat geo.rad"}, options);
    CHECK(scene.size() == 3);
    CHECK(scene.at(1).where.file == folder.path() + "/geo.rad");
    CHECK(read({"geo.rad", "mat.rad"}, options).error ==
          folder.path() + "/geo.rad:1: undefined modifier \"red\"");
    CHECK(read({"other.rad"}, options).error ==
          folder.path() + "/other.rad: cannot open: No such file or directory");
    CHECK(read({}, options).error == "no scene: expected one octree, or scene files");
}

TEST_CASE("commands inside a file that xform reads run in that file's directory") {
    const TemporaryFolder folder;
    folder.write("parts/chair.rad",
                 "!xform -t 0 1 0 leg.rad\n!xform -t 0 2 0 ./leg.rad\n!cat leg.rad");
    folder.write("parts/leg.rad", kBall);
    const Parsed scene =
        parse(kPlastic + "!xform -t 10 0 0 parts/chair.rad\n", inside(folder.path()));
    CHECK(scene.warnings.empty());
    REQUIRE(scene.size() == 4);
    CHECK(scene.at(1).reals == std::vector<double>{10, 1, 0, 1});
    CHECK(scene.at(2).reals == std::vector<double>{10, 2, 0, 1});
    CHECK(scene.at(3).reals == std::vector<double>{10, 0, 0, 1});
}

}  // namespace
}  // namespace lightwalk
