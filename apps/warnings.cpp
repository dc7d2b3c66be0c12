#include "apps/warnings.h"

#include <cstdio>

namespace lightwalk {
namespace {

constexpr std::size_t kMostDistinct = 200;  ///< messages; the rest is only counted

}  // namespace

StderrWarnings::~StderrWarnings() {
    if (!enabled_) return;
    for (const auto& [message, count] : counts_) {
        if (count > 1)
            std::fprintf(stderr, "%s: warning - (%ld times) %s\n", program_.c_str(), count,
                         message.c_str());
    }
    if (suppressed_ > 0)
        std::fprintf(stderr, "%s: warning - %ld more warnings\n", program_.c_str(), suppressed_);
}

void StderrWarnings::warn(const std::string& text) {
    const std::string message = printable(text);
    const std::lock_guard lock(mutex_);
    if (!enabled_) return;
    const auto known = counts_.find(message);
    if (known != counts_.end()) {
        ++known->second;
    } else if (counts_.size() >= kMostDistinct) {
        ++suppressed_;
    } else {
        counts_.emplace(message, 1);
        std::fprintf(stderr, "%s%s: warning - %s\n", clear_line_ ? "\r\033[K" : "",
                     program_.c_str(), message.c_str());
    }
}

}  // namespace lightwalk
