#pragma once
// Detects files that have changed since they were read.
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "io/files/file_source.h"

namespace lightwalk {

/// A file as far as its date and size tell.
struct FileState {
    bool exists = false;
    std::filesystem::file_time_type written;
    std::uintmax_t size = 0;
    friend bool operator==(const FileState&, const FileState&) = default;
};
using FileStates = std::map<std::string, FileState>;  ///< by path

/// A decorator of a source that records the state of each file that it is asked for. Callable
/// from many threads, as far as the source is.
class WatchedFiles final : public FileSource {
  public:
    explicit WatchedFiles(std::shared_ptr<FileSource> source = real_files())
        : source_(std::move(source)) {}

    [[nodiscard]] std::optional<std::string> answer(Question question, const std::string& text,
                                                    std::size_t limit) override;

    /// Whether a recorded file has appeared, disappeared or been written since, by its date and
    /// size.
    [[nodiscard]] bool have_changed() const;

    /// As they were when they were asked for.
    [[nodiscard]] FileStates recorded() const;
    /// As they are now.
    [[nodiscard]] FileStates now() const;
    /// Record others as well, those that are not recorded yet.
    void record(const FileStates& others);

  private:
    std::shared_ptr<FileSource> source_;
    mutable std::mutex mutex_;
    FileStates files_;  ///< under the mutex
};

}  // namespace lightwalk
