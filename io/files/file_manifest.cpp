#include "io/files/file_manifest.h"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "io/files/digest.h"
#include "io/files/library_path.h"

namespace lightwalk {
namespace {

std::string absolute_path(const std::string& path) {
    std::error_code failed;
    const std::filesystem::path absolute = std::filesystem::absolute(path, failed);
    return failed ? path : absolute.lexically_normal().string();
}

/// Without its digest.
ManifestFile state_of_file(const std::string& path) {
    ManifestFile file{path};
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return file;
    constexpr std::int64_t kSecond = 1'000'000'000;  // [ns]
    file.exists = true;
    file.size = static_cast<std::uint64_t>(status.st_size);
    file.written = status.st_mtim.tv_sec * kSecond + status.st_mtim.tv_nsec;
    return file;
}

/// A phrase, or nothing.
std::optional<std::string> change_of(const ManifestFile& file) {
    const ManifestFile now = state_of_file(file.path);
    if (now.exists != file.exists) return file.path + (file.exists ? " is missing" : " is new");
    if (!file.exists || (now.size == file.size && now.written == file.written)) return {};
    if (now.size == file.size) {
        try {
            if (digest_of_bytes(read_file(file.path)) == file.digest) return {};
        } catch (const InputError&) {
            return file.path + " cannot be read";
        }
    }
    return file.path + " has changed";
}

}  // namespace

std::optional<std::string> ManifestRecorder::answer(Question question, const std::string& text,
                                                    std::size_t limit) {
    const bool reads = question == Question::bytes;
    if (!reads && question != Question::readable) return source_->answer(question, text, limit);
    // Before it is read: what is written meanwhile is a change.
    ManifestFile file = state_of_file(absolute_path(text));
    std::optional<std::string> found = source_->answer(question, text, limit);
    if (reads && found) file.digest = digest_of_bytes(*found);
    if (reads || !file.exists) files_.try_emplace(file.path, file);
    return found;
}

std::vector<ManifestFile> ManifestRecorder::files() const {
    std::vector<ManifestFile> files;
    for (const auto& [path, file] : files_) files.push_back(file);
    return files;
}

std::vector<ManifestFile> merged_manifest(std::span<const ManifestFile> base,
                                          std::span<const ManifestFile> added) {
    std::vector<ManifestFile> all;
    const auto by_path = [](const ManifestFile& a, const ManifestFile& b) {
        return a.path < b.path;
    };
    std::ranges::set_union(base, added, std::back_inserter(all), by_path);
    return all;
}

std::vector<std::string> changes_since(std::span<const ManifestFile> files) {
    std::vector<std::string> changes;
    for (const ManifestFile& file : files) {
        if (std::optional<std::string> change = change_of(file))
            changes.push_back(*std::move(change));
    }
    return changes;
}

}  // namespace lightwalk
