#include "parallel/ranks/exchanging_cache.h"

#include <doctest/doctest.h>

#include "core/ambient/serial_cache.h"
#include "parallel/recording_cache.h"

using namespace lightwalk;

namespace {

AmbientRecord record_at(float x) {
    AmbientRecord record;
    record.position = {x, 0, 0};
    record.radius = {.1F, .1F};
    record.value = {1, 1, 1};
    return record;
}

}  // namespace

TEST_CASE("own values go out by the batch, others' come in and are not sent on") {
    SerialCache cache(ambient_limits({-1, -1, -1}, 10, .1, 64));
    std::vector<std::size_t> batches;
    ExchangingCache exchanging(
        cache, 3, [&](const AmbientValues& values) { batches.push_back(values.records.size()); });
    for (int i = 0; i < 7; ++i) exchanging.insert(record_at(static_cast<float>(i)));
    CHECK(batches == std::vector<std::size_t>{3, 3});
    CHECK(exchanging.unsent().records.size() == 1);
    CHECK(exchanging.unsent().records.empty());
    const std::vector<AmbientRecord> others{record_at(8), record_at(8.5F)};
    exchanging.take(others);
    CHECK(batches.size() == 2);
    CHECK(cache.size() == 9);
}

TEST_CASE("a recording cache tells what was stored until it was stopped") {
    SerialCache cache(ambient_limits({-1, -1, -1}, 10, .1, 64));
    RecordingCache recording(cache);
    recording.insert(record_at(1));
    recording.insert(record_at(2));
    CHECK(recording.stop().size() == 2);
    recording.insert(record_at(3));
    CHECK(recording.stop().empty());
    CHECK(cache.size() == 3);
}
