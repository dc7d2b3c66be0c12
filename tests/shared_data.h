#pragma once
// Access to reference data, which is not part of the project: developers and CI have it beside it.
#include <doctest/doctest.h>

#include <filesystem>
#include <string>

namespace lightwalk::test {

/// Path below the shared folder, or "" when the folder is absent.
inline std::string shared_path(const std::string& relative) {
    const std::filesystem::path path = std::filesystem::path(LIGHTWALK_SHARED) / relative;
    return std::filesystem::exists(path) ? path.string() : std::string();
}

}  // namespace lightwalk::test

/// First statement of a test that needs reference data: sets `path`, or says that it skips and
/// returns.
#define LIGHTWALK_NEEDS_SHARED(path, relative)                               \
    const std::string path = ::lightwalk::test::shared_path(relative);       \
    if (path.empty()) {                                                      \
        MESSAGE("skipped: reference data " << (relative) << " is not here"); \
        return;                                                              \
    }
