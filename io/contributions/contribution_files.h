#pragma once
// Writes the records of contributions to their files, each of which appears when all are whole, and
// takes up what an interrupted run has left.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/contributions/contribution_outputs.h"

namespace lightwalk {

/// What becomes of files that exist already.
enum class ExistingOutputs {
    refuse,    ///< throw
    replace,   ///< -fo
    continue_  ///< -r: go on behind their records
};

struct ContributionWriting {
    std::vector<ContributionOutput> outputs;
    RecordFormat format;
    bool with_header = true;
    std::vector<std::string> history;  ///< of headers
    int rays = 1;  ///< -c: that a record is the mean of; 0: one record, the sum of all rays
    ExistingOutputs existing = ExistingOutputs::refuse;
};

/// Collects answers to rays and writes records. While it lasts files have the extension .part, and
/// keep it if it is destroyed before finish(): -r goes on with these.
class ContributionFiles {
  public:
    /// Opens all files, which takes up what they hold (-r). Throws InputError for files that exist,
    /// or cannot be opened, read or continued.
    explicit ContributionFiles(ContributionWriting writing);

    /// Rays that need not be traced: their records exist.
    [[nodiscard]] std::uint64_t rays_done() const { return rays_done_; }
    /// Answers to rays, one after the other: three numbers of double precision a column of all
    /// outputs. Throws InputError where a file cannot be written.
    void add(std::string_view answers);
    /// Writes what was added to the files. Throws InputError.
    void flush();
    /// Removes and returns the bytes for standard output so far.
    [[nodiscard]] std::string take_standard_output();
    /// The last record; then the files get their names. Throws InputError.
    /// @return  whether the last record is the mean of fewer rays than the others
    [[nodiscard]] bool finish();

  private:
    struct Target {
        std::string part;     ///< the file that is written; "": standard output
        bool renamed = true;  ///< at the end; false: a device
        std::string pending;  ///< bytes that are not written yet
    };
    /// An output of an earlier run.
    struct Found {
        std::string path;       ///< "": there is none
        std::size_t begin = 0;  ///< of its records [bytes]
        std::uint64_t records = 0;
    };
    [[nodiscard]] std::string header(const ContributionOutput& output) const;
    void open(std::size_t i);
    void take_up();
    [[nodiscard]] Found examine(std::size_t i) const;
    void add_record(const Found& found, std::size_t i);
    void put_record(double scale);

    ContributionWriting writing_;
    std::vector<Target> targets_;  ///< one an output
    std::size_t pending_bytes_ = 0;
    std::vector<double> sums_;  ///< of the record at hand: three numbers a column
    int in_record_ = 0;
    std::uint64_t rays_done_ = 0;
};

}  // namespace lightwalk
