#include "parallel/walk/uncached_pixel_tracer.h"

#include <doctest/doctest.h>

#include <thread>
#include <vector>

using namespace lightwalk;

namespace {

/// Sees nothing, slowly.
class SlowCaster final : public PixelCaster {
  public:
    explicit SlowCaster(std::chrono::microseconds patience) : patience_(patience) {}
    void probe(std::span<const PixelPlace>, const ProbeOptions&, std::span<PixelVisibility>,
               int) override {}
    void trace(std::span<const PixelPlace>, std::span<TracedPixel> pixels, int, int) override {
        std::this_thread::sleep_for(patience_);
        std::fill(pixels.begin(), pixels.end(), TracedPixel{});
    }

  private:
    std::chrono::microseconds patience_;
};

/// Pixels that are traced of many, and whether each is told in its place.
std::size_t traced(PixelCaster& caster, UncachedPixelTracer::Clock::time_point deadline,
                   bool at_once) {
    const UncachedPixelTracer tracer(caster, 0.1, deadline);
    std::size_t count = 0;
    tracer.trace_part(std::vector<PixelPlace>(2000), 0, 0, at_once,
                      [&](std::size_t first, std::span<const TracedPixelResult> results) {
                          CHECK(first == count);
                          count += results.size();
                      });
    return count;
}

}  // namespace

TEST_CASE("a part of the uncached pixels is traced until the deadline, some of it at once") {
    using Clock = UncachedPixelTracer::Clock;
    SlowCaster quick(std::chrono::microseconds{0});
    CHECK(traced(quick, Clock::time_point::max(), false) == 2000);
    CHECK(traced(quick, Clock::now(), false) == 0);
    const std::size_t least = traced(quick, Clock::now(), true);
    CHECK(least > 0);
    CHECK(least <= 64);
    SlowCaster slow(std::chrono::milliseconds{4});  // 250 ms for all
    const std::size_t some = traced(slow, Clock::now() + std::chrono::milliseconds{30}, true);
    CHECK(some > 0);
    CHECK(some < 1000);
}

TEST_CASE("walk: the less comes into view the more of a frame's time is for checking points") {
    const auto share = [](double unknown) {
        constexpr double kBudget = 1000;  // [s]: what this test takes counts for nothing
        const std::chrono::duration<double> left =
            checking_deadline({}, kBudget, unknown) - UncachedPixelTracer::Clock::now();
        return left.count() / kBudget;
    };
    CHECK(share(0) == doctest::Approx(0.4).epsilon(0.01));
    CHECK(share(0.15) == doctest::Approx(0.325).epsilon(0.01));
    CHECK(share(0.3) == doctest::Approx(0.25).epsilon(0.01));
    CHECK(share(1) == doctest::Approx(0.25).epsilon(0.01));
    CHECK(checking_deadline({}, 0, 0) == UncachedPixelTracer::Clock::time_point::max());
}
