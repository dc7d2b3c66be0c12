#include <doctest/doctest.h>

#include <chrono>
#include <fstream>
#include <string>
#include <thread>

#include "tests/apps/program.h"

namespace lightwalk::test {
namespace {

/// Whether the kernel gives large pages to those who ask for them.
[[maybe_unused]] bool has_large_pages() {
    std::ifstream file("/sys/kernel/mm/transparent_hugepage/enabled");
    std::string line;
    return std::getline(file, line) && line.find("[never]") == std::string::npos;
}

/// Whether part of a process's heap asks for them.
[[maybe_unused]] bool asks_for_large_pages(int process) {
    std::ifstream file("/proc/" + std::to_string(process) + "/smaps");
    bool in_heap = false;
    for (std::string line; std::getline(file, line);) {
        if (line.find(':') >= line.find(' '))  // the first line of a mapping
            in_heap = line.ends_with("[heap]");
        else if (in_heap && line.starts_with("VmFlags:") && (line + " ").find(" hg ") < line.size())
            return true;
    }
    return false;
}

}  // namespace

TEST_CASE("the program's heap asks for large pages") {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    MESSAGE("not asked: the sanitizer has an allocator of its own");
#else
    if (!has_large_pages()) {
        MESSAGE("not asked: this kernel has none");
        return;
    }
    const RunningProgram program({"info"});  // waits for a scene
    bool asks = false;
    for (int i = 0; i < 100 && !asks; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        asks = asks_for_large_pages(program.process());
    }
    CHECK(asks);
#endif
}

}  // namespace lightwalk::test
