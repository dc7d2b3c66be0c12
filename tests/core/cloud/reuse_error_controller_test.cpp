#include "core/cloud/reuse_error_controller.h"

#include <doctest/doctest.h>

#include <vector>

using namespace lightwalk;

namespace {

/// As many values, of which this share is off.
std::vector<float> values(std::size_t count, double off) {
    std::vector<float> all(count, 0.01f);
    for (std::size_t i = 0; i < static_cast<std::size_t>(off * static_cast<double>(count)); ++i)
        all[i] = 0.5f;
    return all;
}

/// Frames whose audits find these shares of reused pixels, and of pairs of rays, off.
void tell(ReuseErrorController& controller, double errors, double floors, int frames) {
    for (int i = 0; i < frames; ++i) controller.record(values(1024, errors), values(256, floors));
}

}  // namespace

TEST_CASE("reuse error: quantiles are values that the share lies below") {
    CHECK(quantile({}, 0.5) == 0);
    CHECK(quantile({3, 1, 2}, 0.5) == 2);
    CHECK(quantile({3, 1, 2}, 1) == 3);
    CHECK(quantile({3, 1, 2}, 0) == 1);
}

TEST_CASE("reuse error: errors beyond the limit tighten reuse until it holds, then it loosens") {
    ReuseErrorController controller(0.05);
    tell(controller, 0.2, 0, 1);
    CHECK(controller.tightness() == 0.5);
    tell(controller, 0.2, 0, 1);
    CHECK(controller.tightness() == 0.25);
    tell(controller, 0.04, 0, 3);  // neither wrong nor so right that it could be looser
    CHECK(controller.tightness() == 0.25);
    tell(controller, 0.01, 0, 1);
    CHECK(controller.tightness() == doctest::Approx(0.275));
    tell(controller, 0.01, 0, 100);
    CHECK(controller.tightness() == 1);
    tell(controller, 1, 0, 100);
    CHECK(controller.tightness() == 1.0 / 1024);
}

TEST_CASE(
    "reuse error: what two rays of a pixel differ by is no error, nor is what may be chance") {
    ReuseErrorController controller(0.05);
    tell(controller, 0.3, 0.3, 10);
    CHECK(controller.tightness() == 1);
    tell(controller, 0.3, 0.22, 10);  // 8 % beyond, give or take 6 %
    CHECK(controller.tightness() == 1);
    tell(controller, 0.3, 0.1, 1);
    CHECK(controller.tightness() == 0.5);
}

TEST_CASE("reuse error: few pixels decide nothing, and no limit never tightens") {
    ReuseErrorController controller(0.05);
    controller.record(values(1023, 1), values(256, 0));
    CHECK(controller.tightness() == 1);
    controller.record(values(1, 1), {});
    CHECK(controller.tightness() == 0.5);
    ReuseErrorController without(0);
    tell(without, 1, 0, 10);
    CHECK(without.tightness() == 1);
}

TEST_CASE("reuse error: tightened rules admit less of everything") {
    const ReuseRules rules;
    CHECK(tightened(rules, 1).near == doctest::Approx(rules.near));
    CHECK(tightened(rules, 1).reach == doctest::Approx(rules.reach));
    const ReuseRules tight = tightened(rules, 0.25);
    CHECK(tight.near == doctest::Approx(rules.near / 2));
    CHECK(tight.reach < rules.reach);
    CHECK(tight.reach >= tight.near);
    CHECK(tight.contrast == doctest::Approx(rules.contrast / 4));
    CHECK(tight.tightness == 0.25);
}
