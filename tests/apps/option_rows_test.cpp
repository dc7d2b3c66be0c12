#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <iomanip>
#include <iterator>
#include <set>
#include <sstream>

#include "apps/commands.h"

using namespace lightwalk;

namespace {

/// What is said to a command line of one option; "" when it is taken whole.
std::string refusal(const OptionTable& table, std::vector<std::string> line) {
    OptionWords words(std::move(line));
    REQUIRE(words.at_option());
    bool taken = false;
    try {
        taken = table.take(words);
    } catch (const UsageError& error) {
        return error.what();
    }
    CHECK(taken);
    CHECK_FALSE(words.at_option());
    return "";
}

/// Calls check(table, row) for each option that a command takes or refuses by name.
template <class Check>
void for_each_row(const Command& command, const Check& check) {
    const OptionTable table = command.options();
    for (const OptionRow& row : table.rows()) {
        if (std::holds_alternative<SectionTitle>(row.place)) continue;
        CAPTURE(command.name);
        CAPTURE(row.words);
        check(table, row);
    }
}

/// The option with arguments, as one writes it.
std::vector<std::string> written(const OptionRow& row, const std::string& arguments) {
    std::vector<std::string> line{row.name() + (row.attached() ? arguments : "")};
    std::istringstream words(row.attached() ? "" : arguments);
    for (std::string word; words >> word;) line.push_back(word);
    return line;
}

/// Arguments that the row must refuse, just beyond its limits.
std::vector<std::string> wrong_arguments(const OptionRow& row) {
    std::vector<std::string> wrong;
    const bool number = std::holds_alternative<int*>(row.place) ||
                        std::holds_alternative<float*>(row.place) ||
                        std::holds_alternative<double*>(row.place) ||
                        std::holds_alternative<std::uint64_t*>(row.place);
    if (number || std::holds_alternative<Choice>(row.place)) wrong.emplace_back("nonsense");
    if (!number) return wrong;
    const auto text = [](double value) {
        std::ostringstream stream;
        stream << std::setprecision(10) << value;
        return stream.str();
    };
    if (row.with.least > -kUnlimited) wrong.push_back(text(row.with.least - 1));
    if (row.with.most < kUnlimited) wrong.push_back(text(row.with.most + 1));
    if (std::holds_alternative<std::uint64_t*>(row.place)) wrong.emplace_back("-1");
    return wrong;
}

/// Whether a help text lists the option: before its explanation, or among the names of options that
/// another command's help explains.
bool lists(const std::string& help, const OptionRow& row) {
    std::istringstream lines(help);
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("  " + row.words + "  ")) return true;
        // A line of names: "  Title: -a -b", or its continuation.
        const std::size_t colon = std::min(line.find(": "), line.size());
        std::istringstream words(line.starts_with("    ") ? line : line.substr(colon));
        std::vector<std::string> all;
        for (std::string word; words >> word;)
            if (word != ":") all.push_back(word);
        const bool names =
            std::ranges::all_of(all, [](const std::string& word) { return word.starts_with('-'); });
        if (names && std::ranges::find(all, row.name()) != all.end()) return true;
    }
    return false;
}

bool has_few_options(const Command& command) {
    const std::string name = command.name;
    return name == "relight" || name == "launch" || name == "install-names";
}

}  // namespace

TEST_CASE("options: every one takes its own default, and keeps it") {
    for (const Command& command : commands()) {
        int count = 0;
        for_each_row(command, [&](const OptionTable& table, const OptionRow& row) {
            const std::string before = row.value("%.9g");
            if (before.empty() || row.with.shown != nullptr) return;
            CHECK(refusal(table, written(row, before)).empty());
            CHECK(row.value("%.9g") == before);
            ++count;
        });
        if (!has_few_options(command)) CHECK(count >= 8);
    }
}

