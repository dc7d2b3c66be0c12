// Memory of long arrays.
#include "core/model/large_pages.h"

#include <doctest/doctest.h>

#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>

#include "core/model/column.h"

using namespace lightwalk;

namespace {

/// Whether the system gives large pages to who asks for them.
bool are_given() {
    std::ifstream setting("/sys/kernel/mm/transparent_hugepage/enabled");
    std::string text;
    std::getline(setting, text);
    return text.find("[madvise]") != std::string::npos;
}

/// Whether the mapping that holds all of these bytes has asked for large pages.
bool has_asked(const void* begin, std::size_t size) {
    const auto first = reinterpret_cast<std::uintptr_t>(begin);
    std::ifstream maps("/proc/self/smaps");
    bool inside = false;
    for (std::string line; std::getline(maps, line);) {
        std::uintptr_t from = 0, to = 0;
        char dash = 0;
        std::istringstream words(line);
        if (words >> std::hex >> from >> dash >> to && dash == '-')
            inside = from <= first && first + size <= to;
        else if (inside && line.starts_with("VmFlags:"))
            return line.find(" hg") != std::string::npos;
    }
    return false;
}

}  // namespace

TEST_CASE("a long column asks for large pages, as one mapping, however it came to its length") {
    if (!are_given()) {
        MESSAGE("skipped: this system has no large pages for those who ask");
        return;
    }
    Column<double> grown;
    for (int i = 0; i < 3000000; ++i) grown.push_back(i);
    CHECK(has_asked(grown.data(), grown.own_bytes()));
    grown.trim();
    CHECK(has_asked(grown.data(), grown.own_bytes()));
    Column<double> zeros;
    (void)zeros.zeros(2000000);
    CHECK(has_asked(zeros.data(), zeros.own_bytes()));
}

TEST_CASE("what is in an array stays when it asks for large pages") {
    std::string text(std::size_t{5} << 20, 'a');
    text.back() = 'z';
    prefer_large_pages(text.data());
    CHECK(text.find_first_not_of('a') == text.size() - 1);
}
