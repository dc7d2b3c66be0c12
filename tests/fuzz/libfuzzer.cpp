// Entry of the fuzzer, by libFuzzer: LIGHTWALK_FUZZ_TARGET names what reads the bytes
// (kFuzzTargets). With LIGHTWALK_FUZZ_SEEDS it writes the target's seeds into that folder, and
// ends. See tests/fuzz.sh.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>

#include "tests/fuzz/targets.h"

namespace {

using lightwalk::test::kFuzzTargets;
using lightwalk::test::NamedTarget;

std::string_view word_of(const char* name) {
    const char* const word = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): one thread
    return word != nullptr ? word : "";
}

const NamedTarget& target() {
    static const NamedTarget& found = [&]() -> const NamedTarget& {
        const std::string_view name = word_of("LIGHTWALK_FUZZ_TARGET");
        const auto* const at = std::ranges::find(kFuzzTargets, name, &NamedTarget::name);
        if (at != std::ranges::end(kFuzzTargets)) return *at;
        std::fprintf(stderr, "LIGHTWALK_FUZZ_TARGET: expected one of");
        for (const NamedTarget& one : kFuzzTargets)
            std::fprintf(stderr, " %s", std::string(one.name).c_str());
        std::fprintf(stderr, "\n");
        std::exit(1);  // NOLINT(concurrency-mt-unsafe): one thread
    }();
    return found;
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* /*count*/, char*** /*words*/) {
    const std::string folder(word_of("LIGHTWALK_FUZZ_SEEDS"));
    const NamedTarget& named = target();
    if (folder.empty()) return 0;
    int number = 0;
    for (const std::string& seed : lightwalk::test::seeds_of(named.run))
        std::ofstream(folder + "/seed" + std::to_string(++number), std::ios::binary) << seed;
    std::exit(0);  // NOLINT(concurrency-mt-unsafe): one thread
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    (void)target().run({reinterpret_cast<const char*>(data), size});
    return 0;
}
