#pragma once
// Detects files that have changed since they were read.
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "io/files/file_source.h"

namespace lightwalk {

/// A decorator of a source that records the state of each file that it is asked for.
class WatchedFiles final : public FileSource {
  public:
    explicit WatchedFiles(std::shared_ptr<FileSource> source = real_files())
        : source_(std::move(source)) {}

    [[nodiscard]] std::optional<std::string> answer(Question question, const std::string& text,
                                                    std::size_t limit) override;

    /// Whether a recorded file has appeared, disappeared or been written since, by its date and
    /// size.
    [[nodiscard]] bool have_changed() const;

  private:
    struct State {
        bool exists = false;
        std::filesystem::file_time_type written;
        std::uintmax_t size = 0;
        friend bool operator==(const State&, const State&) = default;
    };
    [[nodiscard]] static State state_of(const std::string& path);

    std::shared_ptr<FileSource> source_;
    std::map<std::string, State> files_;
};

}  // namespace lightwalk
