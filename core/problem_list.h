#pragma once
// Everything that is wrong with an input, so that one run tells all of it.
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "core/error.h"

namespace lightwalk {

/// Problems in the order in which they were found.
class ProblemList {
  public:
    /// Of problems of one `kind` (a name that is missing, a type of primitives) the first few are
    /// told, the others counted.
    void add(const SourceLocation& where, const std::string& message, const std::string& kind,
             std::size_t told = 1);
    /// A problem like no other.
    void add(const InputError& problem) { lines_.push_back({problem.what(), {}}); }

    [[nodiscard]] bool empty() const { return lines_.empty(); }
    /// A line each, "file:line: message", with "(and N more)" behind the last one told of a kind.
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
