// Work that waits in the middle, on stacks of its own.
#include "parallel/fibers/context_fibers.h"

#include <doctest/doctest.h>

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/asan_interface.h>
#include <sys/mman.h>
#endif

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lightwalk {
namespace {

/// Goes down by some hundred bytes a step until the fiber says that there is no room.
std::size_t steps_down(const Fibers& fibers) {
    std::array<volatile char, 200> used{};
    used[0] = 1;
    return fibers.has_room() ? 1 + steps_down(fibers) + static_cast<std::size_t>(used[1]) : 0;
}

}  // namespace

TEST_CASE("fibers: work waits where it likes and goes on with what it had") {
    const auto made = make_context_fibers(3);
    Fibers& fibers = *made;
    std::string told;
    const auto work = [&] {
        const std::string own = told.empty() ? "a" : "b";
        for (int i = 1; i < 3; ++i) {
            told += own + std::to_string(i);
            fibers.wait();
        }
        told += own + "3";
    };
    REQUIRE(fibers.prepare(0));
    REQUIRE(fibers.prepare(2));
    CHECK_FALSE(fibers.start(0, work));
    CHECK_FALSE(fibers.start(2, work));
    CHECK_FALSE(fibers.resume(0));
    CHECK(fibers.resume(0));
    CHECK_FALSE(fibers.resume(2));
    CHECK(fibers.resume(2));
    CHECK(told == "a1b1a2a3b2b3");
}

TEST_CASE("fibers: one is used again and again, for work that waits or does not") {
    const auto made = make_context_fibers(1);
    Fibers& fibers = *made;
    REQUIRE(fibers.prepare(0));
    int sum = 0;
    for (int i = 0; i < 1000; ++i) {
        const auto add = [&] {
            if (i % 3 == 0) fibers.wait();
            sum += i;
        };
        if (!fibers.start(0, add)) CHECK(fibers.resume(0));
    }
    CHECK(sum == 999 * 500);
}

TEST_CASE("fibers: exceptions that stay within the work are no one else's") {
    const auto made = make_context_fibers(2);
    Fibers& fibers = *made;
    int caught = 0;
    const auto work = [&] {
        try {
            fibers.wait();
            throw 7;
        } catch (int thrown) {
            caught += thrown;
        }
    };
    for (const std::size_t i : {0, 1}) {
        REQUIRE(fibers.prepare(i));
        CHECK_FALSE(fibers.start(i, work));
    }
    for (const std::size_t i : {1, 0}) CHECK(fibers.resume(i));
    CHECK(caught == 14);
}

TEST_CASE("fibers: there is room for half of the stack") {
    const auto made = make_context_fibers(1);
    Fibers& fibers = *made;
    REQUIRE(fibers.prepare(0));
    std::size_t steps = 0;
    CHECK(fibers.start(0, [&] { steps = steps_down(fibers); }));
    CHECK(steps > 100);
    CHECK(steps < kFiberStackBytes / 2 / 200);
}

#if defined(__SANITIZE_ADDRESS__)
TEST_CASE("fibers: marks that an earlier stack left at their addresses are none of theirs") {
    for (int pages = 0; pages < 3; ++pages) {  // the next mapping takes the gap
        const std::size_t size = kFiberStackBytes + static_cast<std::size_t>(pages) * 4096;
        void* earlier =
            mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        REQUIRE(earlier != MAP_FAILED);
        ASAN_POISON_MEMORY_REGION(earlier, size);
        REQUIRE(munmap(earlier, size) == 0);
        const auto made = make_context_fibers(1);
        Fibers& fibers = *made;
        REQUIRE(fibers.prepare(0));
        std::size_t steps = 0;
        CHECK(fibers.start(0, [&] { steps = steps_down(fibers); }));
        CHECK(steps > 100);
    }
}

TEST_CASE("fibers: their own marks are gone with them") {
    constexpr std::uintptr_t kPage = 4096;  // stacks end with one
    auto made = make_context_fibers(1);
    REQUIRE(made->prepare(0));
    char* here = nullptr;
    CHECK(made->start(0, [&] { here = static_cast<char*>(__builtin_frame_address(0)); }));
    const std::size_t above = kPage - reinterpret_cast<std::uintptr_t>(here) % kPage;
    CHECK(__asan_region_is_poisoned(here, above) != nullptr);  // functions that it is still in
    made.reset();
    CHECK(__asan_region_is_poisoned(here, above) == nullptr);
}
#endif

}  // namespace lightwalk
