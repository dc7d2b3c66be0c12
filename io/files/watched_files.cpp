#include "io/files/watched_files.h"

#include <algorithm>
#include <system_error>

namespace lightwalk {

std::optional<std::string> WatchedFiles::answer(Question question, const std::string& text,
                                                std::size_t limit) {
    // Before it is read: what is written meanwhile is a change.
    if (question == Question::bytes || question == Question::readable ||
        question == Question::beginning)
        files_.try_emplace(text, state_of(text));
    return source_->answer(question, text, limit);
}

bool WatchedFiles::have_changed() const {
    return std::any_of(files_.begin(), files_.end(),
                       [](const auto& file) { return state_of(file.first) != file.second; });
}

WatchedFiles::State WatchedFiles::state_of(const std::string& path) {
    State state;
    std::error_code failed;
    if (!std::filesystem::is_regular_file(path, failed)) return state;
    state.exists = true;
    state.written = std::filesystem::last_write_time(path, failed);
    state.size = std::filesystem::file_size(path, failed);
    return state;
}

}  // namespace lightwalk
