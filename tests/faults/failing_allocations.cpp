// Every allocation fails once: failing_allocations CASE [all]
//
// Commands run in this process, whose operator new fails at the first call, the second and so on:
// each time the command must end with a message and status 1 (or do its work all the same), leave
// no half-written file, and give back what it took. Each failure has a process of its own. Without
// "all" every allocation of the first hundreds fails, and of the others each of a stride. The case
// "planted" forgets memory when an allocation fails, which must be found.
#include <fcntl.h>
#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <new>
#include <sstream>
#include <string>
#include <vector>

#include "apps/commands.h"
#include "core/error.h"

namespace {

namespace fs = std::filesystem;

// What operator new sees of the test.
std::atomic<long> left_until_failure{-1};  // negative: none fails
std::atomic<long> allocations{0};
std::atomic<long> living{0};

void* allocate(std::size_t size, std::size_t alignment) {
    allocations.fetch_add(1, std::memory_order_relaxed);
    if (left_until_failure.load(std::memory_order_relaxed) >= 0 &&
        left_until_failure.fetch_sub(1, std::memory_order_relaxed) == 0)
        return nullptr;
    void* block = nullptr;
    if (posix_memalign(&block, alignment, size > 0 ? size : 1) != 0) return nullptr;
    living.fetch_add(1, std::memory_order_relaxed);
    return block;
}

void release(void* block) {
    if (block == nullptr) return;
    living.fetch_sub(1, std::memory_order_relaxed);
    // Who reads it all the same shall not find what was there, by luck.
    std::memset(block, 0x5a, malloc_usable_size(block));
    std::free(block);
}

constexpr std::size_t kAlignment = 16;

void* allocate_or_throw(std::size_t size, std::size_t alignment = kAlignment) {
    void* const block = allocate(size, alignment);
    if (block == nullptr) throw std::bad_alloc();
    return block;
}

}  // namespace

