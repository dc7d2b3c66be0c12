#pragma once
// Where the columns of contributions go (rcontrib's -o), and in which format.
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "io/rays/ray_reader.h"

namespace lightwalk {

/// A modifier's columns, and the specification of where they go.
struct OutputRequest {
    std::string specification;  ///< a file's name, with %s for the modifier and %d for the bin,
                                ///< which may have a width (%04d); "": standard output
    std::string modifier;
    std::size_t bins = 1;
};

/// A file, or standard output, and what a record of it holds.
struct ContributionOutput {
    std::string file;                  ///< "": standard output
    std::vector<std::size_t> columns;  ///< in the order in which they are written
    std::string modifier;            ///< the only one of a file that is named after it; "": several
    std::optional<std::size_t> bin;  ///< the same
};

/// The outputs of all requests, in the order in which they first occur; columns are numbered
/// through all requests. Throws UsageError for specifications that are none.
[[nodiscard]] std::vector<ContributionOutput> contribution_outputs(
    const std::vector<OutputRequest>& requests);

/// How records look.
struct RecordFormat {
    NumberFormat numbers = NumberFormat::text;
    int x = 0, y = 0;  ///< -x -y: sides of a picture, or 0

    /// Bytes of a record; 0: they differ from record to record.
    [[nodiscard]] std::size_t record_size(std::size_t columns) const;
    /// Appends a record.
    /// @param sums   three numbers of each column of all outputs
    /// @param scale  that they are multiplied by
    void append(const ContributionOutput& output, const std::vector<double>& sums, double scale,
                std::string& bytes) const;
    /// The inverse: adds the numbers of a record to `sums`. False: it holds something else.
    [[nodiscard]] bool add(const ContributionOutput& output, std::string_view record,
                           std::vector<double>& sums) const;
    /// A header, as rcontrib writes it, with the resolution line that follows where records are a
    /// picture's pixels.
    /// @param history  lines behind the first one
    [[nodiscard]] std::string header(const ContributionOutput& output,
                                     const std::vector<std::string>& history) const;
};

}  // namespace lightwalk
