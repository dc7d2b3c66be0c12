#include "apps/session/scene_premises.h"

#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <thread>

namespace lightwalk {
namespace {

constexpr std::int64_t kSecond = 1000000000;  // [ns]
constexpr std::int64_t kDateStep = 20000000;  ///< more than between two dates of a file system [ns]
constexpr std::size_t kLongestAnswer = 1 << 20;  ///< bytes

std::int64_t nanoseconds(const timespec& time) {
    return time.tv_sec * kSecond + time.tv_nsec;
}

}  // namespace

ScenePremises::FileIdentity ScenePremises::identity_of(const std::string& path) {
    struct stat state {};
    if (stat(path.c_str(), &state) != 0) return {};
    return {static_cast<std::int64_t>(state.st_dev), static_cast<std::int64_t>(state.st_ino),
            static_cast<std::int64_t>(state.st_size), nanoseconds(state.st_mtim),
            nanoseconds(state.st_ctim)};
}

/// A file that is written twice within a step of the clock keeps its date: of one that was written
/// just now, it is not the last word.
ScenePremises::FileIdentity ScenePremises::settled_identity(const std::string& path) {
    FileIdentity identity = identity_of(path);
    timespec now{};
    (void)clock_gettime(CLOCK_REALTIME, &now);
    const std::int64_t age = nanoseconds(now) - identity.back();
    if (age < 0 || age > kDateStep) return identity;
    std::this_thread::sleep_for(std::chrono::nanoseconds(kDateStep));
    return identity_of(path);
}

std::optional<std::string> ScenePremises::answer(Question question, const std::string& text,
                                                 std::size_t limit) {
    switch (question) {
        case Question::bytes:
        case Question::readable:
        case Question::beginning:
            // Before it is read: what is written meanwhile is a change.
            if (!files_.contains(text)) files_.emplace(text, settled_identity(text));
            if (text == "-") can_hold_ = false;
            return source_->answer(question, text, limit);
        case Question::input:
        case Question::input_state:
        case Question::script:
            can_hold_ = false;
            return source_->answer(question, text, limit);
        case Question::matches:
        case Question::place:
            break;
    }
    std::optional<std::string> said = source_->answer(question, text, limit);
    if (said && said->size() > kLongestAnswer) can_hold_ = false;
    answers_.try_emplace({question, text}, said);
    return said;
}

bool ScenePremises::files_hold() const {
    return std::ranges::all_of(
        files_, [](const auto& file) { return identity_of(file.first) == file.second; });
}

bool ScenePremises::answers_hold() const {
    return std::ranges::all_of(answers_, [&](const auto& known) {
        return source_->answer(known.first.first, known.first.second, kLargestFile) == known.second;
    });
}

}  // namespace lightwalk