void* operator new(std::size_t size) {
    return allocate_or_throw(size);
}
void* operator new[](std::size_t size) {
    return allocate_or_throw(size);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    return allocate_or_throw(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
    return allocate_or_throw(size, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    return allocate(size, kAlignment);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
    return allocate(size, kAlignment);
}
void operator delete(void* block) noexcept {
    release(block);
}
void operator delete[](void* block) noexcept {
    release(block);
}
void operator delete(void* block, std::size_t) noexcept {
    release(block);
}
void operator delete[](void* block, std::size_t) noexcept {
    release(block);
}
void operator delete(void* block, std::align_val_t) noexcept {
    release(block);
}
void operator delete[](void* block, std::align_val_t) noexcept {
    release(block);
}
void operator delete(void* block, std::size_t, std::align_val_t) noexcept {
    release(block);
}
void operator delete[](void* block, std::size_t, std::align_val_t) noexcept {
    release(block);
}
void operator delete(void* block, const std::nothrow_t&) noexcept {
    release(block);
}
void operator delete[](void* block, const std::nothrow_t&) noexcept {
    release(block);
}

namespace lightwalk {
namespace {

constexpr const char* kScene =
    "void brightfunc stripes 2 .5+.4*sin(Px*9) lines.cal 0 0\n"
    "stripes plastic white 0 0 5 .7 .7 .7 .1 .1\n"
    "void light lamp 0 0 3 9 9 9\n"
    "white sphere ball 0 0 4 0 0 0 1\n"
    "white polygon floor 0 0 12 -3 -3 -1 3 -3 -1 3 3 -1 -3 3 -1\n"
    "lamp sphere bulb 0 0 4 3 -3 3 .3\n";

using Words = std::vector<std::string>;

Words render(const Words& more) {
    Words words{"render", "-vp", "0", "-5", "0", "-vd", "0", "1",
                "0",      "-x",  "6", "-y", "6", "-n",  "1", "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    words.emplace_back("scene.rad");
    return words;
}

const std::map<std::string, Words>& cases() {
    static const std::map<std::string, Words> all{
        {"picture", render({"-o", "out.hdr"})},
        {"ambient", render({"-ab", "1", "-ad", "16", "-as", "4", "-o", "out.hdr"})},
        {"series",
         {"animate", "--path", "path", "-x", "6", "-y", "6", "-n", "1", "--quiet", "-o",
          "out%d.hdr", "scene.rad"}},
        {"frozen", {"freeze", "-n", "1", "-o", "out.lwz", "scene.rad"}},
        {"rays", {"trace", "-n", "1", "-h", "scene.rad"}},
        {"coefficients", {"contrib", "-n", "1", "-h", "-o", "out.txt", "-m", "lamp", "scene.rad"}},
        {"planted", {}}};
    return all;
}

/// One that loses a block where the second allocation fails.
int run_planted() {
    int* const lost = new int[100];
    const std::unique_ptr<int[]> other(new int[100]);
    other[0] = lost[0] = 1;
    const int sum = other[0] + lost[0];
    delete[] lost;
    return sum - 2;
}

/// As main does it.
int run(const std::string& name) {
    try {
        if (name == "planted") return run_planted();
        const Words& words = cases().at(name);
        return find_command(words.front())->run({words.begin() + 1, words.end()}, nullptr);
    } catch (const std::bad_alloc&) {
        std::fputs("out of memory\n", stderr);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
    }
    return kFailureStatus;
}

std::string bytes_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

/// Files that the last run made, without the lines that say when.
std::map<std::string, std::string> made_files() {
    std::map<std::string, std::string> made;
    for (const fs::directory_entry& entry : fs::directory_iterator(".")) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with("out")) continue;
        std::string bytes = bytes_of(entry.path());
        for (const char* const date : {"\nCAPDATE= ", "\nGMT= "}) {
            const std::size_t at = bytes.find(date);
            if (at != std::string::npos) bytes.erase(at + 1, bytes.find('\n', at + 1) - at);
        }
        made.emplace(name, std::move(bytes));
    }
    return made;
}

void remove_made() {
    for (const auto& [name, bytes] : made_files()) fs::remove(name);
}

/// Standard input from the rays of the scene, output to a file, messages to another one.
void redirect() {
    const auto move = [](const char* file, int flags, int stream) {
        const int opened = open(file, flags, 0600);
        if (opened < 0 || dup2(opened, stream) < 0) _exit(99);
        close(opened);
    };
    move("rays", O_RDONLY, STDIN_FILENO);
    move("stdout", O_WRONLY | O_CREAT | O_TRUNC, STDOUT_FILENO);
    move("stderr", O_WRONLY | O_CREAT | O_TRUNC, STDERR_FILENO);
}

enum Verdict { whole = 0, refused = 1, lost = 3, silent = 4, half = 5, other = 6 };

/// In a process of its own: a run that shows what is there anyway once, then the one that counts.
[[noreturn]] void try_failure(const std::string& name, long index, long* count) {
    redirect();
    if (run(name) != kSuccessStatus) _exit(98);
    std::fflush(stdout);
    const std::map<std::string, std::string> expected = made_files();
    remove_made();
    redirect();
    const long before = living.load(), first = allocations.load();
    left_until_failure.store(index);
    const int status = run(name);
    left_until_failure.store(-1);
    *count = allocations.load() - first;
    const long kept = living.load() - before;
    std::fflush(nullptr);
    const auto made = made_files();
    if (status != kSuccessStatus && status != kFailureStatus) _exit(other);
    if (status == kFailureStatus && bytes_of("stderr").empty()) _exit(silent);
    if (status == kSuccessStatus && made != expected && bytes_of("stderr").empty()) _exit(half);
    for (const auto& [file, bytes] : made) {  // pictures before the one that failed stay
        const auto known = expected.find(file);
        const bool log = file == "out.txt.part";  // what contrib -r goes on from
        if (status == kFailureStatus && !log && (known == expected.end() || known->second != bytes))
            _exit(half);
    }
    // Embree keeps some of its own where it is refused more.
    const std::string messages = bytes_of("stderr");
    const bool embree = messages.find("Embree") != std::string::npos ||
                        messages.find("search tree") != std::string::npos;
    if (kept > 0 && !embree) _exit(lost);
    _exit(status);
}

std::string told(int how) {
    if (WIFSIGNALED(how)) return "killed by signal " + std::to_string(WTERMSIG(how));
    switch (WEXITSTATUS(how)) {
        case whole:
        case refused:
            return "";
        case lost:
            return "memory was lost";
        case silent:
            return "no message";
        case half:
            return "a half-written file, or another one without a word";
        default:
            return "exit status " + std::to_string(WEXITSTATUS(how));
    }
}

/// How the process ended, and how many allocations there were.
int failure_at(const std::string& name, long index, long* count) {
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child == 0) {
        alarm(100);  // a hang is a failure
        try_failure(name, index, count);
    }
    int how = 0;
    waitpid(child, &how, 0);
    remove_made();
    return how;
}

int check_case(const std::string& name, bool all, long* count) {
    constexpr long kNever = 1L << 40, kEach = 150, kTried = 600;
    const int how = failure_at(name, kNever, count);
    if (!told(how).empty()) {
        std::printf("%s: without failures: %s\n", name.c_str(), told(how).c_str());
        return 1;
    }
    const long total = *count;
    const long stride = all ? 1 : 1 + total / kTried;
    long tried = 0, faults = 0;
    for (long i = 0; i < total; i += i < kEach ? 1 : stride, ++tried) {
        const std::string fault = told(failure_at(name, i, count));
        if (fault.empty()) continue;
        ++faults;
        std::printf("%s: allocation %ld of %ld fails: %s; %s\n", name.c_str(), i, total,
                    fault.c_str(), bytes_of("stderr").substr(0, 200).c_str());
    }
    std::printf("%s: %ld allocations, of which %ld failed once, %ld of them badly\n", name.c_str(),
                total, tried, faults);
    const bool planted = name == "planted";
    return (faults > 0) != planted || tried < 2 ? 1 : 0;
}

}  // namespace
}  // namespace lightwalk

int main(int argc, char** argv) {
    using namespace lightwalk;
    const std::string name = argc > 1 ? argv[1] : "";
    if (!cases().contains(name)) {
        std::puts("usage: failing_allocations CASE [all]");
        return 2;
    }
    const fs::path start = fs::current_path();
    std::string folder = (fs::temp_directory_path() / "lightwalk-XXXXXX").string();
    if (mkdtemp(folder.data()) == nullptr) return 2;
    fs::current_path(folder);
    std::ofstream("scene.rad") << kScene;
    std::ofstream("lines.cal") << "lines = 1;\n";
    std::ofstream("path") << "VIEW= -vp 0 -5 0 -vd 0 1 0\nVIEW= -vp 0 -5 1\n";
    std::ofstream("rays") << "0 -5 0 0 1 0\n1 -5 0 0 1 0\n";
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    // What the forked process counts.
    long* const count = static_cast<long*>(
        mmap(nullptr, sizeof(long), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
    const int status = check_case(name, argc > 2, count);
    fs::current_path(start);
    fs::remove_all(folder);
    return status;
}
