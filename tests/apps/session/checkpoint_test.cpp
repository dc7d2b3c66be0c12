#include "apps/session/checkpoint.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tests/temporary_folder.h"
#include "tests/test_scene.h"

using namespace lightwalk;
using lightwalk::test::Silence;
using lightwalk::test::TemporaryFolder;

namespace {

const std::string kHeader = "one line\nanother line\n";
constexpr PixelRectangle kWhole{0, 0, 16, 8};

/// Pixels that tell where they are.
BlockPixels block_at(const PixelRectangle& block, float brightness = 1) {
    BlockPixels pixels;
    pixels.block = block;
    for (int y = block.y0; y < block.y1; ++y)
        for (int x = block.x0; x < block.x1; ++x)
            pixels.values.push_back(
                {{brightness * static_cast<float>(x + 1), static_cast<float>(y), 0.5f},
                 static_cast<float>(x * y)});
    return pixels;
}

bool same(const BlockPixels& a, const BlockPixels& b) {
    bool equal = a.block == b.block && a.values.size() == b.values.size();
    for (std::size_t i = 0; equal && i < a.values.size(); ++i)
        equal = a.values[i].radiance == b.values[i].radiance &&
                a.values[i].distance == b.values[i].distance;
    return equal;
}

struct Files {
    TemporaryFolder folder;
    std::string path = folder.path("run.ckpt");
    Silence warnings;

    [[nodiscard]] std::unique_ptr<Checkpoint> open(const std::string& header = kHeader) {
        return std::make_unique<Checkpoint>(path, header, warnings);
    }
    void keep(int frame, const std::vector<BlockPixels>& blocks) {
        const auto checkpoint = open();
        const auto picture = checkpoint->picture(frame, kWhole);
        for (const BlockPixels& block : blocks) picture->keep(block);
    }
};

}  // namespace

TEST_CASE(
    "checkpoint: the blocks that one run kept are those that the next one knows, to the bit") {
    Files files;
    const BlockPixels left = block_at({0, 0, 8, 8}), right = block_at({8, 0, 16, 4}, 1e-7f);
    files.keep(3, {left, right});
    const auto checkpoint = files.open();
    const std::vector<BlockPixels> known = checkpoint->picture(3, kWhole)->known();
    REQUIRE(known.size() == 2);
    CHECK(same(known[0], left));
    CHECK(same(known[1], right));
    CHECK(checkpoint->picture(4, kWhole)->known().empty());
    checkpoint->forget(3);
    CHECK(checkpoint->picture(3, kWhole)->known().empty());
    CHECK(files.warnings.messages.empty());
}

TEST_CASE("checkpoint: with other values of an ambient file than before nothing is known") {
    Files files;
    const auto open = [&](const std::string& beginning) {
        return std::make_unique<Checkpoint>(files.path, kHeader, files.warnings, beginning);
    };
    CHECK(Checkpoint::beginning_of(files.path).empty());
    const BlockPixels block = block_at({0, 0, 8, 8});
    {
        const auto checkpoint = open("12 345");
        // Before anything is kept: from now on the file grows.
        CHECK(Checkpoint::beginning_of(files.path) == "12 345");
        const auto picture = checkpoint->picture(1, kWhole);
        (void)picture->known_steps("empty cache");
        picture->keep_step("points");
        picture->keep(block);
    }
    CHECK(open("12 345")->picture(1, kWhole)->known().size() == 1);
    CHECK(open("12 345")->has_rounds(1));
    {
        const auto checkpoint = open("24 678");
        CHECK(Checkpoint::beginning_of(files.path) == "24 678");
        CHECK(checkpoint->picture(1, kWhole)->known().empty());
        CHECK_FALSE(checkpoint->has_rounds(1));
        checkpoint->picture(2, kWhole)->keep(block);
    }
    const auto checkpoint = open("24 678");
    CHECK(checkpoint->picture(1, kWhole)->known().empty());
    CHECK(checkpoint->picture(2, kWhole)->known().size() == 1);
    CHECK(files.warnings.messages.empty());
    (void)files.folder.write("other", "not a log\n\n");
    CHECK(Checkpoint::beginning_of(files.folder.path("other")).empty());
}

TEST_CASE("checkpoint: steps of rounds are known where these began alike") {
    Files files;
    const auto steps_of = [&](int frame, const std::string& beginning,
                              const std::vector<std::string>& more) {
        const auto checkpoint = files.open();
        const auto picture = checkpoint->picture(frame, kWhole);
        picture->keep(block_at({0, 0, 8, 8}));
        std::vector<std::string> known = picture->known_steps(beginning);
        for (const std::string& step : more) picture->keep_step(step);
        return known;
    };
    using Steps = std::vector<std::string>;
    CHECK(steps_of(1, "empty", {"one", "two"}).empty());
    CHECK(steps_of(2, "empty", {"other"}).empty());
    CHECK(steps_of(1, "empty", {"three"}) == Steps{"one", "two"});
    CHECK(steps_of(1, "empty", {}) == Steps{"one", "two", "three"});
    CHECK(steps_of(1, "not empty", {"1"}).empty());
    CHECK(steps_of(1, "not empty", {}) == Steps{"1"});
    CHECK(steps_of(1, "empty", {}).empty());
    CHECK(steps_of(2, "empty", {}) == Steps{"other"});
    CHECK(files.open()->picture(1, kWhole)->known().size() == 1);
}

TEST_CASE("checkpoint: runs that are continued more than once add to what is known") {
    Files files;
    files.keep(0, {block_at({0, 0, 8, 8})});
    files.keep(0, {block_at({8, 0, 16, 8})});
    CHECK(files.open()->picture(0, kWhole)->known().size() == 2);
}

TEST_CASE("checkpoint: blocks that lie beyond the picture, or on each other, are not known") {
    Files files;
    files.keep(0, {block_at({0, 0, 8, 8}), block_at({4, 4, 12, 8}), block_at({8, 0, 17, 8}),
                   block_at({12, 0, 16, 8})});
    const auto checkpoint = files.open();
    const std::vector<BlockPixels> known = checkpoint->picture(0, kWhole)->known();
    REQUIRE(known.size() == 2);
    CHECK(known[0].block == PixelRectangle{0, 0, 8, 8});
    CHECK(known[1].block == PixelRectangle{12, 0, 16, 8});
}

TEST_CASE("checkpoint: a file of another run is refused, and stays as it was") {
    Files files;
    files.keep(0, {block_at({0, 0, 8, 8})});
    CHECK_THROWS_AS((void)files.open("one line\na third line\n"), InputError);
    CHECK(files.open()->picture(0, kWhole)->known().size() == 1);
}

TEST_CASE("checkpoint: of a file that was cut short the whole blocks are left, and it is said") {
    Files files;
    files.keep(0, {block_at({0, 0, 8, 8}), block_at({8, 0, 16, 8})});
    std::filesystem::resize_file(files.path, std::filesystem::file_size(files.path) - 3);
    CHECK(files.open()->picture(0, kWhole)->known().size() == 1);
    CHECK(files.warnings.messages.size() == 1);
}

TEST_CASE("checkpoint: a run that is whole leaves no file") {
    Files files;
    files.keep(0, {block_at({0, 0, 8, 8})});
    files.open()->remove();
    CHECK_FALSE(std::filesystem::exists(files.path));
}
