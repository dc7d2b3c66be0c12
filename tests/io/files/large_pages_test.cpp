// Memory of long texts.
#include "io/files/large_pages.h"

#include <doctest/doctest.h>

#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>

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

TEST_CASE("a long text asks for large pages, all of it") {
    if (!are_given()) {
        MESSAGE("skipped: this system has no large pages for those who ask");
        return;
    }
    std::string text;
    text.reserve(std::size_t{40} << 20);  // more than malloc ever takes from its heap
    prefer_large_pages(text);
    CHECK(has_asked(text.data(), text.capacity()));
}

TEST_CASE("what is in a text stays when it asks for large pages") {
    std::string text(std::size_t{5} << 20, 'a');
    text.back() = 'z';
    prefer_large_pages(text);
    CHECK(text.find_first_not_of('a') == text.size() - 1);
}
