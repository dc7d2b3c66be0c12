#pragma once
// Where a scene and its options come from: the file system, or what another process has read there.
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lightwalk {

inline constexpr std::size_t kLargestFile = std::size_t{1} << 30;

/// All that reading takes from the world around it, as questions and answers. For one thread.
class FileSource {
  public:
    enum class Question : char {
        readable = 'e',     ///< whether a path is a regular file that can be read
        bytes = 'r',        ///< a file
        beginning = 'b',    ///< a file, or standard input ("-"), up to its first empty line
        input = 'i',        ///< all that is left of standard input
        input_state = 't',  ///< "terminal", "empty" or "waiting": what standard input is
        matches = 'm',      ///< paths that match a pattern of the shell, a zero byte after each
        place = 'p',        ///< $NAME, ~, ~user, or "library": our own library folder
        script = 's',       ///< a shell's output: "0" for success, else "1", then the bytes
    };
    virtual ~FileSource() = default;

    /// @return  nothing: there is none. Throws InputError for what is there and cannot be read.
    [[nodiscard]] virtual std::optional<std::string> answer(Question question,
                                                            const std::string& text,
                                                            std::size_t limit) = 0;

    // The same, by their types. What cannot be read, or is larger than `limit` bytes: InputError.
    [[nodiscard]] bool readable(const std::string& path);
    [[nodiscard]] std::string read(const std::string& path, std::size_t limit = kLargestFile);
    [[nodiscard]] std::string standard_input();
    [[nodiscard]] std::vector<std::string> matches(const std::string& pattern);
    [[nodiscard]] std::optional<std::string> place(const std::string& name);
};

/// The process's own files, environment and standard input.
[[nodiscard]] std::shared_ptr<FileSource> real_files();

/// Passes on what a source answers, and remembers it.
class FileRecorder final : public FileSource {
  public:
    /// @param keep  whether answers are kept, for take(), or only their digests
    explicit FileRecorder(std::shared_ptr<FileSource> source = real_files(), bool keep = false)
        : source_(std::move(source)), keep_(keep) {}

    [[nodiscard]] std::optional<std::string> answer(Question question, const std::string& text,
                                                    std::size_t limit) override;

    /// A line for each file, command and standard input that was read, in the order of the first
    /// time: its name without folders, and a digest of its bytes.
    [[nodiscard]] const std::vector<std::string>& digests() const { return digests_; }
    /// A line for a file that is used without being read.
    void note_mapped(const std::string& path, std::uint64_t digest);
    /// One digest of all these.
    [[nodiscard]] std::string digest() const;

    /// For FileReplay: every question so far with its answer. They are forgotten here.
    /// Two strings for each question, each after its length in 64 bits, little-endian: the
    /// question's letter and text; then '1' and the answer, '0' for none, or 'x' and the message of
    /// an error.
    [[nodiscard]] std::string take();

  private:
    void note(Question question, const std::string& text, char kind, std::string_view said);
    [[nodiscard]] std::optional<std::string> ask(Question question, const std::string& text,
                                                 std::size_t limit);

    std::shared_ptr<FileSource> source_;
    bool keep_;
    std::map<std::string, std::string> answers_;  ///< '1', '0' or 'x', and the text; if kept
    std::map<std::string, bool> digested_;
    std::vector<std::string> digests_;
};

/// Answers what a recording answers, and nothing else.
class FileReplay final : public FileSource {
  public:
    /// Throws InputError for bytes that no recorder made.
    explicit FileReplay(std::string_view recording);
    [[nodiscard]] std::optional<std::string> answer(Question question, const std::string& text,
                                                    std::size_t limit) override;
    /// Forget all.
    void clear() { answers_.clear(); }

  private:
    std::map<std::string, std::string, std::less<>> answers_;
};

}  // namespace lightwalk
