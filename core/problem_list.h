#pragma once
// Collects all problems of an input, so that one run reports them together.
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "core/error.h"

namespace lightwalk {

/// Problems in the order in which they were found.
class ProblemList {
  public:
    /// Add a problem. Of each `kind` (for example one missing name, or one type of primitives) only
    /// the first `told` are listed, the others are counted.
    void add(const SourceLocation& where, const std::string& message, const std::string& kind,
             std::size_t told = 1);
    /// Add a problem that is always listed.
    void add(const InputError& problem) { lines_.push_back({problem.what(), {}}); }

    [[nodiscard]] bool empty() const { return lines_.empty(); }
    /// One line for each listed problem, "file:line: message"; the last one of a kind ends in "(and
    /// N more)" where others were only counted.
    [[nodiscard]] std::string text() const;
    /// Throws InputError(text()) unless the list is empty.
    void raise() const;

  private:
    struct Line {
        std::string text;
        std::string kind;  ///< "" for none
    };
    std::vector<Line> lines_;
    std::map<std::string, std::size_t> counts_;  ///< of all problems of a kind
};

}  // namespace lightwalk
