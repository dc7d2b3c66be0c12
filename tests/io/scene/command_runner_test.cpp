#include "io/scene/command_runner.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "tests/temporary_folder.h"
#include "tests/test_scene.h"

namespace lightwalk {
namespace {

struct Collector final : TextSink {
    void push(std::string_view piece) override { pieces.emplace_back(piece); }
    [[nodiscard]] std::string whole() const {
        std::string all;
        for (const std::string& piece : pieces) all += piece;
        return all;
    }
    std::vector<std::string> pieces;
};

/// Takes one piece, and no more.
struct Thrower final : TextSink {
    void push(std::string_view) override {
        if (taken++ > 0) throw InputError("bad piece");
    }
    int taken = 0;
};

Collector collect(const std::string& command, const std::string& directory = "") {
    test::Silence silence;
    CommandRunner runner(LibraryPath({"."}), false, silence);
    Collector collector;
    runner.run(command, directory, {"room.rad", 1}, collector);
    CHECK(silence.messages.empty());
    return collector;
}

std::string run_whole(const std::string& command, const std::string& directory = "") {
    test::Silence silence;
    CommandRunner runner(LibraryPath({"."}), false, silence);
    return runner.run(command, directory, {"room.rad", 1});
}

const std::string kHill = "!gensurf m hill '10*s' '10*t' 'sin(5*s)*cos(3*t)' 150 150";

}  // namespace

TEST_CASE("gensurf by pieces is gensurf whole, cut between primitives") {
    for (const std::string& command :
         {kHill, kHill + " -s", kHill + " -i", std::string("!gensurf m s s t 0 2 2"),
          kHill + " -e 'valid(s,t)=1.3-s-t'"}) {
        CAPTURE(command);
        const Collector hill = collect(command);
        CHECK(hill.whole() == run_whole(command));
        for (std::size_t i = 0; i + 1 < hill.pieces.size(); ++i) {
            CHECK(hill.pieces[i].size() >= kPieceBytes);
            CHECK(hill.pieces[i].size() < kPieceBytes + 2000);
            CHECK(hill.pieces[i].ends_with('\n'));
            CHECK(hill.pieces[i + 1].starts_with('\n'));
        }
    }
    CHECK(collect(kHill).pieces.size() > 3);
}

TEST_CASE("a command that ends in other programs, or in several, comes whole") {
    for (const std::string& command : {kHill + " | xform -t 1 0 0", kHill + "; " + kHill.substr(1),
                                       std::string("!gensurf '#m' hill s t 's*t' 90 90")}) {
        const Collector output = collect(command);
        REQUIRE(output.pieces.size() == 1);
        CHECK(output.pieces[0] == run_whole(command));
        CHECK(output.pieces[0].size() > kPieceBytes);
    }
}

TEST_CASE("who takes the pieces may refuse one: that is not a command that fails") {
    test::Silence silence;
    CommandRunner runner(LibraryPath({"."}), false, silence);
    Thrower thrower;
    CHECK_THROWS_WITH_AS(runner.run(kHill, "", {"room.rad", 1}, thrower), "bad piece", InputError);
    CHECK(thrower.taken == 2);
    CHECK(silence.messages.empty());
}

TEST_CASE("a gensurf that fails is an error") {
    test::Silence silence;
    CommandRunner runner(LibraryPath({"."}), false, silence);
    Collector collector;
    try {
        runner.run("!gensurf m s s t '1/(s-s)+1e308*10*s' 2 2", "", {"room.rad", 7}, collector);
        FAIL("no error");
    } catch (const FailedCommandError& error) {
        CHECK(std::string(error.what()).starts_with("room.rad:7: bad status from \"!gensurf m s"));
    }
    CHECK(collector.whole().empty());
}

}  // namespace lightwalk
