#include "apps/session/walk_report.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/math/random.h"

using namespace lightwalk;

TEST_CASE("walk report: quantiles of any number of errors are told within two percent") {
    RandomStream random = RandomStream::of_pixel(1, 2, 3, 4);
    std::vector<float> values(20000);
    for (float& value : values)
        value = static_cast<float>(std::pow(10.0, 6 * random.next() - 4));  // 0.0001 ... 100
    ErrorHistogram histogram;
    histogram.add(std::span(values).first(5000));
    histogram.add(std::span(values).subspan(5000));
    std::sort(values.begin(), values.end());
    CHECK(histogram.count() == values.size());
    for (const double share : {0.01, 0.5, 0.95, 0.999}) {
        const auto at = static_cast<std::size_t>(share * 20000);
        CHECK(histogram.quantile(share) ==
              doctest::Approx(static_cast<double>(values[at])).epsilon(0.02));
    }
}

TEST_CASE("walk report: no errors, none to speak of, and enormous ones") {
    ErrorHistogram histogram;
    CHECK(histogram.quantile(0.5) == 0);
    histogram.add(std::vector<float>(10, 0.0f));
    CHECK(histogram.quantile(0.95) == 0);
    histogram.add(std::vector<float>(30, 1e30f));
    CHECK(histogram.quantile(0.5) == doctest::Approx(1e5).epsilon(0.02));
}

TEST_CASE("walk report: the first frame reuses nothing, and does not count in the mean") {
    WalkReport report;
    CHECK(report.empty());
    CloudReport frame;
    frame.pixels = 100;
    report.add(frame);
    frame.reused = 90;
    frame.audit_errors = {0.1f, 0.1f, 0.1f};
    frame.audit_floors = {0.2f};
    report.add(frame);
    const nlohmann::ordered_json json = report.json();
    CHECK(json["reused"] == doctest::Approx(0.9));
    CHECK(json["frames"].size() == 2);
    CHECK_FALSE(json["frames"][0].contains("audit"));
    CHECK(json["frames"][1]["audit"]["pixels"] == 3);
    CHECK(json["audit"]["median_error"].get<double>() == doctest::Approx(0.1).epsilon(0.02));
    CHECK(json["audit"]["median_floor"].get<double>() == doctest::Approx(0.2).epsilon(0.02));
}
