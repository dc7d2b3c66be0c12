#include "io/files/file_source.h"

#include <array>
#include <cstdio>
#include <cstring>
#include <utility>

#include "core/error.h"
#include "io/files/digest.h"
#include "io/files/library_path.h"

namespace lightwalk {
namespace {

/// As hexadecimal digits.
std::string digits_of(std::uint64_t digest) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(digest));
    return text.data();
}

/// @param kind  of bytes: equal ones of different kinds have different digests
std::string digest_of(std::string_view bytes, char kind) {
    return digits_of(digest_of_bytes(bytes, static_cast<unsigned char>(kind)));
}

void append_text(std::string& out, std::string_view text) {
    const std::uint64_t size = text.size();
    out.append(reinterpret_cast<const char*>(&size), sizeof size);
    out += text;
}

std::string_view take_text(std::string_view& from) {
    std::uint64_t size = 0;
    if (from.size() < sizeof size) throw InputError("a recording of files is truncated");
    std::memcpy(&size, from.data(), sizeof size);
    from.remove_prefix(sizeof size);
    if (size > from.size()) throw InputError("a recording of files is truncated");
    const std::string_view text = from.substr(0, size);
    from.remove_prefix(size);
    return text;
}

std::string key_of(FileSource::Question question, const std::string& text) {
    return static_cast<char>(question) + text;
}

std::optional<std::string> answer_of(const std::string& recorded) {
    if (recorded.front() == 'x') throw InputError(recorded.substr(1));
    if (recorded.front() == '0') return std::nullopt;
    return recorded.substr(1);
}

}  // namespace

bool FileSource::keep(const std::string& path, std::string bytes) {
    const auto [at, is_new] = kept_.try_emplace(path);
    const bool same = is_new || at->second == bytes;
    at->second = std::move(bytes);
    return same;
}

bool FileSource::readable(const std::string& path) {
    return keeps(path) || answer(Question::readable, path, 0).has_value();
}

std::string FileSource::read(const std::string& path, std::size_t limit) {
    if (const auto kept = kept_.find(path); kept != kept_.end()) {
        if (kept->second.size() > limit)
            throw InputError({path, 0}, "larger than " + std::to_string(limit) + " bytes");
        return kept->second;
    }
    return answer(Question::bytes, path, limit).value_or("");
}

std::string FileSource::standard_input() {
    return answer(Question::input, "standard input", kLargestFile).value_or("");
}

std::vector<std::string> FileSource::matches(const std::string& pattern) {
    const std::string all = answer(Question::matches, pattern, kLargestFile).value_or("");
    std::vector<std::string> paths;
    for (std::size_t begin = 0; begin < all.size();) {
        const std::size_t end = all.find('\0', begin);
        paths.push_back(all.substr(begin, end - begin));
        begin = end + 1;
    }
    return paths;
}

std::optional<std::string> FileSource::place(const std::string& name) {
    return answer(Question::place, name, 0);
}

/// @param kind  '1' of contents, '0' where there is no file, 'x' of an error's message
void FileRecorder::note(Question question, const std::string& text, char kind,
                        std::string_view said) {
    const bool is_content =
        question == Question::bytes || question == Question::input || question == Question::script;
    if (!is_content || !digested_.emplace(key_of(question, text), true).second) return;
    const bool is_file = question == Question::bytes;
    const std::string name = is_file ? text.substr(text.rfind('/') + 1) : printable(text);
    digests_.push_back(name.substr(0, name.find('\n')) + ' ' + digest_of(said, kind));
}

void FileRecorder::note_mapped(const std::string& path, std::uint64_t digest) {
    digests_.push_back(path.substr(path.rfind('/') + 1) + ' ' + digits_of(digest));
}

std::optional<std::string> FileRecorder::ask(Question question, const std::string& text,
                                             std::size_t limit) {
    try {
        std::optional<std::string> found = source_->answer(question, text, limit);
        note(question, text, found ? '1' : '0', found ? std::string_view(*found) : "");
        return found;
    } catch (const InputError& error) {
        note(question, text, 'x', error.what());
        throw;
    }
}

std::optional<std::string> FileRecorder::answer(Question question, const std::string& text,
                                                std::size_t limit) {
    if (!keep_) return ask(question, text, limit);
    std::string key = key_of(question, text);
    if (const auto known = answers_.find(key); known != answers_.end())
        return answer_of(known->second);
    std::string said;
    try {
        const std::optional<std::string> found = ask(question, text, limit);
        said = found ? '1' + *found : std::string("0");
    } catch (const InputError& error) {
        said = std::string("x") + error.what();
    }
    return answer_of(answers_.emplace(std::move(key), std::move(said)).first->second);
}

std::string FileRecorder::digest() const {
    std::string all;
    for (const std::string& line : digests_) all += line + '\n';
    return digest_of(all, '1');
}

std::string FileRecorder::take() {
    std::string recording;
    for (const auto& [question, said] : std::exchange(answers_, {})) {
        append_text(recording, question);
        append_text(recording, said);
    }
    return recording;
}

FileReplay::FileReplay(std::string_view recording) {
    while (!recording.empty()) {
        const std::string_view question = take_text(recording);
        const std::string_view said = take_text(recording);
        if (question.empty() || said.empty() || std::strchr("01x", said.front()) == nullptr)
            throw InputError("not a recording of files");
        answers_.emplace(question, said);
    }
}

std::optional<std::string> FileReplay::answer(Question question, const std::string& text,
                                              std::size_t /*limit*/) {
    const auto found = answers_.find(key_of(question, text));
    if (found == answers_.end())
        throw InputError({text, 0}, "not among the files that rank 0 has read");
    return answer_of(found->second);
}

}  // namespace lightwalk
