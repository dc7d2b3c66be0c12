#pragma once
// What a scene was read from: whether another reading would find the same.
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "io/files/file_source.h"

namespace lightwalk {

/// A decorator of a source that records what it is asked, and what is known of the answers. For one
/// thread.
class ScenePremises final : public FileSource {
  public:
    explicit ScenePremises(std::shared_ptr<FileSource> source = real_files())
        : source_(std::move(source)) {}

    [[nodiscard]] std::optional<std::string> answer(Question question, const std::string& text,
                                                    std::size_t limit) override;

    /// Whether all files are those that were read, unchanged, and those that did not exist do not
    /// exist.
    [[nodiscard]] bool files_hold() const;
    /// Whether the environment, and patterns for names, still say the same. In the directory and
    /// with the environment of whoever asks.
    [[nodiscard]] bool answers_hold() const;
    /// Whether all came from files: nothing from commands or standard input.
    [[nodiscard]] bool can_hold() const { return can_hold_; }

  private:
    /// Device, inode, size, dates of the last write and of the last change [ns]; all zero: none.
    using FileIdentity = std::array<std::int64_t, 5>;
    static FileIdentity identity_of(const std::string& path);
    static FileIdentity settled_identity(const std::string& path);

    std::shared_ptr<FileSource> source_;
    std::map<std::string, FileIdentity> files_;  ///< by path
    std::map<std::pair<Question, std::string>, std::optional<std::string>> answers_;
    bool can_hold_ = true;
};

}  // namespace lightwalk
