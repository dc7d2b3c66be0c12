#pragma once
// The source of all input files: the file system, or a recording of what another process has read
// there.
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

/// Everything that readers take from outside the process, as questions and answers, and the files
/// that generators make beside their output, which are nowhere else. For one thread.
class FileSource {
  public:
    enum class Question : char {
        readable = 'e',     ///< whether a path is a regular file that can be read
        bytes = 'r',        ///< the contents of a file
        beginning = 'b',    ///< a file, or standard input ("-"), up to its first empty line
        input = 'i',        ///< the rest of standard input
        input_state = 't',  ///< the state of standard input: "terminal", "empty" or "waiting"
        matches = 'm',      ///< the paths that match a shell pattern, a zero byte after each
        place = 'p',        ///< the path $NAME, ~ or ~user, or "library": Lightwalk's own folder
        script = 's',  ///< the output of a shell script, after "0" for success or "1" for failure
    };
    virtual ~FileSource() = default;

    /// @param limit  the largest answer [bytes]
    /// @return  nothing when what is asked for does not exist. Throws InputError when it exists and
    ///          cannot be read.
    [[nodiscard]] virtual std::optional<std::string> answer(Question question,
                                                            const std::string& text,
                                                            std::size_t limit) = 0;

    // answer() for each kind of question, with typed results. These throw InputError for what
    // cannot be read, or is larger than `limit` bytes.
    [[nodiscard]] bool readable(const std::string& path);
    [[nodiscard]] std::string read(const std::string& path, std::size_t limit = kLargestFile);
    [[nodiscard]] std::string standard_input();
    [[nodiscard]] std::vector<std::string> matches(const std::string& pattern);
    [[nodiscard]] std::optional<std::string> place(const std::string& name);

    /// By which path to map a file into memory whose beginning was asked for.
    [[nodiscard]] virtual std::string place_of(const std::string& path) { return path; }

    /// Keep a file in memory: from now on `readable` and `read` know `path` by these bytes,
    /// whatever the source says. Whoever repeats the reading makes it again, so it is no answer of
    /// the source, and neither recorded nor sent.
    /// @return  false when other bytes stood there, which are forgotten
    bool keep(const std::string& path, std::string bytes);
    [[nodiscard]] bool keeps(const std::string& path) const { return kept_.contains(path); }

  private:
    std::map<std::string, std::string> kept_;
};

/// The source that asks the operating system: files, environment and standard input of the process.
[[nodiscard]] std::shared_ptr<FileSource> real_files();

/// A decorator of a source that records its answers.
class FileRecorder final : public FileSource {
  public:
    /// @param keep  true: whole answers are recorded, for take(); false: only their digests
    explicit FileRecorder(std::shared_ptr<FileSource> source = real_files(), bool keep = false)
        : source_(std::move(source)), keep_(keep) {}

    [[nodiscard]] std::optional<std::string> answer(Question question, const std::string& text,
                                                    std::size_t limit) override;

    [[nodiscard]] std::string place_of(const std::string& path) override {
        return source_->place_of(path);
    }

    /// A line for each file, command and standard input, in the order in which they were first
    /// read: the name without folders, and a digest of the bytes.
    [[nodiscard]] const std::vector<std::string>& digests() const { return digests_; }
    /// Record a line for a file that is mapped into memory rather than read through this source.
    void note_mapped(const std::string& path, std::uint64_t digest);
    /// One digest of all lines of digests().
    [[nodiscard]] std::string digest() const;

    /// Removes and returns the recording of all questions so far with their answers, for
    /// FileReplay. Its format: two strings for each question, each after its length as a
    /// little-endian number of 64 bits: the question's letter and text; then '1' and the answer, or
    /// '0' for no answer, or 'x' and the message of an error.
    [[nodiscard]] std::string take();

  private:
    void note(Question question, const std::string& text, char kind, std::string_view said);
    [[nodiscard]] std::optional<std::string> ask(Question question, const std::string& text,
                                                 std::size_t limit);

    std::shared_ptr<FileSource> source_;
    bool keep_;
    std::map<std::string, std::string> answers_;  ///< in the format of take(); empty unless keep_
    std::map<std::string, bool> digested_;
    std::vector<std::string> digests_;
};

/// A source that answers from a recording, and knows no other answers.
class FileReplay final : public FileSource {
  public:
    /// Throws InputError for bytes that are no recording of FileRecorder::take().
    explicit FileReplay(std::string_view recording);
    [[nodiscard]] std::optional<std::string> answer(Question question, const std::string& text,
                                                    std::size_t limit) override;
    /// A file that is to be mapped is elsewhere in this process.
    void move_to(const std::string& path, std::string elsewhere) {
        places_[path] = std::move(elsewhere);
    }
    [[nodiscard]] std::string place_of(const std::string& path) override {
        const auto found = places_.find(path);
        return found == places_.end() ? path : found->second;
    }
    /// Release the memory of the recording, but for answers of so many bytes at most.
    void clear(std::size_t kept = 0) {
        std::erase_if(answers_,
                      [&](const auto& entry) { return kept == 0 || entry.second.size() > kept; });
    }

  private:
    std::map<std::string, std::string, std::less<>> answers_;
    std::map<std::string, std::string> places_;
};

}  // namespace lightwalk