TEST_CASE("options: what is out of range, or missing, is refused by a message that says so") {
    for (const Command& command : commands()) {
        int count = 0;
        for_each_row(command, [&](const OptionTable& table, const OptionRow& row) {
            const std::string before = row.value("%.9g"), begin = "option " + row.name();
            const std::vector<std::string> wrong = wrong_arguments(row);
            for (const std::string& argument : wrong) {
                const std::string said = refusal(table, {row.name(), argument});
                CAPTURE(said);
                CHECK(said.starts_with(begin));
                CHECK(said.find(": expected ") != std::string::npos);
                CHECK(said.find(argument) != std::string::npos);
                if (const auto* choice = std::get_if<Choice>(&row.place))
                    for (const std::string& word : choice->words)
                        CHECK(said.find(word) != std::string::npos);
                ++count;
            }
            if (!wrong.empty()) CHECK(refusal(table, {row.name()}).starts_with(begin));
            CHECK(row.value("%.9g") == before);
        });
        if (!has_few_options(command)) CHECK(count >= 8);
    }
}

TEST_CASE("options: --help lists what the command takes, and nothing else") {
    std::set<std::string> every;
    for (const Command& command : commands())
        for_each_row(command,
                     [&](const OptionTable&, const OptionRow& row) { every.insert(row.name()); });
    CHECK(every.size() > 100);
    for (const Command& command : commands()) {
        const std::string help = help_text(command.name);
        std::set<std::string> taken;
        for_each_row(command, [&](const OptionTable&, const OptionRow& row) {
            if (!row.offered()) return;
            taken.insert(row.name());
            CHECK(lists(help, row));
        });
        for (const std::string& name : every) {
            CAPTURE(command.name);
            CAPTURE(name);
            if (!taken.contains(name)) CHECK_FALSE(lists(help, {name, SectionTitle{}}));
        }
    }
}

TEST_CASE(
    "options: each name stands for one option of a command, and is what a misspelling meant") {
    for (const Command& command : commands()) {
        std::set<std::string> names;
        for_each_row(command, [&](const OptionTable& table, const OptionRow& row) {
            if (!row.offered()) return;
            CHECK(names.insert(row.name()).second);
            if (!row.name().starts_with("--")) return;
            OptionWords words({row.name() + "x"});
            REQUIRE(words.at_option());
            CHECK_THROWS_WITH_AS(
                table.refuse(words),
                ("unknown option " + row.name() + "x, did you mean " + row.name() + "?").c_str(),
                UsageError);
        });
    }
}

TEST_CASE(
    "options: --ablate is for tests: taken, refused with the words that it knows, never shown") {
    for (const Command& command : commands()) {
        const OptionTable table = command.options();
        CHECK(help_text(command.name).find("ablate") == std::string::npos);
        const bool takes = std::ranges::any_of(
            table.rows(), [](const OptionRow& row) { return row.name() == "--ablate"; });
        if (!takes) continue;
        CHECK(refusal(table, {"--ablate", "packets,batches"}).empty());
        const std::string said = refusal(table, {"--ablate", "leaves,lanes"});
        CHECK(said.starts_with("option --ablate: expected some of batches, function-lanes"));
        CHECK(said.ends_with("found \"lanes\""));
    }
}

TEST_CASE("options: apps/OPTIONS.md is what `lightwalk help options` prints") {
    std::ifstream file(LIGHTWALK_SOURCE "/apps/OPTIONS.md");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    CHECK(text == help_text("options"));
}

TEST_CASE("manual pages: each command has one, with each option that it takes") {
    const auto escaped = [](std::string name) {
        for (std::size_t at = 0; (at = name.find('-', at)) != std::string::npos; at += 2)
            name.insert(at, 1, '\\');
        return name;
    };
    const std::string program = manual_text("");
    for (const Command& command : commands()) {
        CAPTURE(command.name);
        CHECK(program.find(escaped(std::string("lightwalk-") + command.name + "(1): ")) !=
              std::string::npos);
        const std::string page = manual_text(command.name);
        const OptionTable table = command.options();
        for (const OptionRow& row : table.rows()) {
            if (!row.offered()) continue;
            CAPTURE(row.words);
            const std::string name = escaped(row.words.substr(0, row.words.find(' ')));
            CHECK(page.find(".TP\n\\fB" + name + "\\fR") != std::string::npos);
        }
    }
    CHECK_THROWS_WITH_AS((void)manual_text("paint"), "help man: there is no command paint",
                         UsageError);
}
