#include "parallel/ranks/ambient_sender.h"

#include <doctest/doctest.h>

#include <vector>

#include "tests/parallel/ambient_values.h"

using namespace lightwalk;
using lightwalk::test::record_at;

TEST_CASE("new ambient values go out by the batch, and what makes no batch is handed over") {
    std::vector<std::size_t> batches;
    AmbientSender sender(
        3, [&](const std::vector<AmbientRecord>& values) { batches.push_back(values.size()); });
    for (int i = 0; i < 7; ++i) sender.stored(record_at(static_cast<float>(i)));
    CHECK(batches == std::vector<std::size_t>{3, 3});
    const std::vector<AmbientRecord> rest = sender.unsent();
    REQUIRE(rest.size() == 1);
    CHECK(rest[0].position[0] == 6);
    CHECK(sender.unsent().empty());
}
