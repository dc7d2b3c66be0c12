#include "io/files/watched_files.h"

#include <algorithm>
#include <system_error>

namespace lightwalk {
namespace {

FileState state_of(const std::string& path) {
    FileState state;
    std::error_code failed;
    if (!std::filesystem::is_regular_file(path, failed)) return state;
    state.exists = true;
    state.written = std::filesystem::last_write_time(path, failed);
    state.size = std::filesystem::file_size(path, failed);
    return state;
}

}  // namespace

std::optional<std::string> WatchedFiles::answer(Question question, const std::string& text,
                                                std::size_t limit) {
    // Before it is read: what is written meanwhile is a change.
    if (question == Question::bytes || question == Question::readable ||
        question == Question::beginning) {
        const std::lock_guard lock(mutex_);
        if (!files_.contains(text)) files_.emplace(text, state_of(text));
    }
    return source_->answer(question, text, limit);
}

bool WatchedFiles::have_changed() const {
    const FileStates files = recorded();
    return std::any_of(files.begin(), files.end(),
                       [](const auto& file) { return state_of(file.first) != file.second; });
}

FileStates WatchedFiles::recorded() const {
    const std::lock_guard lock(mutex_);
    return files_;
}

/// The lock is not held while the file system answers, which may take its time.
FileStates WatchedFiles::now() const {
    FileStates states = recorded();
    for (auto& [path, state] : states) state = state_of(path);
    return states;
}

void WatchedFiles::record(const FileStates& others) {
    const std::lock_guard lock(mutex_);
    files_.insert(others.begin(), others.end());
}

}  // namespace lightwalk
