#include "core/cloud/error_histogram.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/math/random.h"

using namespace lightwalk;

TEST_CASE("error histogram: quantiles of any number of errors are told within two percent") {
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

TEST_CASE("error histogram: no errors, none to speak of, and enormous ones") {
    ErrorHistogram histogram;
    CHECK(histogram.quantile(0.5) == 0);
    histogram.add(std::vector<float>(10, 0.0f));
    CHECK(histogram.quantile(0.95) == 0);
    histogram.add(std::vector<float>(30, 1e30f));
    CHECK(histogram.quantile(0.5) == doctest::Approx(1e5).epsilon(0.02));
}
