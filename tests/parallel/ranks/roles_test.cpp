#include "parallel/ranks/roles.h"

#include <doctest/doctest.h>

#include <set>

#include "tests/parallel/ranks/role_network.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

/// Every pixel of the picture is what was traced there, and was traced once.
void check_picture(const RoleNetwork& network, const FinishedPicture& picture,
                   const PixelRectangle& area) {
    std::set<std::pair<int, int>> seen;
    for (const PicturePiece& piece : picture.pieces) {
        const PixelRectangle& block = piece.work.block;
        REQUIRE(piece.bytes.size() == block.pixels() * sizeof(PixelValue));
        std::vector<PixelValue> values(block.pixels());
        std::memcpy(values.data(), piece.bytes.data(), piece.bytes.size());
        std::size_t i = 0;
        for (int y = block.y0; y < block.y1; ++y) {
            for (int x = block.x0; x < block.x1; ++x, ++i) {
                REQUIRE(values[i] == pixel_of(picture.job, x, y));
                REQUIRE(seen.emplace(x, y).second);
                REQUIRE(network.traced.at({picture.job, x, y}) == 1);
            }
        }
    }
    CHECK(seen.size() == area.pixels());
}

NetworkOptions some_options(std::mt19937_64& random) {
    const auto one_of = [&](std::initializer_list<int> list) {
        return *(list.begin() + static_cast<std::ptrdiff_t>(random() % list.size()));
    };
    NetworkOptions options;
    options.variant = random() % 2 == 0 ? Variant::ranks : Variant::hybrid;
    options.ranks = one_of({3, 4, 5, 9, 16});
    options.batch = static_cast<std::size_t>(one_of({0, 1, 3}));
    options.masters = options.ranks >= 9 ? one_of({1, 2, 3}) : 1;
    options.slots = options.variant == Variant::ranks ? 1 : one_of({1, 2, 4});
    options.ahead = one_of({0, 1, 3});
    options.block = one_of({0, 0, 4, 16});
    options.stride = one_of({0, 1, 7});
    options.values_a_block = .4;
    options.longest_delay = one_of({0, 1, 10});
    options.longest_block = one_of({1, 5});
    return options;
}

}  // namespace

TEST_CASE(
    "a thousand schedules: no pixel and no ambient value is lost or doubled, nobody waits for "
    "ever") {
    std::mt19937_64 random(1);
    for (int schedule = 0; schedule < 1000; ++schedule) {
        CAPTURE(schedule);
        RoleNetwork network(some_options(random), random());
        const PixelRectangle area{0, 0, 20 + static_cast<int>(random() % 20), 15};
        const PixelRectangle small{3, 2, 9, 5};
        // A sequence: the second picture begins while blocks of the first are out.
        network.submit({0, small, 1, false, "overture", {}, false});
        network.submit({1, area, 4, true, "first", {}, false});
        network.submit({2, small, 1, true, "second", {}, false});
        network.run();
        network.exchange_all();  // everyone tells
        network.exchange_all();  // and hears
        REQUIRE(network.pictures.size() == 2);
        for (const FinishedPicture& picture : network.pictures)
            check_picture(network, picture, picture.job == 1 ? area : small);
        CHECK(network.shares[1] <= 1 + 1e-9);  // rounding of the sum
        for (int y = small.y0; y < small.y1; ++y) {
            for (int x = small.x0; x < small.x1; ++x) REQUIRE(network.traced.at({0, x, y}) == 1);
        }
        for (RoleNetwork::Rank& rank : network.ranks()) {
            if (!rank.ambient_client) continue;
            const std::set<std::uint32_t> known(rank.values.begin(), rank.values.end());
            CHECK(known.size() == network.values_made);
            CHECK(rank.values.size() == network.values_made);
        }
    }
}

TEST_CASE("jobs may follow each other for ever") {
    NetworkOptions options;
    options.ranks = 4;
    RoleNetwork network(options, 3);
    for (JobId job = 0; job < 200; ++job) {
        network.submit({job, {0, 0, 12, 9}, 1, true, "", {}, false});
        if (job % 4 == 3) network.run();
    }
    network.run();
    CHECK(network.pictures.size() == 200);
}

TEST_CASE("blocks are handed out in strides, or one after the other") {
    const auto order = [](int stride) {
        MasterRole master({0, Role::master}, {{1, Role::worker}}, 1, {8, stride, 1});
        Outbox out;
        master.handle({{0, Role::program},
                       {0, Role::master},
                       JobStart{0, {0, 0, 64, 8}, 1, true, "", {}, false}},
                      out);
        out.clear();
        master.handle({{1, Role::worker}, {0, Role::master}, AskBlocks{8, {}}}, out);
        std::vector<int> columns;
        for (const JobBlock& block : std::get<GiveBlocks>(out.at(0).message).blocks)
            columns.push_back(block.block.x0 / 8);
        return columns;
    };
    CHECK(order(1) == std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7});
    CHECK(order(3) == std::vector<int>{0, 3, 6, 1, 4, 7, 2, 5});
}

TEST_CASE(
    "blocks whose size is left to the master get smaller towards the end, and not too small") {
    MasterRole master({0, Role::master}, {{1, Role::worker}}, 1, {0, 1, 4});
    Outbox out;
    master.handle({{0, Role::program},
                   {0, Role::master},
                   JobStart{0, {0, 0, 256, 256}, 2, true, "", {}, false}},
                  out);
    std::vector<std::size_t> sizes;
    std::vector<FinishedBlock> finished;
    constexpr double kSecondsAPixel = 1e-4;  // so that .002 s are 20 pixels
    for (;;) {
        out.clear();
        master.handle({{1, Role::worker}, {0, Role::master}, AskBlocks{1, finished}}, out);
        const GiveBlocks* given = nullptr;
        for (const Envelope& envelope : out) {
            if (const auto* found = std::get_if<GiveBlocks>(&envelope.message)) given = found;
        }
        if (given == nullptr) break;
        const JobBlock block = given->blocks.at(0);
        CHECK(block.block.x0 % 2 == 0);
        CHECK(block.block.y0 % 2 == 0);
        sizes.push_back(block.block.pixels());
        finished = {{block, kSecondsAPixel * static_cast<double>(block.block.pixels())}};
    }
    std::size_t sum = 0;
    for (const std::size_t size : sizes) sum += size;
    CHECK(sum == 256 * 256);
    CHECK(sizes.front() > 16 * sizes.back());
    CHECK(*std::min_element(sizes.begin(), sizes.end()) >= 4);
    CHECK(sizes.size() < 1000);
}

TEST_CASE("sub-masters spare the master messages") {
    NetworkOptions options;
    options.ranks = 40;
    options.block = 4;
    const auto messages = [&](int masters) {
        options.masters = masters;
        RoleNetwork network(options, 7);
        network.submit({0, {0, 0, 160, 120}, 1, true, "", {}, false});
        network.run();
        REQUIRE(network.pictures.size() == 1);
        return network.messages_to_master;
    };
    CHECK(messages(4) < messages(1) / 2);
}
