#include "io/ambient/ambient_store.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/ambient/serial_cache.h"
#include "io/ambient/ambient_file.h"
#include "io/files/library_path.h"
#include "tests/temporary_folder.h"

namespace lightwalk::test {
namespace {

struct Warnings final : WarningSink {
    void warn(const std::string& message) override { all.push_back(message); }
    std::vector<std::string> all;
};

RenderOptions options_of(int bounces, double accuracy) {
    RenderOptions options;
    options.ambient_bounces = bounces;
    options.ambient_accuracy = accuracy;
    return options;
}

AmbientRecord record(int level, float x) {
    AmbientRecord r;
    r.position = {x, 0.25f, 0.25f};
    r.normal = r.axis = 0x12345678;
    r.radius = {0.05f, 0.05f};
    r.value = {1, 1, 1};
    r.level = static_cast<std::uint8_t>(level);
    return r;
}

/// A run: its cache, and the file before it.
struct Run {
    Run(const std::string& path, const RenderOptions& options,
        OthersValues others = OthersValues::taken, const std::string& begun = {})
        : cache(ambient_limits({}, 1, options.ambient_accuracy, options.ambient_resolution)),
          store(path, options, cache, warnings, others, begun) {}
    [[nodiscard]] std::uint64_t values() const { return cache.log_mean().count; }
    void insert(const AmbientRecord& record) {
        cache.insert(record);
        store.stored(record, {});
    }
    Warnings warnings;
    SerialCache cache;
    AmbientStore store;
};

TEST_CASE("ambient files: a run that goes on has the values with which it began") {
    const TemporaryFolder folder;
    const std::string path = folder.path("a.amb");
    const RenderOptions options = options_of(2, 0.2);
    const auto go_on = [&](const std::string& begun) {
        return Run(path, options, OthersValues::left, begun);
    };
    Run(path, options).insert(record(0, 0.125f));
    std::string begun;
    {
        Run run(path, options, OthersValues::left);
        begun = run.store.beginning();
        run.insert(record(0, 0.25f));
        CHECK(run.store.beginning() == begun);
    }                                             // killed
    Run(path, options).insert(record(0, 0.75f));  // another one
    const std::string grown = read_file(path);
    {
        Run again = go_on(begun);
        CHECK(again.values() == 1);
        CHECK(again.store.beginning() == begun);
        again.insert(record(0, 0.25f));
        CHECK(read_file(path) == grown);  // it is there
        again.insert(record(0, 0.5f));
        CHECK(read_file(path).size() == grown.size() + kAmbientRecordSize);
        again.insert(record(0, 0.25f));  // there is another one like it
        CHECK(read_file(path).size() == grown.size() + 2 * kAmbientRecordSize);
        CHECK(again.warnings.all.empty());
    }
    const auto begins_anew = [&](const std::string& wanted) {
        Run run = go_on(wanted);
        CHECK(run.store.beginning() != wanted);
        REQUIRE(run.warnings.all.size() == 1);
        CHECK(run.warnings.all[0].find("begins anew") != std::string::npos);
        return run.values();
    };
    CHECK(begins_anew("12 345") == 5);
    CHECK(begins_anew("nonsense") == 5);
    std::string changed = read_file(path);
    changed[std::stoul(begun) - 1] ^= 1;
    (void)folder.write("a.amb", changed);
    CHECK(begins_anew(begun) == 5);
    std::filesystem::remove(path);
    CHECK(begins_anew(begun) == 0);
}

TEST_CASE("ambient files of other options: values that serve are used, one warning tells why") {
    const TemporaryFolder folder;
    const std::string path = folder.path("a.amb");
    {
        Run coarse(path, options_of(2, 0.2));
        coarse.insert(record(0, 0.125f));
        coarse.insert(record(1, 0.5f));
        CHECK(coarse.warnings.all.empty());
    }
    const std::string before = read_file(path);
    for (const double accuracy : {0.1, 0.4}) {
        const Run other(path, options_of(2, accuracy));
        CHECK(other.values() == 2);
        REQUIRE(other.warnings.all.size() == 1);
        CHECK(other.warnings.all[0].starts_with(
            path + ": the ambient file was made with -aa 0.2 (not 0."));
        CHECK(other.warnings.all[0].ends_with("): 2 of its 2 values are used"));
    }
    const Run fewer(path, options_of(1, 0.2));
    CHECK(fewer.values() == 1);
    CHECK(read_file(path) == before);
    const Run same(path, options_of(2, 0.2));
    CHECK(same.warnings.all.empty());
    CHECK(same.values() == 2);
}

TEST_CASE("ambient files of other options: what a run adds means the same under the file's own") {
    const TemporaryFolder folder;
    const std::string path = folder.path("a.amb");
    { Run first(path, options_of(2, 0.2)); }
    {
        Run shorter(path, options_of(1, 0.2));
        shorter.insert(record(0, 0.5f));  // one bounce: level 1 of two
        Run longer(path, options_of(3, 0.2));
        CHECK(
            longer.warnings.all.at(0).ends_with("1 of its 1 values are used, and values of more "
                                                "bounces than its own are not stored in it"));
        longer.insert(record(0, 0.25f));  // three bounces: the file cannot say that
        longer.insert(record(1, 0.75f));  // two
        CHECK(longer.values() == 3);
    }
    const AmbientFile file = decode_ambient_file(read_file(path), path);
    REQUIRE(file.records.size() == 2);
    CHECK(file.records[0].level == 1);
    CHECK(file.records[1].level == 0);
    CHECK(file.records[1].position[0] == 0.75f);
}

TEST_CASE(
    "ambient files of two runs at once: each adds its values, and takes the other's, or none") {
    const TemporaryFolder folder;
    const std::string path = folder.path("a.amb");
    Run takes(path, options_of(2, 0.2));
    Run leaves(path, options_of(2, 0.2), OthersValues::left);
    takes.insert(record(0, 0.125f));
    leaves.insert(record(0, 0.25f));
    takes.insert(record(0, 0.5f));
    leaves.insert(record(0, 0.75f));
    CHECK(takes.values() == 3);  // two, and the one that was there when it stored the second
    CHECK(leaves.values() == 2);
    const AmbientFile file = decode_ambient_file(read_file(path), path);
    CHECK(file.records.size() == 4);
    CHECK(Run(path, options_of(2, 0.2), OthersValues::left).values() == 4);
}

TEST_CASE("ambient files that cannot be read are refused and stay as they are") {
    const TemporaryFolder folder;
    const std::string good = encode_ambient_header({"lightwalk -ab 1"});
    std::string version = good;
    version.back() = static_cast<char>(version.back() + 1);
    const std::vector<std::pair<std::string, std::string>> bad{
        {"what is this", "the information header has no end, expected an empty line"},
        {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n\x02\x31", "not an ambient file"},
        {"#?RADIANCE\nNCOMP=20\nFORMAT=Radiance_ambval\n\n\x02\x31", "other than three channels"},
        {good.substr(0, good.size() - 1), "truncated ambient file"},
        {version, "an ambient file of another version of Radiance"},
    };
    for (const auto& [bytes, message] : bad) {
        const std::string path = folder.write("bad.amb", bytes);
        CHECK_THROWS_WITH_AS(Run(path, options_of(1, 0.2)),
                             doctest::Contains((path + ": ").c_str()), InputError);
        CHECK_THROWS_WITH_AS(Run(path, options_of(1, 0.2)), doctest::Contains(message.c_str()),
                             InputError);
        CHECK(read_file(path) == bytes);
    }
}

}  // namespace
}  // namespace lightwalk::test
