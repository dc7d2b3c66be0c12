#include "io/files/forget_pages.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>

using namespace lightwalk;

namespace {

constexpr std::size_t kMegabyte = std::size_t{1} << 20;

/// Memory of this process that is in use [bytes].
std::size_t resident_bytes() {
    std::ifstream file("/proc/self/statm");
    std::size_t total = 0;
    std::size_t resident = 0;
    file >> total >> resident;
    return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace

TEST_CASE("pages are forgotten only where they lie wholly within the bytes") {
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    std::string text(64 * page, 'x');
    const std::size_t begin = 3 * page + 17;
    const std::size_t size = 20 * page + 5;
    forget_pages(std::span(text.data() + begin, size));
    CHECK(std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(begin),
                      [](char c) { return c == 'x'; }));
    CHECK(std::all_of(text.begin() + static_cast<std::ptrdiff_t>(begin + size), text.end(),
                      [](char c) { return c == 'x'; }));
    forget_pages(std::span(text.data() + page, 10));  // no page at all
    forget_pages({});
    CHECK(text[page] == 'x');
    text.assign(text.size(), 'y');  // the memory is there as before
    CHECK(std::ranges::count(text, 'y') == static_cast<std::ptrdiff_t>(text.size()));
}

TEST_CASE("a fading text keeps what has not been read, and gives back the rest") {
    std::string text(64 * kMegabyte, 'x');
    const std::size_t before = resident_bytes();
    FadingText fading(text);
    bool kept = true;
    for (std::size_t at = 0; at <= text.size(); at += 100000) {
        fading.read_to(at);
        kept = kept && (at == text.size() || text[at] == 'x') && text.back() == 'x';
    }
    CHECK(kept);
    const bool measurable = before > text.size();  // sanitizers may hold memory back
    if (measurable) CHECK(resident_bytes() + 40 * kMegabyte < before);
}

TEST_CASE("a short text does not fade") {
    std::string text(kMegabyte, 'x');
    FadingText fading(text);
    fading.read_to(text.size());
    CHECK(std::ranges::count(text, 'x') == static_cast<std::ptrdiff_t>(text.size()));
}
