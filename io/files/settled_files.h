#pragma once
// Says when files that somebody writes are whole again.
#include <chrono>
#include <utility>

#include "io/files/watched_files.h"

namespace lightwalk {

/// Editors empty a file before they write it, rename others over it, and write several.
class SettledFiles {
  public:
    using Clock = std::chrono::steady_clock;
    /// Without a change: whoever writes is done.
    static constexpr std::chrono::milliseconds kQuiet{300};
    /// With changes all the time: they are read all the same.
    static constexpr std::chrono::seconds kLongest{10};

    /// @param read  as they were read
    explicit SettledFiles(FileStates read) : read_(std::move(read)), last_(read_) {}

    /// Whether they are others than those that were read, and are to be read again.
    /// @param now   as they are
    /// @param time  that is, never before that of the call before
    [[nodiscard]] bool are_to_be_read(const FileStates& now, Clock::time_point time);
    /// Whether somebody is writing: it is worth while to look often.
    [[nodiscard]] bool change() const { return changing_; }

  private:
    FileStates read_, last_;
    bool changing_ = false;
    Clock::time_point begun_, changed_;  ///< while changing_
};

}  // namespace lightwalk
