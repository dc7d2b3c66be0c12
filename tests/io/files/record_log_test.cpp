#include "io/files/record_log.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <vector>

#include "io/files/library_path.h"
#include "tests/temporary_folder.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

class KeptWarnings final : public WarningSink {
  public:
    void warn(const std::string& text) override { texts.push_back(text); }
    std::vector<std::string> texts;
};

const std::string kHeader = "scene 12\n-ps 1\n";

/// What the log holds, and what opening it warned of.
std::vector<std::string> records_of(const std::string& path, KeptWarnings& warnings) {
    std::vector<std::string> records;
    const RecordLog log(
        path, kHeader, [&](std::string_view record) { records.emplace_back(record); }, warnings);
    return records;
}

std::string three_records(const TemporaryFolder& folder) {
    const std::string path = folder.path("log");
    KeptWarnings warnings;
    RecordLog log(
        path, kHeader, [](std::string_view) {}, warnings);
    log.append("one");
    log.append("");
    log.append(std::string("\0three\n\n", 8));
    log.sync();
    return path;
}

}  // namespace

TEST_CASE("a record log gives back what was appended, and goes on") {
    const TemporaryFolder folder;
    const std::string path = three_records(folder);
    KeptWarnings warnings;
    CHECK(records_of(path, warnings) ==
          std::vector<std::string>{"one", "", std::string("\0three\n\n", 8)});
    {
        RecordLog log(
            path, kHeader, [](std::string_view) {}, warnings);
        log.append("four");
    }
    CHECK(records_of(path, warnings).size() == 4);
    CHECK(warnings.texts.empty());
}

TEST_CASE("a log cut off anywhere keeps its whole records, and can be appended to") {
    const TemporaryFolder folder;
    const std::string bytes = read_file(three_records(folder));
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        CAPTURE(size);
        const std::string path = folder.write("cut", bytes.substr(0, size));
        KeptWarnings warnings;
        const std::size_t left = records_of(path, warnings).size();
        CHECK(left < 3);
        {
            RecordLog log(
                path, kHeader, [](std::string_view) {}, warnings);
            log.append("new");
        }
        const std::vector<std::string> again = records_of(path, warnings);
        CHECK(again.size() == left + 1);
        CHECK(again.back() == "new");
        CHECK(warnings.texts.size() <= 1);
    }
}

TEST_CASE("damage within a log: the records before it are used, one warning says so") {
    const TemporaryFolder folder;
    const std::string bytes = read_file(three_records(folder));
    for (std::size_t at = bytes.find("LWRC"); at < bytes.size(); ++at) {
        CAPTURE(at);
        std::string damaged = bytes;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x40);
        KeptWarnings warnings;
        const std::string path = folder.write("damaged", damaged);
        CHECK(records_of(path, warnings).size() < 3);
        CHECK(warnings.texts.size() == 1);
    }
}

TEST_CASE("logs of other runs, of others' programs and in use are refused by name") {
    const TemporaryFolder folder;
    KeptWarnings warnings;
    const auto none = [](std::string_view) {};
    const std::string path = three_records(folder);
    CHECK_THROWS_WITH_AS(RecordLog(path, "scene 12\n-ps 2\n", none, warnings),
                         doctest::Contains((path + ":3: ").c_str()), InputError);
    CHECK_THROWS_WITH_AS(RecordLog(path, "scene 12\n", none, warnings),
                         doctest::Contains("another run"), InputError);
    const std::string foreign = folder.write("picture.hdr", "#?RADIANCE\n");
    CHECK_THROWS_WITH_AS(RecordLog(foreign, kHeader, none, warnings),
                         doctest::Contains("not a log"), InputError);
    CHECK(read_file(foreign) == "#?RADIANCE\n");
    const RecordLog open(path, kHeader, none, warnings);
    CHECK_THROWS_WITH_AS(RecordLog(path, kHeader, none, warnings),
                         doctest::Contains("another run is writing"), InputError);
    CHECK_THROWS_AS(RecordLog(folder.path("missing/log"), kHeader, none, warnings), InputError);
}
