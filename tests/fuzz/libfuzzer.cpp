// Entry of the libFuzzer targets (-DLIGHTWALK_FUZZ=ON with clang): one program a target.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "tests/fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    (void)lightwalk::test::LIGHTWALK_FUZZ_TARGET({reinterpret_cast<const char*>(data), size});
    return 0;
}
