#include "io/contributions/contribution_outputs.h"

#include <doctest/doctest.h>

#include "io/options/option_words.h"

using namespace lightwalk;

TEST_CASE(
    "outputs: a file for each name that %s and %d make, in the order of modifiers, then bins") {
    const auto outputs = contribution_outputs({{"all_%d", "a", 2},
                                               {"", "b", 1},
                                               {"100%%_%s_%03d.dat", "c", 2},
                                               {"all_%d", "d", 1},
                                               {"", "e", 2}});
    REQUIRE(outputs.size() == 5);
    CHECK(outputs[0].file == "all_0");
    CHECK(outputs[0].columns == std::vector<std::size_t>{0, 5});
    CHECK(outputs[0].modifier.empty());
    CHECK(outputs[0].bin == 0);
    CHECK(outputs[1].file == "all_1");
    CHECK(outputs[1].columns == std::vector<std::size_t>{1});
    CHECK(outputs[2].file.empty());
    CHECK(outputs[2].columns == std::vector<std::size_t>{2, 6, 7});
    CHECK(!outputs[2].bin);
    CHECK(outputs[3].file == "100%_c_000.dat");
    CHECK(outputs[4].file == "100%_c_001.dat");
    CHECK(outputs[4].modifier == "c");
}

TEST_CASE("outputs: other conversions, or one of them twice, are refused") {
    for (const char* name : {"%s%s", "%d_%d", "%f", "%", "a%5s", "%999d", "!gzip > a"}) {
        CAPTURE(name);
        CHECK_THROWS_AS((void)contribution_outputs({{name, "m", 1}}), UsageError);
    }
}

TEST_CASE("records: what was written is read again") {
    const ContributionOutput output{"", {0, 2}, "", {}};
    const std::vector<double> sums{1, 2, 3, 9, 9, 9, .25, .5, 0};
    for (const NumberFormat format :
         {NumberFormat::text, NumberFormat::real32, NumberFormat::real64, NumberFormat::rgbe}) {
        const RecordFormat record{format, 0, 0};
        std::string bytes;
        record.append(output, sums, 2, bytes);
        if (record.record_size(2) > 0) CHECK(bytes.size() == record.record_size(2));
        std::vector<double> read(9);
        REQUIRE(record.add(output, bytes, read));
        for (std::size_t i = 0; i < 9; ++i) {
            CAPTURE(i);
            const bool written = i < 3 || i >= 6;
            CHECK(std::abs(read[i] - (written ? 2 * sums[i] : 0)) <= 6.0 / 256);
        }
    }
}
