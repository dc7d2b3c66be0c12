// Damaged input is refused, never crashes, hangs or eats memory: a seeded mutator over small sound
// inputs.
#include <doctest/doctest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "tests/fuzz/targets.h"

namespace lightwalk::test {
namespace {

#if defined(__SANITIZE_ADDRESS__)  // four times as slow; without it all are run, and their memory
                                   // is watched
constexpr int kMutants = 2000;
#else
constexpr int kMutants = 10000;
#endif
constexpr unsigned kHangSeconds = 5;
constexpr long kMaxMemory = 1 << 20;  // [KiB]

/// One to eight small injuries: bits, bytes, numbers, stretches removed, doubled or taken from
/// elsewhere.
std::string mutate(std::string bytes, std::mt19937& random) {
    static const char* const kWords[] = {"99999999999", "-1", "0",  "1e308", "nan", "\"", "{",
                                         "(",           "!",  "\n", "void",  "-a",  "^",  "$"};
    const auto below = [&](std::size_t n) { return n == 0 ? 0 : random() % n; };
    for (std::size_t injuries = 1 + below(8); injuries > 0 && !bytes.empty(); --injuries) {
        const std::size_t at = below(bytes.size());
        const std::size_t length = std::min(bytes.size() - at, 1 + below(16));
        switch (below(7)) {
            case 0:
                bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
                break;
            case 1:
                bytes[at] = static_cast<char>(below(256));
                break;
            case 2:
                bytes.erase(at, length);
                break;
            case 3:
                bytes.insert(at, bytes.substr(at, length));
                break;
            case 4:
                bytes.insert(at, bytes.substr(below(bytes.size()), length));
                break;
            case 5:
                bytes.replace(at, length, kWords[below(std::size(kWords))]);
                break;
            default:
                bytes.resize(at);
                break;
        }
    }
    return bytes;
}

/// One to eight small injuries that move nothing: bits, bytes, numbers, stretches from elsewhere.
std::string overwrite(std::string bytes, std::mt19937& random) {
    static const std::uint64_t kNumbers[] = {0,
                                             1,
                                             ~std::uint64_t{0},
                                             0x7fffffff80000000,
                                             0x7ff8000000000000,
                                             0x7ff0000000000000,
                                             0x3ff0000000000000,
                                             0xc340000000000000};
    const auto below = [&](std::size_t n) { return random() % n; };
    for (std::size_t injuries = 1 + below(8); injuries > 0; --injuries) {
        const std::size_t at = below(bytes.size() - 8);
        switch (below(4)) {
            case 0:
                bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
                break;
            case 1:
                bytes[at] = static_cast<char>(below(256));
                break;
            case 2:
                std::memcpy(&bytes[at / 4 * 4], &kNumbers[below(std::size(kNumbers))],
                            std::size_t{4} << below(2));
                break;
            default:
                std::memmove(&bytes[at / 4 * 4], &bytes[below(bytes.size() - 8) / 4 * 4], 8);
                break;
        }
    }
    return bytes;
}

[[maybe_unused]] long peak_memory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
}

void endure(const NamedTarget& target, std::string (*injure)(std::string, std::mt19937&) = mutate) {
    const auto seeds = seeds_of(target.run);
    for (const std::string& seed : seeds)
        CHECK_MESSAGE(target.run(seed), std::string(target.name) << ": a seed is refused");
    std::mt19937 random(20261121);
    int accepted = 0;
    double longest = 0;
    for (int i = 0; i < kMutants; ++i) {
        const std::string mutant =
            injure(seeds[static_cast<std::size_t>(i) % seeds.size()], random);
        alarm(4 * kHangSeconds);  // a hang ends the test program, which fails the test
        const auto start = std::chrono::steady_clock::now();
        accepted += target.run(mutant) ? 1 : 0;
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
        longest = std::max(longest, took.count());
    }
    alarm(0);
    MESSAGE(std::string(target.name) << ": " << accepted << " of " << kMutants
                                     << " mutants accepted, slowest " << longest << " s");
    CHECK(accepted < kMutants);
    CHECK(longest < kHangSeconds);
#if !defined(__SANITIZE_ADDRESS__)  // which keeps what is freed, of all cases of this file together
    CHECK(peak_memory() < kMaxMemory);
#endif
}

std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

// Called by read_corpus.py, with the folder.
TEST_CASE("the kept corpus of the fuzzer is read or refused") {
    const char* const folder = std::getenv("LIGHTWALK_FUZZ_CORPUS");
    if (folder == nullptr) return;
    for (const NamedTarget& target : kFuzzTargets) {
        CAPTURE(target.name);
        int files = 0;
        for (const auto& file :
             std::filesystem::directory_iterator(std::filesystem::path(folder) / target.name)) {
            CAPTURE(file.path().string());
            const std::string bytes = bytes_of(file);
            alarm(4 * kHangSeconds);
            CHECK_NOTHROW((void)target.run(bytes));
            ++files;
        }
        CHECK(files > 0);
    }
    alarm(0);
}

TEST_CASE("mutated scene files are read or refused") {
    endure(kFuzzTargets[0]);
}
TEST_CASE("mutated octrees are read or refused") {
    endure(kFuzzTargets[1]);
}
TEST_CASE("mutated function files are read or refused") {
    endure(kFuzzTargets[2]);
}
TEST_CASE("mutated pictures are read or refused") {
    endure(kFuzzTargets[3]);
}
TEST_CASE("mutated data files, fonts and meshes are read or refused") {
    endure(kFuzzTargets[4]);
}
TEST_CASE("mutated messages of browsers are read or refused") {
    endure(kFuzzTargets[5]);
}
TEST_CASE("mutated frozen scenes are read or refused") {
    endure(kFuzzTargets[6]);
}
TEST_CASE("mutated frozen scenes whose digests fit are read or refused") {
    endure(kFuzzTargets[7]);
    endure(kFuzzTargets[7], overwrite);
}
TEST_CASE("mutated files of BSDF data are read or refused") {
    endure(kFuzzTargets[8]);
}
TEST_CASE("mutated rad files are read or refused") {
    endure(kFuzzTargets[9]);
}
TEST_CASE("mutated photometric data and lamp tables are read or refused") {
    endure(kFuzzTargets[10]);
}
TEST_CASE("mutated object files and their materials are read or refused") {
    endure(kFuzzTargets[11]);
}
TEST_CASE("mutated glTF files are read or refused") {
    endure(kFuzzTargets[12]);
    endure(kFuzzTargets[12], overwrite);
}
TEST_CASE("mutated images are read or refused") {
    endure(kFuzzTargets[13]);
}
TEST_CASE("mutated files of layers are read or refused") {
    endure(kFuzzTargets[14]);
    endure(kFuzzTargets[14], overwrite);
}
TEST_CASE("mutated frames of a walk are read or refused") {
    endure(kFuzzTargets[15]);
    endure(kFuzzTargets[15], overwrite);
}

}  // namespace lightwalk::test
