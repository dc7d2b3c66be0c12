#include "apps/session/walk_report.h"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

using namespace lightwalk;

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
