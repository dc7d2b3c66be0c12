#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#if defined(__SANITIZE_ADDRESS__)
/// OpenImageIO forgets messages of images that cannot be opened, a few bytes each.
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libOpenImageIO";
}
#endif
