// Lookups in ambient files that Radiance wrote, held to the values that it found in them.
#include <doctest/doctest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "core/ambient/ambient_cache.h"
#include "core/ambient/serial_cache.h"
#include "io/ambient/ambient_file.h"
#include "io/files/library_path.h"
#include "tests/shared_data.h"
#include "tests/test_scene.h"

namespace lightwalk::test {
namespace {

struct LookupRow {
    std::string file, result;
    int level = 0;
    double weight = 1, value = 0, weight_sum = 0;
    Vec3 point, normal;
};

std::vector<LookupRow> read_rows(const std::string& path) {
    std::vector<LookupRow> rows;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        std::istringstream in(line);
        LookupRow r;
        if (in >> r.file >> r.level >> r.weight >> r.point.x >> r.point.y >> r.point.z >>
            r.normal.x >> r.normal.y >> r.normal.z >> r.result >> r.value >> r.weight_sum)
            rows.push_back(r);
    }
    return rows;
}

}  // namespace

TEST_CASE("ambient files are read, written back byte by byte, and looked up as Radiance does") {
    LIGHTWALK_NEEDS_SHARED(folder, "spec/5-cases");
    TestScene scene(read_file(folder + "/c09-two-rooms.rad"));
    const AmbientLimits limits = ambient_limits({-1e-5, -1.00001, -1.00001}, 4.00002, 0.2, 64);
    const std::vector<LookupRow> rows = read_rows(folder + "/unit-lookup.tsv");
    REQUIRE(rows.size() > 600);
    for (const std::string name : {"A", "B"}) {
        CAPTURE(name);
        const std::string bytes = read_file(folder + "/unit-lookup-" + name + ".amb");
        const AmbientFile file = decode_ambient_file(bytes, "unit.amb");
        CHECK(file.damage.empty());
        CHECK(file.size == bytes.size());
        REQUIRE(file.records.size() > 50);
        std::string again;
        SerialCache cache(limits);
        for (const AmbientRecord& record : file.records) {
            again += encode_ambient_record(record);
            cache.insert(record);
        }
        CHECK(bytes.ends_with(again));
        int failed = 0, tested = 0;
        for (const LookupRow& row : rows) {
            if (row.file != name) continue;
            const auto leaks = [&](const Vec3& target) {
                const double far = length(target - row.point);
                return scene.scene.geometry()
                    .intersect({row.point, normalize(target - row.point), far})
                    .exists();
            };
            const AmbientSum sum =
                cache.lookup({row.point, row.normal, row.normal, row.level, row.weight}, leaks);
            const bool hit = sum.weight > kEpsilon;
            const double value = hit ? sum.sum[0] / sum.weight : 0;
            const bool good = hit == (row.result == "HIT") &&
                              std::abs(value - row.value) <= 1e-3 * row.value + 1e-7 &&
                              std::abs(sum.weight - row.weight_sum) <= 2e-3 * row.weight_sum + 1e-5;
            CAPTURE(row.point.x);
            CAPTURE(row.point.y);
            CAPTURE(row.point.z);
            CAPTURE(value);
            CAPTURE(row.value);
            CHECK(good);
            failed += good ? 0 : 1;
            ++tested;
        }
        MESSAGE(name << ": " << tested - failed << " of " << tested << " lookups agree");
    }
}

TEST_CASE("a damaged ambient file gives what is whole") {
    AmbientRecord record;
    record.normal = record.axis = 8;
    record.radius = {0.5f, 1};
    record.value = {1, 2, 3};
    const std::string head = encode_ambient_header({"lightwalk -ab 1"}),
                      body = encode_ambient_record(record);
    CHECK(body.size() == kAmbientRecordSize);
    const AmbientFile whole = decode_ambient_file(head + body + body, "x.amb");
    CHECK(whole.records.size() == 2);
    CHECK(whole.damage.empty());
    const AmbientFile torn = decode_ambient_file(head + body + body.substr(0, 30), "x.amb");
    CHECK(torn.records.size() == 1);
    CHECK(torn.damage == "the last record is incomplete");
    CHECK(torn.size == head.size() + body.size());
    const AmbientFile zeros = decode_ambient_file(head + body + std::string(67, '\0'), "x.amb");
    CHECK(zeros.records.size() == 1);
    CHECK(zeros.damage == "record 2 has a direction that is none");
    CHECK_THROWS_AS((void)decode_ambient_file(head.substr(0, head.size() - 1), "x.amb"),
                    InputError);
    CHECK_THROWS_AS((void)decode_ambient_file("#?RADIANCE\n\n\x02\x31", "x.amb"), InputError);
}

}  // namespace lightwalk::test
