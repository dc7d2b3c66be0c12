#pragma once
// Pictures of a room by ranks: command lines, divisions, and what is looked at of their results.
#include <doctest/doctest.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/apps/program.h"

namespace lightwalk::test::rank_runs {

inline const std::string kRoom = R"(
void plastic floor 0 0 5 .5 .4 .3 .1 .1
void glass pane 0 0 3 .9 .9 .9
void light lamp 0 0 3 20 20 20
floor polygon ground 0 0 12  -9 -9 0  9 -9 0  9 9 0  -9 9 0
floor sphere ball 0 0 4 0 0 1 1
pane polygon window 0 0 12  -2 -3 0  2 -3 0  2 -3 3  -2 -3 3
lamp polygon panel 0 0 12  -1 -1 5  -1 1 5  1 1 5  1 -1 5
)";

/// The command line of a small picture of the room.
inline std::vector<std::string> line(const std::vector<std::string>& more) {
    std::vector<std::string> words{"render", "-vp", "0",  "-6", "2",   "-vd", "0",   "1", "-.2",
                                   "-x",     "90",  "-y", "60", "-vh", "45",  "-vv", "31"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

/// Without the header, which has the time of creation.
inline std::string pixel_bytes(const std::string& picture) {
    const std::size_t begin = picture.find("\n\n");
    return begin == std::string::npos ? std::string() : picture.substr(begin);
}

inline bool have_mpi() {
    if (mpirun(1)) return true;
    MESSAGE("skipped: no mpirun here");
    return false;
}

/// How a run is divided.
struct Split {
    int ranks = 1;
    std::vector<std::string> options, mpi;
};
// Under AddressSanitizer it is to start that takes a rank its time; few ranks run the same code.
#if defined(__SANITIZE_ADDRESS__)
inline constexpr int kMany = 4, kMore = 5;
inline constexpr bool kEachWithAllOptions = false;
#else
inline constexpr int kMany = 9, kMore = 16;
inline constexpr bool kEachWithAllOptions = true;
#endif
inline const std::vector<Split> kSplits{
    {3, {"--variant", "ranks"}, {}},
    {4, {"--variant", "ranks", "--stride", "1"}, {"--mca", "btl", "self,tcp"}},
    {kMany, {"--variant", "ranks", "--block", "16"}, {}},
    {kMore, {"--variant", "ranks", "--masters", "3"}, {}},
    {1, {"-n", "2"}, {}},
    {2, {"--variant", "hybrid", "-n", "1"}, {}},
    {2, {"-n", "2"}, {}},
    {4, {"-n", "2", "--masters", "2"}, {}}};
/// Of a run in rounds, each of which all ranks end together.
#if defined(__SANITIZE_ADDRESS__)
inline const std::vector<Split> kRoundSplits{kSplits[3], kSplits[5]};
#else
inline const std::vector<Split>& kRoundSplits = kSplits;
#endif

// So long that a run can be killed before it ends: under AddressSanitizer a quarter of the pixels
// takes longer than all of them elsewhere.
#if defined(__SANITIZE_ADDRESS__)
inline const std::vector<std::string> kLongRun{"-x", "450", "-y", "300", "-ps", "1"};
inline const std::string kLitWidth = "300", kLitHeight = "225";
#else
inline const std::vector<std::string> kLongRun{"-x", "900", "-y", "600", "-ps", "1"};
inline const std::string kLitWidth = "600", kLitHeight = "450";
#endif

// Indirect light in rounds.
inline const std::vector<std::string> kRoundsRun{"-ps",
                                                 "1",
                                                 "-ab",
                                                 "2",
                                                 "-ad",
                                                 "32",
                                                 "-as",
                                                 "0",
                                                 "-aa",
                                                 ".3",
                                                 "-ar",
                                                 "16",
                                                 "-av",
                                                 ".01",
                                                 ".01",
                                                 ".01",
                                                 "--deterministic"};

/// Whether it comes true within a minute.
inline bool comes_true(const std::function<bool()>& condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!condition()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
}

/// Processes that run the program with this word on their command lines, but for those that start
/// others.
inline std::vector<int> ranks_with(const std::string& word) {
    std::vector<int> found;
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
        const std::string name = entry.path().filename().string();
        if (name.find_first_not_of("0123456789") != std::string::npos) continue;
        const std::string words = read_whole(entry.path() / "cmdline");
        if (words.starts_with(LIGHTWALK_PROGRAM) && words.find(word) != std::string::npos &&
            words.find("launch") == std::string::npos)
            found.push_back(std::stoi(name));
    }
    return found;
}

/// Whether there is more in a checkpoint than what it begins with.
/// @param least  bytes
inline bool holds_blocks(const std::string& checkpoint, std::uintmax_t least = 4000) {
    std::error_code none;
    const std::uintmax_t size = std::filesystem::file_size(checkpoint, none);
    return !none && size > least;
}

/// What a run that goes on says, but for the line that its checkpoint ends in the midst of a
/// record: so it does where a run was killed while it wrote one.
inline std::string beside_cut(const std::string& said) {
    std::istringstream lines(said);
    std::string others;
    for (std::string line; std::getline(lines, line);)
        if (line.find(" bytes are damaged and cut off") == std::string::npos) others += line + '\n';
    return others;
}

inline std::vector<std::string> with(std::vector<std::string> words,
                                     const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

}  // namespace lightwalk::test::rank_runs
